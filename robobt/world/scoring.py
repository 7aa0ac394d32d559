"""The compiled observation of a robot that is to score on a goalkeeper."""

from __future__ import annotations

from math import atan2, copysign, cos, hypot, sin
from typing import Any

import numpy as np

from robobt.world.compiled import compiled, compiled_lean
from robobt.world.geometry import FloatArray
from robobt.world.observation import (
    ObservationSpec,
    Row,
    ball_named,
    entries,
    kinematics,
    motion,
    record_of,
    robot_named,
    turned,
)
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.state import Frame, RobotState

KICK_SPEED = 6.0
"""Speed of the assumed kick [m/s]."""

FAR_OFF = 1.0
"""Limit of the distance from the goal's middle [m]."""

SCORE_ON_GOALKEEPER = ObservationSpec(
    "score_on_goalkeeper",
    1,
    (
        *entries("vx vy", "m/s", "speed", "max_speed"),
        *entries("omega", "rad/s", "turn", "max_turn"),
        # Beside the line of the heading, less counts than along it.
        *entries("ball_x", "m", "far", 2.0),
        *entries("ball_y", "m", "far", 1.5),
        *entries("ball_vx ball_vy", "m/s", "ball_speed", 3.0),
        *entries("sin_goal cos_goal", most=1.0),
        *entries("upper_post_x", "m", "goal", 4.0),
        *entries("upper_post_y", "m", "goal", 2.0),
        *entries("lower_post_x", "m", "goal", 4.0),
        *entries("lower_post_y", "m", "goal", 2.0),
        *entries("keeper_x", "m", "far", 4.0),
        *entries("keeper_y", "m", "far", 2.0),
        *entries("keeper_vx keeper_vy", "m/s", "keeper_speed", 2.0),
        *entries("aim", "m", FAR_OFF, 0.3),
        *entries("keeper_aside", "m", FAR_OFF / 2, 0.2),
    ),
)
"""The robot's velocity, the ball, the attacked goal and its goalkeeper, in the robot's frame.

Velocities are relative to the field. ``sin_goal`` and ``cos_goal`` are of the angle from the heading to the
middle of the goal. ``aim`` is where a kick of :data:`KICK_SPEED` would cross the goal line, measured from its
middle, at most :data:`FAR_OFF` either way; ``keeper_aside`` how far to the left of such a shot the goalkeeper
is, at most half as much.
"""


_SCORING_FIELDS, _SIZE = record_of(SCORE_ON_GOALKEEPER.entries), SCORE_ON_GOALKEEPER.size


@compiled_lean
def _observe_scoring(
    robot: Robot, ball: Ball, keeper: Robot, goal_x: float, post_y: float, seen: Any
) -> None:
    c, s = cos(robot.heading), sin(robot.heading)
    to_goal = atan2(-robot.y, goal_x - robot.x) - robot.heading
    seen.vx, seen.vy = turned(c, s, robot.vx, robot.vy)
    seen.omega = robot.omega
    seen.ball_x, seen.ball_y = turned(c, s, ball.x - robot.x, ball.y - robot.y)
    seen.ball_vx, seen.ball_vy = turned(c, s, ball.vx, ball.vy)
    seen.sin_goal, seen.cos_goal = sin(to_goal), cos(to_goal)
    seen.upper_post_x, seen.upper_post_y = turned(c, s, goal_x - robot.x, post_y - robot.y)
    seen.lower_post_x, seen.lower_post_y = turned(c, s, goal_x - robot.x, -post_y - robot.y)
    seen.keeper_x, seen.keeper_y = turned(c, s, keeper.x - robot.x, keeper.y - robot.y)
    seen.keeper_vx, seen.keeper_vy = turned(c, s, keeper.vx, keeper.vy)
    # A kicked ball keeps the velocity that it has across the heading.
    vx, vy = KICK_SPEED * c - seen.ball_vy * s, KICK_SPEED * s + seen.ball_vy * c
    fast = hypot(vx, vy)
    crosses = ball.y + (goal_x - ball.x) * vy / vx if vx > 0.1 * fast else copysign(FAR_OFF, vy)
    aside = ((keeper.y - ball.y) * vx - (keeper.x - ball.x) * vy) / fast
    seen.aim = min(max(crosses, -FAR_OFF), FAR_OFF)
    seen.keeper_aside = min(max(aside, -0.5 * FAR_OFF), 0.5 * FAR_OFF)


@compiled
def score_on_goalkeeper_rows(
    robots: FloatArray, balls: FloatArray, goal_x: float, post_y: float
) -> FloatArray:
    """Compute the states :data:`SCORE_ON_GOALKEEPER` of many arenas, (n, 19).

    ``robots`` (n, 2, 6) are attacker and goalkeeper; the rest is as for :func:`shoot_rows`.
    """
    rows = np.empty((len(robots), _SIZE))
    each, rolling, seen = robots.view(ROBOT)[..., 0], balls.view(BALL)[:, 0], rows.view(_SCORING_FIELDS)[:, 0]
    for i in range(len(rows)):
        _observe_scoring(each[i, 0], rolling[i], each[i, 1], goal_x, post_y, seen[i])
    return rows


def score_on_goalkeeper_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the state :data:`SCORE_ON_GOALKEEPER` of one robot in a frame, (19,).

    The goalkeeper is the one in the game's state, else the opponent nearest to the middle of its goal;
    without opponents one is assumed to stand there.
    """
    field, row = frame.field, np.empty(_SIZE)
    goal_x, half_goal = field.half_length, field.goal_width / 2
    keeper: Row = (goal_x, 0.0, 0.0, 0.0, 0.0, 0.0)
    if frame.opponents:
        named = frame.game.status(frame.team.other).keeper
        nearest = min(
            frame.opponents, key=lambda other: (other.id != named, hypot(other.x - goal_x, other.y))
        )
        keeper = kinematics(nearest)
    _scoring_row(kinematics(robot), motion(frame), keeper, goal_x, half_goal, row)
    return row


@compiled
def _scoring_row(robot: Row, ball: Row, keeper: Row, goal_x: float, post_y: float, row: FloatArray) -> None:
    me, opponent, seen = robot_named(robot), robot_named(keeper), row.view(_SCORING_FIELDS)[0]
    _observe_scoring(me, ball_named(ball), opponent, goal_x, post_y, seen)
