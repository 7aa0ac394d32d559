"""An arena from the side of one of its teams."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robobt.world.compiled import compilable, numbers_dtype
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.records import Ball, Limits, Mover, Robot
from robobt.world.rules import before_mouth

FIELD_GEOMETRY = numbers_dtype(FieldGeometry)
"""The record of a :class:`~robobt.world.field.FieldGeometry` for compiled code."""


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
def see_robots(
    robots: Sequence[Robot],
    contact: NDArray[np.bool_],
    rows: NDArray[np.int64],
    sign: float,
    own: Limits,
    ball: Ball,
    seen: Sequence[Robot],
    movers: Sequence[Mover],
    has: NDArray[np.bool_],
) -> None:
    """Fill in an arena's robots as the team sees them that attacks ``sign`` times x.

    Args:
        robots: in field coordinates.
        contact: (R,) in whose mouth the ball lies.
        rows: (R,) which robots they are, the team's own first.
        sign: of x.
        own: what the team's robots can do, and the others as well.
        ball: as the team sees it.
        seen: (R,) filled with the robots.
        movers: (R,) filled with the same.
        has: (R,) filled with who has the ball.
    """
    for row in range(len(rows)):
        robot, mover = seen[row], movers[row]
        see_robot(robots[rows[row]], sign, robot)
        mover.x, mover.y, mover.vx, mover.vy = robot.x, robot.y, robot.vx, robot.vy
        mover.max_speed, mover.acceleration, mover.braking = own.max_speed, own.acceleration, own.braking
        mover.number = row
        dx, dy = ball.x - robot.x, ball.y - robot.y
        has[row] = contact[rows[row]] or before_mouth(dx, dy, robot.heading)


@compilable
def see_ball(ball: Ball, sign: float, seen: Ball) -> None:
    """Fill in the ball as the team sees it that attacks ``sign`` times x."""
    seen.x, seen.y, seen.vx, seen.vy = sign * ball.x, sign * ball.y, sign * ball.vx, sign * ball.vy
