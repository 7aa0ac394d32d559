"""Starts of robots and ball: fixed places and distributions.

A robot's start is in its own team's view, with its goal at -x. A start can be sampled and printed.
"""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt
from typing import Annotated, Literal

import numpy as np
from pydantic import AfterValidator, ConfigDict, Discriminator, Field, Tag, model_validator

from robobt.config.validation import Settings
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point, direction


class ScenarioPart(Settings):
    """A part of a scenario: immutable, strictly typed, without unknown keys, with finite numbers."""

    model_config = ConfigDict(strict=True)


def _ordered(bounds: tuple[float, float]) -> tuple[float, float]:
    if bounds[0] > bounds[1]:
        raise ValueError(f"the lower bound {bounds[0]:g} is above the upper bound {bounds[1]:g}")
    return bounds


_Length = Annotated[float, Field(ge=-50, le=50)]
_Angle = Annotated[float, Field(ge=-2 * pi - 1e-3, le=2 * pi + 1e-3)]
Place = tuple[_Length, _Length]
"""A fixed point x, y [m]."""
_Range = Annotated[tuple[_Length, _Length], AfterValidator(_ordered)]
_Distances = Annotated[
    tuple[Annotated[float, Field(ge=0, le=50)], Annotated[float, Field(ge=0, le=50)]],
    AfterValidator(_ordered),
]
_Angles = Annotated[tuple[_Angle, _Angle], AfterValidator(_ordered)]


class Box(ScenarioPart):
    """A uniform distribution over a rectangle."""

    x: _Range = Field(description="least and greatest x [m]")
    y: _Range = Field(description="least and greatest y [m]")

    def sample(self, rng: np.random.Generator) -> Point:
        """Sample a point of the box from ``rng`` [m]."""
        return (float(rng.uniform(*self.x)), float(rng.uniform(*self.y)))

    def __str__(self) -> str:
        return f"in the box x {self.x[0]:g} to {self.x[1]:g} m, y {self.y[0]:g} to {self.y[1]:g} m"


class Disc(ScenarioPart):
    """A uniform distribution over a disc."""

    center: Place = Field(description="x, y [m]")
    radius: float = Field(gt=0, le=50, description="[m]")

    def sample(self, rng: np.random.Generator) -> Point:
        """Sample a point of the disc [m]."""
        reach, angle = self.radius * sqrt(float(rng.random())), float(rng.uniform(-pi, pi))
        return (self.center[0] + reach * cos(angle), self.center[1] + reach * sin(angle))

    def __str__(self) -> str:
        return f"within {self.radius:g} m of ({self.center[0]:g}, {self.center[1]:g}) m"


class Around(ScenarioPart):
    """A uniform distance and bearing from a point."""

    around: Literal["ball", "own goal", "their goal"] = Field(description="the object that it is around")
    distance: _Distances = Field(description="least and greatest distance [m]")
    bearing: _Angles = Field(
        (-pi, pi), description="least and greatest direction from there, from +x counter-clockwise [rad]"
    )

    def sample(self, rng: np.random.Generator, middle: Point) -> Point:
        """Sample a point around ``middle`` [m]."""
        reach, angle = float(rng.uniform(*self.distance)), float(rng.uniform(*self.bearing))
        return (middle[0] + reach * cos(angle), middle[1] + reach * sin(angle))

    def __str__(self) -> str:
        turned = (
            "" if self.bearing == (-pi, pi) else f", bearing {self.bearing[0]:g} to {self.bearing[1]:g} rad"
        )
        return f"{self.distance[0]:g} to {self.distance[1]:g} m from the {self.around}{turned}"


class Anywhere(ScenarioPart):
    """A uniform distribution of the ball within the walls, with a share at places that are hard to reach."""

    at_walls: float = Field(
        ge=0, le=1, description="share at walls, in corners and in goals, each equally likely"
    )

    def sample(self, rng: np.random.Generator, field: FieldGeometry) -> Point:
        """Sample a point of the field or of the margin around it [m]."""
        most_x, most_y = field.outer[0] - _OFF_WALL, field.outer[1] - _OFF_WALL
        x, y = (float(rng.uniform(-1.0, 1.0)) for _ in range(2))
        side_x, side_y = (float(side) for side in rng.choice((-1.0, 1.0), 2))
        goal = field.goal_width / 2 - _OFF_WALL
        if rng.random() >= self.at_walls:
            # Not on the goal line between the posts either, because a post may be there.
            inside = field.half_length - _OFF_WALL if abs(y * most_y) < field.goal_width else most_x
            return (x * inside, y * most_y)
        kind = rng.integers(3)
        if kind == 0:
            return (side_x * (field.half_length + field.goal_depth - _OFF_WALL), y * goal)
        if kind == 1:
            return (side_x * most_x, side_y * most_y)
        if rng.random() < field.length / (field.length + field.width):
            return (x * most_x, side_y * most_y)
        beside = field.goal_width / 2 + _OFF_WALL + field.margin / 10
        return (side_x * most_x, side_y * (beside + abs(y) * (most_y - beside)))

    def __str__(self) -> str:
        return f"anywhere within the walls, {self.at_walls:.0%} at walls, in corners and in goals"


