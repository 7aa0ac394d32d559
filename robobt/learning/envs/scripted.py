"""Hand-written policies on the observations: oracles for tests, and players for benchmarks."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.task import FloatArray
from robobt.models.actions import SCORE_ACTION, SHOOT_ACTION, ActionScaling
from robobt.world.avoiding import FIRST_WAY, SLOW_WAYS, WAY_SPEED, WAYS
from robobt.world.geometry import wrap_angles
from robobt.world.team_view import BALL_INDEX

AIM_GAIN = 6.0
"""Turning rate for each radian off the aim [1/s]."""

_GAIN_TIMES_DELAY = 0.3
"""Turning rate for each radian, times the delay, at which a late robot does not swing: 1 / e for a robot that
then turns at once, less for one that takes a while."""

_GENTLE_PULL = 1.5
"""Deceleration at which most dribblers still hold a ball [m/s^2]."""

_MOUTH_SHARE = 0.6
"""Share of the goal mouth, around its middle, at which the script kicks."""

BEHIND = 0.1
"""Distance behind the ball of a robot that has it [m]."""

_ROUND_BALL_DISTANCE = 0.3
"""Distance behind and beside the ball of the way round it [m]."""

_BALL_IN_MOUTH = 0.13
"""A ball whose centre is within this distance is in the mouth [m]."""

TAKEN_DISTANCE = 0.11
"""A ball whose centre is within this distance is near enough to be turned with [m]."""

_SHOOTING = 1.7
"""Largest distance from the goal for a kick [m]."""

_CORNER = 0.85
"""Aim between the post nearer to the goalkeeper, 0, and the other post, 1."""

_CARRYING_SHARE, _CAREFUL_TURN = 0.4, 2.5
"""Share of its top speed, and turning rate with the ball [rad/s]."""

_KICK_TOLERANCE = 0.05
"""Largest angle error for a kick [rad]."""


_FREE_WAY_TIME = 1.5
"""Time for which a way has to be free [s]."""


def steady_gain(delay: float) -> float:
    """Return the turning rate for each radian off the aim [1/s] for robots that are late by ``delay`` [s]."""
    return min(AIM_GAIN, _GAIN_TIMES_DELAY / delay) if delay > 0.0 else AIM_GAIN


def straight_drive(observation: FloatArray) -> FloatArray:
    """Return the actions (n, 3) that drive at the ball at full speed: the fastest Go-To-Ball.

    The heading is left as it is; each ``observation`` (n, 6) is that of the task Go-To-Ball.
    """
    sin_ball, cos_ball, *_ = observation.T
    return np.column_stack((cos_ball, sin_ball, np.zeros(len(observation))))


def drive_and_face(observation: FloatArray, max_turn: float, gain: float = AIM_GAIN) -> FloatArray:
    """Drive straight at the ball at full speed and turn to it, (n, 6) -> (n, 3)."""
    sin_ball, cos_ball, *_ = observation.T
    turn = np.clip(gain / max_turn * np.arctan2(sin_ball, cos_ball), -1.0, 1.0)
    return np.column_stack((cos_ball, sin_ball, turn))


def straight_drive_among(observation: FloatArray) -> FloatArray:
    """Drive straight at the ball and ignore other robots, (n, 31) -> (n, 3)."""
    return np.column_stack((observation[:, :2], np.zeros(len(observation))))


def freest_way(observation: FloatArray) -> FloatArray:
    """Drive the best way to the ball that stays free until the robot is there, (n, 31) -> (n, 3).

    The cost of a way is its lack of speed towards the ball, and increases the sooner it is blocked.
    """
    fast, slow = (2.0 * np.pi * np.arange(count) / count for count in (WAYS, SLOW_WAYS))
    ahead = np.concatenate((np.cos(fast), 0.5 * np.cos(slow), [0.0]))
    aside = np.concatenate((np.sin(fast), 0.5 * np.sin(slow), [0.0]))
    c, s, distance, vx, vy, *_ = observation.T[..., None]
    needed = np.minimum(_FREE_WAY_TIME, distance / WAY_SPEED)
    free = np.maximum(observation[:, FIRST_WAY:], 0.05)
    x, y = c * ahead - s * aside, s * ahead + c * aside
    changed = np.hypot(x - vx / WAY_SPEED, y - vy / WAY_SPEED)
    cost = -ahead + np.maximum(1.0 / free - 1.0 / needed, 0.0) / WAY_SPEED + 0.05 * changed
    best = cost.argmin(axis=1)[:, None]
    way = np.take_along_axis(x, best, 1), np.take_along_axis(y, best, 1)
    return np.column_stack((*way, np.zeros(len(observation))))


def crowd(observation: FloatArray, learners: int) -> FloatArray:
    """Drive all learners at the ball, (n, learners * size of a team's view) -> (n, learners * 4)."""
    ball = observation.reshape(len(observation), learners, -1)[..., BALL_INDEX : BALL_INDEX + 2]
    actions = np.full((len(observation), learners, SCORE_ACTION.size), -1.0)
    actions[..., :2] = ball / np.maximum(np.linalg.norm(ball, axis=-1, keepdims=True), 1e-6)
    x, y = np.moveaxis(ball, -1, 0)
    turn = AIM_GAIN / SCORE_ACTION.max_turn * np.arctan2(y, x)
    actions[..., 2] = np.clip(turn, -1.0, 1.0)
    return actions.reshape(len(observation), -1)


def drive_to_shoot(observation: FloatArray, max_turn: float) -> FloatArray:
    """Drive at full speed behind the ball, facing the goal; first round the ball if in front of it.

    It maps (n, 8) to (n, 3).
    """
    sin_ball, cos_ball, distance = observation[:, :3].T
    sin_goal, cos_goal = observation[:, 6:].T
    x, y = distance * cos_ball, distance * sin_ball
    ahead, aside = x * cos_goal + y * sin_goal, x * sin_goal - y * cos_goal
    round_it = ahead < BEHIND / 2
    back, left = (
        np.where(round_it, _ROUND_BALL_DISTANCE, BEHIND),
        np.where(round_it, np.copysign(_ROUND_BALL_DISTANCE, aside), 0.0),
    )
    x += left * -sin_goal - back * cos_goal
    y += left * cos_goal - back * sin_goal
    way = np.maximum(np.hypot(x, y), 1e-6)
    omega = np.clip(AIM_GAIN / max_turn * np.arctan2(sin_goal, cos_goal), -1.0, 1.0)
    return np.column_stack((x / way, y / way, omega))


def turn_and_kick(
    observation: FloatArray,
    scaling: ActionScaling = SHOOT_ACTION,
    pull: float = _GENTLE_PULL,
    gain: float = AIM_GAIN,
) -> FloatArray:
    """Turn to the middle of the goal and kick when the ball will leave well between the posts.

    It maps (n, 10) to (n, 2); ``pull`` is the acceleration at which the dribbler holds the ball [m/s^2],
    ``gain`` the turning rate for each radian off the aim [1/s].
    """
    ball_x, ball_y, _, sideways, _, _, sin_upper, cos_upper, sin_lower, cos_lower = observation.T
    upper = np.arctan2(sin_upper, cos_upper)
    lower = np.arctan2(sin_lower, cos_lower)
    half = (np.mod(upper - lower + np.pi, 2 * np.pi) - np.pi) / 2
    middle = np.arctan2(np.sin(lower + half), np.cos(lower + half))
    leaving = np.arctan2(sideways, scaling.kick_speed)
    off = np.arctan2(np.sin(middle - leaving), np.cos(middle - leaving))
    # Turning at rate w with the ball at distance L needs a pull of w^2 L.
    most = np.minimum(scaling.max_turn, np.sqrt(pull / np.hypot(ball_x, ball_y)))
    omega = np.clip(gain * off, -most, most)
    kick = np.where(np.abs(off) < _MOUTH_SHARE * half, 1.0, -1.0)
    return np.column_stack((omega / scaling.max_turn, kick))


def drive_and_kick(
    observation: FloatArray, scaling: ActionScaling = SCORE_ACTION, gain: float = AIM_GAIN
) -> FloatArray:
    """Get the ball, carry it towards the goal, and kick at the corner farther from the goalkeeper.

    It maps (n, 19), :data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`, to (n, 4); ``gain`` is as for
    :func:`turn_and_kick`.
    """
    ball, posts = observation[:, 3:5], observation[:, 9:13].reshape(-1, 2, 2)
    (ball_x, ball_y), (post_x, post_y) = ball.T, np.moveaxis(posts, -1, 0)
    keeper_x, keeper_y = observation[:, 13:15].T
    angles = np.arctan2(post_y, post_x)
    beside = np.abs(wrap_angles(np.arctan2(keeper_y, keeper_x)[:, None] - angles))
    rows, far = np.arange(len(observation)), beside.argmax(axis=1)
    corner = _CORNER * posts[rows, far] + (1.0 - _CORNER) * posts[rows, 1 - far]
    has_it = (np.hypot(ball_x, ball_y) < _BALL_IN_MOUTH) & (np.abs(ball_y) < _BALL_IN_MOUTH / 2)
    aim_x, aim_y = np.where(has_it[:, None], corner, ball).T
    turn = np.arctan2(aim_y, aim_x)
    near = np.hypot(*posts.mean(axis=1).T) < _SHOOTING
    speed = np.where(has_it, np.where(near, 0.0, _CARRYING_SHARE), 1.0)
    way = np.where(has_it[:, None], posts.mean(axis=1), ball)
    drive = speed[:, None] * way / np.hypot(*way.T)[:, None]
    most = np.where(has_it, _CAREFUL_TURN / scaling.max_turn, 1.0)
    omega = np.clip(gain / scaling.max_turn * turn, -most, most)
    kick = np.where(has_it & near & (np.abs(turn) < _KICK_TOLERANCE), 1.0, -1.0)
    return np.column_stack((drive, omega, kick))
