"""Small set-ups for the simulator's own tests."""

from __future__ import annotations

from math import atan2, degrees, hypot

from robobt.sim import SimSettings, SimWorld, preset
from robobt.world import (
    BALL_RADIUS,
    DIVISION_A,
    FieldGeometry,
    Placement,
    RobotCommand,
    RobotId,
    RobotLimits,
    Team,
)
from robobt.world.geometry import wrap_angle

ME = RobotId(Team.BLUE, 0)
IT = RobotId(Team.YELLOW, 0)
HUGE = FieldGeometry(length=50, width=20, goal_width=1, defense_width=2, defense_depth=1)


def one_robot(
    settings: SimSettings | str = "default",
    pose: tuple[float, float, float] = (0, 0, 0),
    ball: tuple[float, float, float, float] = (5, 4, 0, 0),
    period: float = 0.005,
    field: FieldGeometry = DIVISION_A,
    limits: RobotLimits | None = None,
) -> SimWorld:
    """A world with one blue robot, number 0."""
    if isinstance(settings, str):
        settings = preset(settings)
    world = SimWorld(field, {ME: limits}, settings, period)
    world.reset(Placement({ME: pose}, ball), seed=0)
    return world


def holding(settings: SimSettings | str = "default", period: float = 0.005) -> SimWorld:
    """A robot at the origin with the ball in its mouth."""
    if isinstance(settings, str):
        settings = preset(settings)
    ahead = settings.body.face + BALL_RADIUS + 0.0003
    return one_robot(settings, ball=(ahead, 0, 0, 0), period=period)


def ball_offset(world: SimWorld) -> tuple[float, float]:
    """Distance [m] and angle off the heading [deg] of the ball as the robot has it."""
    frame = world.truth()
    me, ball = frame.own[0], frame.ball
    dx, dy = ball.x - me.x, ball.y - me.y
    return hypot(dx, dy), degrees(wrap_angle(atan2(dy, dx) - me.heading))


def kick(world: SimWorld, speed: float) -> None:
    """Command a kick for one period, and go on until it has happened; robots may react late."""
    world.act({ME: RobotCommand(kick_speed=speed)})
    while not world.kicks:
        assert world.time < 1.0, "it never kicked"
        world.act({})


def time_lost(world: SimWorld, command: RobotCommand, seconds: float = 3.0) -> float | None:
    """When the ball, held at first, is more than 30 mm or 45 degrees from its place; None when it is kept."""
    place = world.settings.body.face + BALL_RADIUS
    while world.time < seconds:
        world.act({ME: command})
        distance, angle = ball_offset(world)
        if distance > place + 0.03 or abs(angle) > 45:
            return world.time
    return None