_OFF_WALL = 0.025
"""Distance from a wall to the centre of a ball at it [m]."""


def _position_kind(value: object) -> str:
    if isinstance(value, Box | Disc | Around | Anywhere):
        return type(value).__name__
    if not isinstance(value, dict):
        return "Place"
    if "at_walls" in value:
        return "Anywhere"
    return "Around" if "around" in value else "Disc" if "center" in value or "radius" in value else "Box"


Position = Annotated[
    Annotated[Place, Tag("Place")]
    | Annotated[Box, Tag("Box")]
    | Annotated[Disc, Tag("Disc")]
    | Annotated[Around, Tag("Around")]
    | Annotated[Anywhere, Tag("Anywhere")],
    Discriminator(_position_kind),
]
"""A fixed point or a distribution of points."""


def _heading_kind(value: object) -> str:
    return "towards" if isinstance(value, str) else "range" if isinstance(value, list | tuple) else "angle"


Heading = Annotated[
    Annotated[_Angle, Tag("angle")]
    | Annotated[_Angles, Tag("range")]
    | Annotated[Literal["towards ball", "towards goal"], Tag("towards")],
    Discriminator(_heading_kind),
]
"""A fixed heading, a range of headings, or a target to face [rad]."""


class RobotStart(ScenarioPart):
    """A robot's pose at the start, in its own team's view."""

    position: Position = Field(
        description="[x, y], a box {x, y}, a disc {center, radius} or {around, distance} [m]"
    )
    heading: Heading = Field(
        0.0,
        description="an angle, [least, greatest], 'towards ball' or 'towards goal' (the attacked one) [rad]",
    )

    def sample_heading(
        self, rng: np.random.Generator, place: Point, ball: Point | None, field: FieldGeometry
    ) -> float:
        """Sample a heading for a robot at ``place`` [rad]; ``ball`` in the same view."""
        if isinstance(self.heading, tuple):
            return float(rng.uniform(*self.heading))
        if self.heading == "towards goal":
            return direction(place, field.their_goal)
        if self.heading == "towards ball":
            return direction(place, field.their_goal if ball is None else ball)
        return self.heading

    def __str__(self) -> str:
        return f"{_say(self.position)}, heading {_say_heading(self.heading)}"


class BallStart(ScenarioPart):
    """The ball at the start, in world coordinates, which are blue's view."""

    position: Position | None = Field(
        None, description="[x, y], a box {x, y} or a disc {center, radius} [m], or {at_walls}"
    )
    velocity: tuple[Annotated[float, Field(ge=-20, le=20)], Annotated[float, Field(ge=-20, le=20)]] = Field(
        (0.0, 0.0), description="vx, vy [m/s]"
    )
    held_by: str | None = Field(
        None, max_length=40, description="a robot, as 'blue 0': in that robot's mouth"
    )

    @model_validator(mode="after")
    def _one_of_both(self) -> BallStart:
        if (self.position is None) == (self.held_by is None):
            raise ValueError("give either position or held_by")
        if isinstance(self.position, Around):
            raise ValueError("the ball cannot be placed around something; use a box or a disc")
        if self.held_by is not None and self.velocity != (0.0, 0.0):
            raise ValueError("a ball that a robot holds has no velocity of its own")
        return self

    def __str__(self) -> str:
        speed = hypot(*self.velocity)
        moving = f", moving at {speed:g} m/s" if speed else ""
        return f"held by {self.held_by}" if self.position is None else f"{_say(self.position)}{moving}"


def _say(position: object) -> str:
    return f"at ({position[0]:g}, {position[1]:g}) m" if isinstance(position, tuple) else str(position)


def _say_heading(heading: object) -> str:
    if isinstance(heading, tuple):
        return f"{heading[0]:g} to {heading[1]:g} rad"
    return heading if isinstance(heading, str) else f"{heading:g} rad"
