"""An arena as one of its teams plays in it."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robobt.world.compiled import compilable
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.records import Ball, Robot

Arenas = tuple[FloatArray, FloatArray, NDArray[np.bool_]]
"""States of robots (n, R, 6) and balls (n, 4), and who has the ball in its mouth (n, R)."""


class Side(NamedTuple):
    """An arena in field coordinates, with a team of it.

    Attributes:
        robots: of both teams.
        ball: the ball.
        first, last: the team's own are ``robots[first:last]``.
        sign: of x in which it attacks.
    """

    robots: Sequence[Robot]
    ball: Ball
    first: int
    last: int
    sign: float


@compilable
def side_of(me: int, blue: int, count: int) -> tuple[int, int, float]:
    """Return first, last and sign of the team of one of ``count`` robots; the first ``blue`` attack to +x."""
    return (0, blue, 1.0) if me < blue else (blue, count, -1.0)


@compilable
def see_robot(robot: Robot, sign: float, seen: Robot) -> None:
    """Fill in a robot as the team sees it that attacks ``sign`` times x."""
    seen.x, seen.y, seen.vx, seen.vy = sign * robot.x, sign * robot.y, sign * robot.vx, sign * robot.vy
    seen.heading = robot.heading if sign > 0.0 else wrap_angle(robot.heading + pi)
    seen.omega = robot.omega


@compilable
def see_ball(ball: Ball, sign: float, seen: Ball) -> None:
    """Fill in the ball as the team sees it that attacks ``sign`` times x."""
    seen.x, seen.y, seen.vx, seen.vy = sign * ball.x, sign * ball.y, sign * ball.vx, sign * ball.vy
