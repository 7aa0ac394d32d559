"""Policies written by hand over the observations alone: oracles for tests, and players for benchmarks."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.task import FloatArray
from robobt.models.actions import SHOOT_ACTION, ActionScaling

AIM_GAIN = 6.0
"""Turning rate for each radian off the aim [1/s]."""

_GENTLE_PULL = 1.5
"""What most dribblers hold a ball with, and more [m/s^2]."""

_INSIDE = 0.6
"""Share of the goal mouth, around its middle, at which the script kicks."""


def straight_drive(observation: FloatArray) -> FloatArray:
    """Drive at the ball at full speed, whatever the heading, (n, 6) -> (n, 3): the fastest Go-To-Ball."""
    actions = np.zeros((len(observation), 3))
    actions[:, 0] = observation[:, 1]
    actions[:, 1] = observation[:, 0]
    return actions


def turn_and_kick(
    observation: FloatArray, scaling: ActionScaling = SHOOT_ACTION, pull: float = _GENTLE_PULL
) -> FloatArray:
    """Turn to the middle of the goal and kick when the ball will leave well between the posts.

    It takes (n, 10) and answers (n, 2); ``pull`` is what the dribbler is relied on to hold with [m/s^2].
    """
    ball_x, ball_y, _, sideways = observation[:, :4].T
    upper = np.arctan2(observation[:, 6], observation[:, 7])
    lower = np.arctan2(observation[:, 8], observation[:, 9])
    half = (np.mod(upper - lower + np.pi, 2 * np.pi) - np.pi) / 2
    middle = np.arctan2(np.sin(lower + half), np.cos(lower + half))
    leaving = np.arctan2(sideways, scaling.kick_speed)
    off = np.arctan2(np.sin(middle - leaving), np.cos(middle - leaving))
    # A ball at distance L that is turned with at w needs a pull of w^2 L to stay.
    most = np.minimum(scaling.max_turn, np.sqrt(pull / np.hypot(ball_x, ball_y)))
    omega = np.clip(AIM_GAIN * off, -most, most)
    kick = np.where(np.abs(off) < _INSIDE * half, 1.0, -1.0)
    return np.column_stack((omega / scaling.max_turn, kick))
