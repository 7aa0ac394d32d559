"""Who has the ball: what every skill means by it."""

from __future__ import annotations

from math import cos, hypot, radians, sin

from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

REACH = ROBOT_RADIUS + BALL_RADIUS + 0.02
"""Centre distance below which a ball ahead of the mouth counts as held [m].

Source: RoboBulls' published code, which allows 20 mm between the two.
"""

_MOUTH = cos(radians(45.0))

_ALONG = 1.0
"""Difference of velocities up to which the ball moves along [m/s]; a turning robot swings it."""


def has_ball(robot: RobotState, ball: BallState) -> bool:
    """Whether the ball sensor sees the ball or the ball lies before the mouth.

    The sensor may be silent for a tick while the ball bounces on the dribbler,
    so a ball within 45 degrees of the heading and within :data:`REACH` counts too.
    """
    if robot.ball_contact:
        return True
    dx, dy = ball.x - robot.x, ball.y - robot.y
    if dx > REACH or dx < -REACH or dy > REACH or dy < -REACH:
        return False
    gap = hypot(dx, dy)
    return gap < REACH and cos(robot.heading) * dx + sin(robot.heading) * dy > _MOUTH * gap


def carries(robot: RobotState, ball: BallState) -> bool:
    """Whether the robot has the ball and the ball moves along with it: neither kicked nor bouncing off."""
    return has_ball(robot, ball) and hypot(ball.vx - robot.vx, ball.vy - robot.vy) < _ALONG


def owner(frame: Frame) -> RobotId | None:
    """The robot that has the ball; the nearest one when several claim it, None when nobody does."""
    best: RobotId | None = None
    nearest = 2.0 * REACH
    for team, robots in ((frame.team, frame.own), (frame.team.other, frame.opponents)):
        for robot in robots:
            if has_ball(robot, frame.ball):
                gap = hypot(frame.ball.x - robot.x, frame.ball.y - robot.y)
                if gap < nearest:
                    best, nearest = RobotId(team, robot.id), gap
    return best
