"""What a central critic sees: everybody and the ball, as the team of who is asked about sees the field."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robobt.learning.envs.task import FloatArray
from robobt.world.team_view import AWAY

EACH, BALL = 7, 4
"""Entries of a robot: x, y, the heading's cosine and sine, vx, vy, omega; and of the ball: x, y, vx, vy."""


def states_of(robots: FloatArray) -> FloatArray:
    """Return robots (n, R, 6) as (n, R, EACH)."""
    turned = np.cos(robots[..., 2:3]), np.sin(robots[..., 2:3])
    return np.concatenate((robots[..., :2], *turned, robots[..., 3:]), axis=-1)


def central_view(
    robots: FloatArray, balls: FloatArray, who: Sequence[int], blue: int, own: int, others: int
) -> FloatArray:
    """Compute what the critic sees of the robots ``who``, (n, len(who), EACH * (own + others) + BALL).

    Both teams see the field as if they attacked towards +x, their own robots first: one critic serves both.
    Within a team robots stand in their order, so that it is known which is which; a place without a robot
    shows one at rest behind the field.

    Args:
        robots: (n, R, 6) x, y, heading, vx, vy, omega in field coordinates.
        balls: (n, 4) x, y, vx, vy.
        who: indices of robots.
        blue: how many robots, the first, attack towards +x; the others towards -x.
        own: places for the robot's team.
        others: for the other.
    """
    states = states_of(robots)
    # Half a turn changes every sign but that of omega.
    turn = np.array([-1.0] * (EACH - 1) + [1.0])
    first, last = states[:, :blue], states[:, blue:]
    seen: dict[bool, FloatArray] = {}
    for is_blue in {index < blue for index in who}:
        if is_blue:
            seen[True] = _team_first(first, last, balls, own, others)
        else:
            seen[False] = _team_first(last * turn, first * turn, -balls, own, others)
    return np.stack([seen[index < blue] for index in who], axis=1)


def _team_first(team: FloatArray, rest: FloatArray, balls: FloatArray, own: int, others: int) -> FloatArray:
    n = len(balls)
    places = np.zeros((n, own + others, EACH))
    places[..., 0] = -AWAY
    places[:, : team.shape[1]] = team
    places[:, own : own + rest.shape[1]] = rest
    return np.concatenate((places.reshape(n, -1), balls), axis=1)
