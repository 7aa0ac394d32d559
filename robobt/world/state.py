"""The state of the field at one instant: new objects in every tick, read-only by convention.

These are plain slotted classes, not frozen ones: a frozen dataclass costs about
three times as much to make, and a match makes some forty of them a tick.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi
from struct import pack
from typing import Any, NamedTuple

from robobt.world.ball_model import DEFAULT_BALL, BallModel
from robobt.world.field import FieldGeometry
from robobt.world.game import OPEN_PLAY, GameState, Team
from robobt.world.limits import DEFAULT_LIMITS, RobotLimits

ROBOT_RADIUS = 0.09
"""Radius of the largest robot the rules allow [m]."""

BALL_RADIUS = 0.0215
"""Radius of a golf ball [m]."""

TOUCH_DISTANCE = ROBOT_RADIUS + BALL_RADIUS
"""From a robot's centre to that of a ball that touches its round hull [m]."""


ROBOT_HEIGHT = 0.15
"""Height of the tallest robot the rules allow; a ball above it passes over robots [m]."""

RECEIVED_HEIGHT = 0.05
"""Height below which a ball can be kicked and held [m]. Source: ER-Force's simulator and Sumatra."""

GOAL_HEIGHT = 0.155
"""Height of a goal's inside, up to its bar. Source: ER-Force's simulator; the rules say 0.16 [m]."""


MIRRORED_FROM = "mirrored from"
"""Where :attr:`Frame.made` holds the frame of which it is the mirror image."""

PACKED = "packed"
"""Where :attr:`Frame.made` holds the result of :meth:`Frame.packed`, if it has been made already."""


class RobotId(NamedTuple):
    """A robot's team and its number on that team."""

    team: Team
    number: int

    def __str__(self) -> str:
        return f"{self.team.value} {self.number}"


@dataclass(slots=True)
class RobotState:
    """One robot: pose, velocity in field coordinates, and its ball sensor.

    Attributes:
        id: number on its team.
        x, y: centre [m].
        heading: direction of the mouth in (-pi, pi], counter-clockwise from +x [rad].
        vx, vy: velocity in field coordinates [m/s].
        omega: turning rate, counter-clockwise positive [rad/s].
        ball_contact: whether the ball is in the mouth (the break-beam sensor).
        limits: what the robot can do, as far as known.
    """

    id: int
    x: float
    y: float
    heading: float = 0.0
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0
    ball_contact: bool = False
    limits: RobotLimits = DEFAULT_LIMITS

    @property
    def position(self) -> tuple[float, float]:
        """Centre (x, y) [m]."""
        return (self.x, self.y)

    @property
    def speed(self) -> float:
        """Magnitude of the velocity [m/s]."""
        return hypot(self.vx, self.vy)


@dataclass(slots=True)
class BallState:
    """The ball, in field coordinates.

    Attributes:
        x, y: centre [m].
        vx, vy: velocity along the ground [m/s].
        z: height above where it lies, 0 on the ground [m].
        vz: how fast it rises [m/s].
    """

    x: float
    y: float
    vx: float = 0.0
    vy: float = 0.0
    z: float = 0.0
    vz: float = 0.0

    @property
    def position(self) -> tuple[float, float]:
        """Centre (x, y) [m]."""
        return (self.x, self.y)

    @property
    def speed(self) -> float:
        """Magnitude of the velocity along the ground [m/s]."""
        return hypot(self.vx, self.vy)


class Derived:
    """An object that keeps what has been derived from it.

    Attributes:
        made: that, by name; clear it after changing the object.
    """

    __slots__ = ("made",)
    made: dict[str, Any]

    def __post_init__(self) -> None:
        self.made = {}


