"""The input of a central critic: all robots and the ball, from the side of the learner's team."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from robobt.learning.envs.task import FloatArray
from robobt.sim.records import size
from robobt.world.compiled import record_dtype
from robobt.world.records import ROBOT
from robobt.world.team_view import AWAY


class Turned(Protocol):
    """A robot with the cosine and sine of its heading instead of the heading."""

    x: float
    y: float
    cos: float
    sin: float
    vx: float
    vy: float
    omega: float


TURNED = record_dtype(Turned)


def states_of(robots: FloatArray) -> FloatArray:
    """Return robots (n, R, size(ROBOT)) as (n, R, size(TURNED))."""
    seen = robots.view(ROBOT)
    turned = np.cos(seen["heading"]), np.sin(seen["heading"])
    return np.concatenate((seen["x"], seen["y"], *turned, seen["vx"], seen["vy"], seen["omega"]), axis=-1)


def central_view(
    robots: FloatArray, balls: FloatArray, who: Sequence[int], blue: int, own: int, others: int
) -> FloatArray:
    """Compute the critic's input for the robots ``who``, (n, len(who), entries).

    The entries are those of :class:`Turned` for ``own + others`` robots, and the ball's.

    Both teams see the field as if they attacked towards +x, their own robots first, so one critic serves
    both. Within a team the robots keep their order, so that each keeps its place; a place without a robot
    shows a resting robot behind the field.

    Args:
        robots: (n, R, size(ROBOT)) in field coordinates.
        balls: (n, size(BALL)).
        who: indices of robots.
        blue: number of robots, the first ones, that attack towards +x; the others towards -x.
        own: number of places for the robot's team.
        others: number of places for the other team.
    """
    states = states_of(robots)
    # Half a turn changes every sign except that of omega.
    turn = np.array([1.0 if name == "omega" else -1.0 for name in TURNED.names or ()])
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
    places = np.zeros((n, own + others, size(TURNED)))
    places.view(TURNED)["x"] = -AWAY
    places[:, : team.shape[1]] = team
    places[:, own : own + rest.shape[1]] = rest
    return np.concatenate((places.reshape(n, -1), balls), axis=1)
