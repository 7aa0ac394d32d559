"""The constant part of a recording, and the error for files that are no recording."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntFlag
from pathlib import Path
from typing import Any

from pydantic import Field, FiniteFloat, field_validator, model_validator

from robobt import __version__
from robobt.config.errors import RobobtError, one_line
from robobt.config.validation import Settings
from robobt.tree.drawing import NodeKind
from robobt.world.ball_model import DEFAULT_BALL, BallModel
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.limits import DEFAULT_LIMITS, RobotLimits, limits_as_named_now
from robobt.world.state import ROBOT_RADIUS, RobotId

RECORDING_FORMAT = "robobt-recording"
RECORDING_VERSION = 5


class RecordingError(RobobtError, ValueError):
    """A file cannot be read as a recording.

    Attributes:
        path: the file.
        problem: description of the error.
        tick: number of the faulty tick, from 0; None if the error concerns the whole file.
        field: the faulty field.
    """

    def __init__(self, path: Path, problem: str, tick: int | None = None, field: str | None = None) -> None:
        self.path, self.tick, self.field = path, tick, field
        place = str(path) if tick is None else f"{path}, tick {tick}"
        super().__init__(": ".join([place, *[one_line(part, 200) for part in (field, problem) if part]]))


class RobotFlag(IntFlag):
    """Flags of a robot at one tick."""

    BALL_CONTACT = 1
    """The ball is in its mouth."""
    DRIBBLER = 2
    """Its command turns the dribbler on."""
    KICK = 4
    """Its command asks for a kick."""
    KICK_NOW = 8
    """That kick fires at once, and only if the ball is in the mouth at that instant."""
    COMMANDED = 16
    """It was sent a command."""


class RecordedNode(Settings):
    """One node of a recorded tree; a tree is the list of its nodes, parents before children."""

    name: str
    path: str = Field("", description="the node's id: names from the root, joined by slashes, and unique")
    type: str = Field(description="name of the node's class")
    kind: NodeKind
    depth: int = Field(ge=0, description="0 at the root")
    glyph: str = Field("", description="the symbol of a composite or decorator")
    detail: str = Field("", description="memory or reactive, a policy, or parameters")
    condition: bool = Field(False, description="whether it is a condition, whose failure is no fault")


class RecordedRobot(Settings):
    """One robot of a recording."""

    team: Team
    number: int = Field(ge=0)
    play: str = Field("", description="display name of its play")
    radius: float = Field(ROBOT_RADIUS, gt=0, le=1, description="[m]")
    mouth: float = Field(0.075, gt=0, le=1, description="centre to flat front [m]")
    limits: RobotLimits = Field(DEFAULT_LIMITS, description="the robot's limits as its tree sees them")
    tree: tuple[RecordedNode, ...] = Field((), description="filled in by the recorder")

    _limits_as_now = field_validator("limits", mode="before")(limits_as_named_now)

    @property
    def id(self) -> RobotId:
        """Team and number."""
        return RobotId(self.team, self.number)

    @model_validator(mode="after")
    def _one_root(self) -> RecordedRobot:
        for place, node in enumerate(self.tree):
            deepest = self.tree[place - 1].depth + 1 if place else 0
            if node.depth > deepest or (node.depth == 0) != (place == 0):
                raise ValueError(f"node {place} of the tree cannot have depth {node.depth}")
        return self


class RecordingHeader(Settings):
    """The constant part of a recording."""

    scenario: str = Field("", description="name of the scenario")
    trial: int = Field(0, ge=0, description="number of the trial, from 0")
    seed: int = Field(0, description="the trial's seed, from which all its randomness follows")
    played: dict[str, Any] = Field(
        default_factory=dict, description="the whole scenario as data; with the seed it repeats the trial"
    )
    period: float = Field(gt=0, le=10, description="control period [s]")
    field: FieldGeometry
    ball_model: BallModel = Field(DEFAULT_BALL, description="the ball model that trees see")
    cameras_show_truth: bool = Field(
        False, description="whether what cameras saw is the truth, even where trees were shown a prediction"
    )
    teams: dict[Team, str] = Field(default_factory=dict, description="names of the teams")
    robots: tuple[RecordedRobot, ...] = Field((), max_length=64)
    robobt: str = Field(__version__, description="version of robobt that recorded it")

    @model_validator(mode="after")
    def _robots_differ(self) -> RecordingHeader:
        ids = [robot.id for robot in self.robots]
        for robot in ids:
            if ids.count(robot) > 1:
                raise ValueError(f"robot {robot} is listed twice")
        return self


@dataclass(slots=True, frozen=True)
class Event:
    """An event marked on the timeline.

    ``kind`` is "goal", "kick", "save", "out", "error" or any other word; ``text`` describes what happened;
    ``time`` is in seconds; ``team`` and ``robot`` are who caused it, if known.
    """

    time: FiniteFloat
    kind: str
    team: Team | None = None
    robot: RobotId | None = None
    text: str = ""
