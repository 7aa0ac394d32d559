"""Robots and frames made by hand, for tests of a single decision."""

from __future__ import annotations

from math import cos, sin

from robobt.world import (
    DIVISION_B,
    OPEN_PLAY,
    BallState,
    FieldGeometry,
    Frame,
    GameState,
    RobotId,
    RobotLimits,
    RobotState,
    Team,
)
from robobt.world.geometry import Point

HELD = 0.0965
"""Distance of a held ball's centre from the robot's [m]."""


def robot(
    x: float = 0.0,
    y: float = 0.0,
    heading: float = 0.0,
    number: int = 0,
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
    contact: bool = False,
    limits: RobotLimits | None = None,
) -> RobotState:
    """Return a robot.

    Args:
        x: of its centre [m].
        y: of its centre [m].
        heading: where it looks; 0 is towards the opponents' goal [rad].
        number: its number.
        velocity: along x and y [m/s], and of its turn [rad/s].
        contact: whether the ball touches its kicker.
        limits: how fast it can drive; the usual ones by default.
    """
    return RobotState(number, x, y, heading, *velocity, contact, limits or RobotLimits())


def frame(
    me: RobotState,
    ball: tuple[float, ...] = (0.0, 0.0),
    mates: tuple[RobotState, ...] = (),
    opponents: tuple[RobotState, ...] = (),
    time: float = 0.0,
    game: GameState = OPEN_PLAY,
    field: FieldGeometry = DIVISION_B,
    period: float = 1 / 60,
    team: Team = Team.BLUE,
    last_touch: RobotId | None = None,
) -> Frame:
    """Return a frame around a robot, as its team sees it.

    Args:
        me: the robot.
        ball: its place (x, y) [m], or with its velocity (x, y, vx, vy) [m, m/s].
        mates: the other robots of the team.
        opponents: those of the other team.
        time: of the frame [s].
        game: what the referee says; by default the ball is in play.
        field: its dimensions.
        period: until the next frame [s].
        team: whose view it is.
        last_touch: who touched the ball last.
    """
    own = tuple(sorted((me, *mates), key=lambda mate: mate.id))
    return Frame(time, field, BallState(*ball), own, opponents, team, period, game, last_touch)


def held(me: RobotState) -> Point:
    """Return where the ball lies that is at the kicker of ``me`` [m]."""
    return (me.x + HELD * cos(me.heading), me.y + HELD * sin(me.heading))
