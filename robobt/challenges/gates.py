"""Count the gates of the dribbling challenge, for many fields at a time.

The challenge's judge and the training task ask the same class. Source: RoboCup 2022 Dribbling Challenge: a
gate is passed when robot and ball have crossed the line between its two robots as a whole, with the ball.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robobt.skills.challenges.carry_along import GATE_POSTS, GATES
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

POSTS_TOUCHED = 2.0 * ROBOT_RADIUS + 0.002
"""Two robots whose centres are this near touch [m]; contact is seen once a tick."""

_GATE_ENDS = np.array([GATE_POSTS[gate] for gate in GATES])
"""The posts of each gate in its turn."""

_RADII = np.array([ROBOT_RADIUS, BALL_RADIUS])


class GateCounter:
    """Counts gates in their order.

    Args:
        n: number of fields.

    Attributes:
        passed: number of gates passed, (n,).
        side: the side of the next gate's line on which robot and ball last were as a whole, with the ball:
            1, -1, or 0 for none yet, (n,).
    """

    def __init__(self, n: int) -> None:
        self.passed = np.zeros(n, dtype=np.int64)
        self.side = np.zeros(n, dtype=np.int64)
        self._through = np.zeros((n, 2), dtype=np.bool_)
        self._before = np.full((n, 2, 2), np.nan)

    def restart(self, which: IntArray, first: IntArray) -> None:
        """Begin again on the fields ``which`` (m,), where ``first`` gates have been passed, (m,)."""
        self.passed[which], self.side[which] = first, 0
        self._through[which], self._before[which] = False, np.nan

    def gate(self, posts: FloatArray) -> FloatArray:
        """Return the posts of the next gate, (n, 2, 2) [m], of all ``posts`` (n, P, 2); the last stays."""
        ends = _GATE_ENDS[np.minimum(self.passed, len(GATES) - 1)]
        gate: FloatArray = np.take_along_axis(posts, ends[..., None], axis=1)
        return gate

    def see(self, posts: FloatArray, me: FloatArray, ball: FloatArray, kept: BoolArray) -> BoolArray:
        """Take in the next true frame of each field.

        Args:
            posts: places of the standing robots by their numbers, (n, P, 2) [m].
            me: place of the robot, (n, 2) [m].
            ball: place of the ball, (n, 2) [m].
            kept: whether the robot has the ball or has not lost it yet, (n,).

        Returns:
            Which robots have passed a gate in this frame, (n,).
        """
        going = self.passed < len(GATES)
        gate, places = self.gate(posts), np.stack((me, ball), axis=1)
        now, was = across(places, gate), across(self._before, gate)
        crossed = np.isfinite(was) & (_sign(was) != _sign(now)) & going[:, None]
        self._through = np.where(crossed, _between(self._before, places, was, now, gate), self._through)
        self._before[going] = places[going]
        sides = np.where(np.abs(now) > _RADII, _sign(now), 0)
        whole = going & kept & (sides[:, 0] == sides[:, 1]) & (sides[:, 0] != 0)
        through = whole & (self.side == -sides[:, 0]) & self._through.all(axis=1)
        # Who loses the ball on the way through begins again with it.
        self.side = np.where(whole, sides[:, 0], np.where(going & ~kept, 0, self.side))
        self._through[going & (whole | ~kept)] = False
        self.passed += through
        # The next gate is crossed from where they are now.
        self.side[through], self._before[through] = 0, np.nan
        passed: BoolArray = through
        return passed


def across(places: FloatArray, gate: FloatArray) -> FloatArray:
    """Return the signed distances (n, k) [m] of places (n, k, 2) from the lines through gates (n, 2, 2)."""
    a, along, length = _line(gate)
    gaps: FloatArray = (
        (places[..., 0] - a[..., 0]) * along[..., 1] - (places[..., 1] - a[..., 1]) * along[..., 0]
    ) / length
    return gaps


def _between(
    before: FloatArray, now: FloatArray, was: FloatArray, is_: FloatArray, gate: FloatArray
) -> BoolArray:
    """Return whether the line is crossed between the posts, (n, k)."""
    a, along, length = _line(gate)
    off = was - is_
    share = np.divide(was, off, out=np.zeros_like(was), where=off != 0.0)
    at = before + share[..., None] * (now - before)
    along_it = ((at - a) * along).sum(axis=-1)
    between: BoolArray = (along_it > 0.0) & (along_it < length**2)
    return between


def _line(gate: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the first post (n, 1, 2), the way to the second (n, 1, 2) and its length (n, 1)."""
    a, b = gate[:, None, 0], gate[:, None, 1]
    return a, b - a, np.linalg.norm(b - a, axis=-1)


def _sign(values: FloatArray) -> IntArray:
    return np.where(values > 0.0, 1, -1)
