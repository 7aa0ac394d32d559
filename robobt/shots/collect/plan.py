"""The settings of a collection of shots, and the set-up of each trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field as dataclass_field
from typing import Literal

from pydantic import Field

from robobt.config.validation import Settings
from robobt.match.scenario.scenario import MAX_SEED, Scenario
from robobt.shots.keepers.population import Population
from robobt.world.state import RobotId

MID_RANGE, CLOSE_RANGE = 3.5, 2.5
"""Largest distances from ball to goal centre of shots on the move, for the two variants [m].

Half of the paper's shots on the move were taken from within 3.35 m.
"""

ROBOBULLS_SHOT_SPEED = 7.5
"""RoboBulls' kick speed of a shot [m/s]."""


Section = tuple[tuple[float, float], tuple[float, float]]
"""A part of the field: x and y, each from and to [m]."""


class CollectionSettings(Settings):
    """Settings of a collection; the same settings give the same shots."""

    scenario: Literal["motion", "still", "both"] = Field(
        "both", description="how the attacker comes to shoot"
    )
    protocol: Literal["balanced", "paper"] = Field(
        "balanced",
        description="balanced: over range, angle and goalkeeper offset, at any point of the goal line; "
        "paper: the shots that Attack Main takes, in the numbers of the paper",
    )
    seed: int = Field(1, ge=0, le=MAX_SEED, description="what every trial's randomness follows from")
    opponents: int = Field(
        1, ge=1, le=6, description="most opponents on the field, the goalkeeper among them"
    )
    goalkeepers: Population | None = Field(
        None, description="fitted goalkeepers to draw one from for each shot; our own without"
    )
    style: Literal["default", "robobulls"] = Field(
        "default", description="whose pilot our goalkeeper has: ours, or RoboBulls' (in a clone)"
    )


@dataclass(frozen=True, slots=True)
class Attempt:
    """One trial of a collection.

    ``labels`` are columns of its row that are known beforehand; ``section`` is x and y, from and to, that the
    attacker has to shoot from, None anywhere [m]; ``delay`` is how late yellow's first robot acts [s];
    ``velocities`` are those of robots that move at the start, (vx, vy) in the field's frame [m/s].
    """

    scenario: Scenario
    seed: int
    labels: Mapping[str, object]
    section: Section | None = None
    delay: float = 0.0
    velocities: Mapping[RobotId, tuple[float, float]] = dataclass_field(default_factory=dict)
