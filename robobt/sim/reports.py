"""What is told of the arenas after a tick: where everything is, who has the ball, who touched it last."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from robobt.sim.columns import BALL_R, JAW, ROBOT_R, SENSOR, Z
from robobt.sim.mouth import in_mouth
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray
from robobt.world.state import RECEIVED_HEIGHT

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

_TOUCH = 2e-3
"""Gap between ball and robot that still counts as a touch [m]."""


@compiled_lean
def note_touch(rows: FloatArray, first: int, robots: int, p: FloatArray, touch: IntArray, a: int) -> None:
    """Remember who touches the ball; of several, one that did not touch it before."""
    ball = rows[first + robots]
    found = -1
    for i in range(robots):
        row = rows[first + i]
        px, py = ball[0] - row[0], ball[1] - row[1]
        reach = p[ROBOT_R] + p[BALL_R] + _TOUCH
        if px * px + py * py > reach * reach:
            continue
        if cos(row[2]) * px + sin(row[2]) * py > p[JAW] + p[BALL_R] + _TOUCH:
            continue
        if found < 0 or found == touch[a]:
            found = i
    if found >= 0:
        touch[a] = found


@compiled_lean
def _report(row: FloatArray, out: FloatArray) -> None:
    """Copy a robot's row, heading in (-pi, pi]."""
    out[0] = row[0]
    out[1] = row[1]
    heading = row[2]
    if not 0.0 <= heading <= pi:
        heading = heading + 2.0 * pi if -pi <= heading < 0.0 else heading % (2.0 * pi)
        if heading > pi:
            heading -= 2.0 * pi
    out[2] = heading
    out[3] = row[3]
    out[4] = row[4]
    out[5] = row[5]


@compiled_lean
def report(
    rows: FloatArray,
    arena_parameters: FloatArray,
    ball_velocity: FloatArray,
    flight: FloatArray,
    contact: BoolArray,
    robots_out: FloatArray,
    balls_out: FloatArray,
) -> None:
    """Fill the outputs of :func:`robobt.sim.kernels.control_tick` from the rows."""
    arenas, robots = contact.shape
    stride = len(rows) // arenas
    for a in range(arenas):
        first = a * stride
        ball = rows[first + robots]
        for i in range(robots):
            row = rows[first + i]
            p = arena_parameters[a]
            contact[a, i] = flight[a, Z] < RECEIVED_HEIGHT and in_mouth(ball, row, p, p[SENSOR])
            _report(row, robots_out[a, i])
        balls_out[a, 0] = ball[0]
        balls_out[a, 1] = ball[1]
        balls_out[a, 2] = ball_velocity[a, 0]
        balls_out[a, 3] = ball_velocity[a, 1]
