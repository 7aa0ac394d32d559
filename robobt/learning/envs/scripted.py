"""Policies written by hand over the observations alone: oracles for tests, and players for benchmarks."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.task import FloatArray
from robobt.models.actions import SHOOT_ACTION, ActionScaling

_TURN_GAIN = 8.0
_GENTLE_TURN = 4.0
"""Turning rate at which dribblers keep the ball [rad/s]."""

_AIM = 0.25
"""Share of the goal's width as an angle by which a kick may be off its middle."""


def straight_drive(observation: FloatArray) -> FloatArray:
    """Drive at full speed at the ball, whatever the heading: the time-optimal Go-To-Ball.

    Args:
        observation: (n, 6).

    Returns:
        (n, 3) actions.
    """
    actions = np.zeros((len(observation), 3))
    actions[:, 0] = observation[:, 1]
    actions[:, 1] = observation[:, 0]
    return actions


def turn_and_kick(observation: FloatArray, scaling: ActionScaling = SHOOT_ACTION) -> FloatArray:
    """Turn gently to the middle between the posts, then kick.

    Args:
        observation: (n, 10).
        scaling: of the actions.

    Returns:
        (n, 2) actions.
    """
    left = np.arctan2(observation[:, 6], observation[:, 7])
    right = np.arctan2(observation[:, 8], observation[:, 9])
    middle = np.arctan2(np.sin(left) + np.sin(right), np.cos(left) + np.cos(right))
    turn = np.clip(_TURN_GAIN * middle, -_GENTLE_TURN, _GENTLE_TURN)
    # A turning robot's ball leaves to the side in which it turns.
    aside = observation[:, 4] * observation[:, 0] / scaling.kick_speed
    aims = np.abs(middle - aside) < _AIM * np.abs(np.arcsin(np.sin(left - right)))
    return np.column_stack((turn / scaling.max_turn, np.where(aims, 1.0, -1.0)))
