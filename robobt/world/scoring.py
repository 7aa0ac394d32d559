"""The observation of a robot that is to score on a goalkeeper, defined once and compiled."""

from __future__ import annotations

from math import atan2, cos, hypot, sin

import numpy as np

from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray
from robobt.world.observation import Row, kinematics, motion, observation_spec
from robobt.world.state import Frame, RobotState

SCORE_ON_GOALKEEPER = observation_spec(
    "score_on_goalkeeper",
    1,
    **dict.fromkeys(("vx", "vy"), "m/s"),
    omega="rad/s",
    **dict.fromkeys(("ball_x", "ball_y"), "m"),
    **dict.fromkeys(("ball_vx", "ball_vy"), "m/s"),
    **dict.fromkeys(("sin_goal", "cos_goal"), "1"),
    **dict.fromkeys(("upper_post_x", "upper_post_y", "lower_post_x", "lower_post_y"), "m"),
    **dict.fromkeys(("keeper_x", "keeper_y"), "m"),
    **dict.fromkeys(("keeper_vx", "keeper_vy"), "m/s"),
)
"""The robot's velocity, the ball, the attacked goal and its goalkeeper, in the robot's frame.

Velocities are those over the field. ``sin_goal`` and ``cos_goal`` are of the angle from the heading to the
middle of the goal.
"""


@compiled
def _observe_scoring(
    robot: Row, ball: Row, keeper: Row, goal_x: float, post_y: float, row: FloatArray
) -> None:
    c, s = cos(robot[2]), sin(robot[2])
    to_goal = atan2(-robot[1], goal_x - robot[0]) - robot[2]
    row[0] = c * robot[3] + s * robot[4]
    row[1] = c * robot[4] - s * robot[3]
    row[2] = robot[5]
    row[7] = sin(to_goal)
    row[8] = cos(to_goal)
    for entry, x, y in (
        (3, ball[0] - robot[0], ball[1] - robot[1]),
        (5, ball[2], ball[3]),
        (9, goal_x - robot[0], post_y - robot[1]),
        (11, goal_x - robot[0], -post_y - robot[1]),
        (13, keeper[0] - robot[0], keeper[1] - robot[1]),
        (15, keeper[3], keeper[4]),
    ):
        row[entry] = c * x + s * y
        row[entry + 1] = c * y - s * x


@compiled
def score_on_goalkeeper_rows(
    robots: FloatArray, balls: FloatArray, goal_x: float, post_y: float
) -> FloatArray:
    """Compute the states :data:`SCORE_ON_GOALKEEPER` of many arenas, (n, 17).

    ``robots`` (n, 2, 6) are attacker and goalkeeper; the rest is as for :func:`shoot_rows`.
    """
    rows = np.empty((len(robots), 17))
    for i in range(len(robots)):
        _observe_scoring(robots[i, 0], balls[i], robots[i, 1], goal_x, post_y, rows[i])
    return rows


def score_on_goalkeeper_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the state :data:`SCORE_ON_GOALKEEPER` of one robot in a frame, (17,).

    The goalkeeper is whom the game's state names, else the opponent nearest to the middle of its goal;
    without any it is as if one stood there.
    """
    field, row = frame.field, np.empty(17)
    goal_x, half_goal = field.half_length, field.goal_width / 2
    keeper: Row = (goal_x, 0.0, 0.0, 0.0, 0.0, 0.0)
    if frame.opponents:
        named = frame.game.status(frame.team.other).keeper
        nearest = min(
            frame.opponents, key=lambda other: (other.id != named, hypot(other.x - goal_x, other.y))
        )
        keeper = kinematics(nearest)
    _observe_scoring(kinematics(robot), motion(frame), keeper, goal_x, half_goal, row)
    return row