@dataclass(slots=True)
class Frame(Derived):
    """The field at one instant as ``team`` sees it: own goal at -x, attack towards +x.

    Attributes:
        time: seconds since the start; the only clock a tree may read [s].
        period: seconds from this frame to the next [s].
        field: dimensions.
        team: the team whose view this is.
        ball: the ball.
        own, opponents: robots on the field, in order of their numbers.
        game: the state of the game.
        last_touch: the robot that touched the ball last, None before the first touch.
        ball_model: how the ball moves, as far as known.
    """

    time: float
    field: FieldGeometry
    ball: BallState
    own: tuple[RobotState, ...] = ()
    opponents: tuple[RobotState, ...] = ()
    team: Team = Team.BLUE
    period: float = 0.025
    game: GameState = OPEN_PLAY
    last_touch: RobotId | None = None
    ball_model: BallModel = DEFAULT_BALL

    def robot(self, number: int) -> RobotState | None:
        """Return the own robot with this number, None when it is not on the field."""
        for robot in self.own:
            if robot.id == number:
                return robot
        return None

    def robots(self) -> dict[RobotId, RobotState]:
        """Return every robot on the field by team and number."""
        own = {RobotId(self.team, robot.id): robot for robot in self.own}
        return own | {RobotId(self.team.other, robot.id): robot for robot in self.opponents}

    def _repr_svg_(self) -> str:
        """Show itself in a notebook."""
        from robobt.world.picture import field_svg

        colour = {Team.BLUE: "#2f62d9", Team.YELLOW: "#f2b705"}
        robots = [
            (colour[team], robot.id, robot.x, robot.y, robot.heading)
            for team, robots in ((self.team, self.own), (self.team.other, self.opponents))
            for robot in robots
        ]
        title = f"{self.time:.2f} s, as {self.team.value} sees it"
        goals = colour[self.team], colour[self.team.other]
        at = self.ball.x, self.ball.y
        return field_svg(title, self.field, goals, robots, at, (ROBOT_RADIUS, BALL_RADIUS))

    def packed(self) -> bytes:
        """Return all its numbers except the game's, as little-endian float64.

        Time; x, y, vx, vy of the ball; how many own robots there are, and the id, x, y, heading,
        vx, vy, omega and ball contact of each; these values for the opponents; z and vz of a ball in the air.
        """
        made: bytes | None = self.made.get(PACKED)
        if made is not None:
            return made
        ball = self.ball
        numbers = [self.time, ball.x, ball.y, ball.vx, ball.vy]
        for robots in (self.own, self.opponents):
            numbers.append(len(robots))
            for it in robots:
                numbers += (it.id, it.x, it.y, it.heading, it.vx, it.vy, it.omega, it.ball_contact)
        if ball.z or ball.vz:
            numbers += (ball.z, ball.vz)
        return pack(f"<{len(numbers)}d", *numbers)

    def others(self, number: int) -> list[RobotState]:
        """Return every robot on the field but the own one with this number."""
        return [robot for robot in self.own if robot.id != number] + list(self.opponents)

    def teammates(self, number: int) -> list[RobotState]:
        """Return the own robots without the one with this number."""
        return [robot for robot in self.own if robot.id != number]

    def mirrored(self) -> Frame:
        """Return the same instant seen by the other team: all turned by 180 degrees.

        A turn, not a reflection, so velocities and commands in a robot's own
        frame are the same in both views.
        """
        ball = self.ball
        return Frame(
            self.time,
            self.field,
            BallState(-ball.x, -ball.y, -ball.vx, -ball.vy, ball.z, ball.vz),
            tuple([_turned(robot) for robot in self.opponents]),
            tuple([_turned(robot) for robot in self.own]),
            self.team.other,
            self.period,
            self.game.mirrored(),
            self.last_touch,
            self.ball_model,
        )

    def seen_by(self, team: Team) -> Frame:
        """Return this frame from ``team``'s side; itself when it already is."""
        return self if team is self.team else self.mirrored()


def _turned(robot: RobotState) -> RobotState:
    heading = robot.heading
    return RobotState(
        robot.id,
        -robot.x,
        -robot.y,
        heading - pi if heading > 0.0 else heading + pi,
        -robot.vx,
        -robot.vy,
        robot.omega,
        robot.ball_contact,
        robot.limits,
    )
