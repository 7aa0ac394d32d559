"""The observation of a robot that is to score on a goalkeeper, defined once and compiled."""

from __future__ import annotations

from math import atan2, copysign, cos, hypot, sin

import numpy as np

from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray
from robobt.world.observation import ObservationSpec, Row, entries, kinematics, motion
from robobt.world.state import Frame, RobotState

KICK_SPEED = 6.0
"""The kick that is thought of [m/s]."""

FAR_OFF = 1.0
"""What misses the goal by as much misses it [m]."""

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

Velocities are those over the field. ``sin_goal`` and ``cos_goal`` are of the angle from the heading to the
middle of the goal. ``aim`` is where a kick of :data:`KICK_SPEED` would cross the goal line, measured from its
middle, at most :data:`FAR_OFF` either way; ``keeper_aside`` how far to the left of such a shot the goalkeeper
is, at most half as much.
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
    # A kicked ball keeps the velocity that it has across the heading.
    vx, vy = KICK_SPEED * c - row[6] * s, KICK_SPEED * s + row[6] * c
    fast = hypot(vx, vy)
    crosses = ball[1] + (goal_x - ball[0]) * vy / vx if vx > 0.1 * fast else copysign(FAR_OFF, vy)
    aside = ((keeper[1] - ball[1]) * vx - (keeper[0] - ball[0]) * vy) / fast
    row[17] = min(max(crosses, -FAR_OFF), FAR_OFF)
    row[18] = min(max(aside, -0.5 * FAR_OFF), 0.5 * FAR_OFF)


@compiled
def score_on_goalkeeper_rows(
    robots: FloatArray, balls: FloatArray, goal_x: float, post_y: float
) -> FloatArray:
    """Compute the states :data:`SCORE_ON_GOALKEEPER` of many arenas, (n, 19).

    ``robots`` (n, 2, 6) are attacker and goalkeeper; the rest is as for :func:`shoot_rows`.
    """
    rows = np.empty((len(robots), 19))
    for i in range(len(robots)):
        _observe_scoring(robots[i, 0], balls[i], robots[i, 1], goal_x, post_y, rows[i])
    return rows


def score_on_goalkeeper_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the state :data:`SCORE_ON_GOALKEEPER` of one robot in a frame, (19,).

    The goalkeeper is whom the game's state names, else the opponent nearest to the middle of its goal;
    without any it is as if one stood there.
    """
    field, row = frame.field, np.empty(19)
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
