"""Where a branch starts: the state of robots and ball at a tick of the log."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np

from robobt.match.recording import Recording
from robobt.world.command import RobotCommand
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

_SLIDE_TICKS = 5
"""Number of ticks over which the ball's deceleration is measured."""


def logged_start(recording: Recording, tick: int) -> tuple[Placement, RobotId | None]:
    """Return where everything is at a tick and how it moves, and the robot that holds the ball.

    Robots that are not on the field are placed beside it, to be taken off.

    Args:
        recording: the log.
        tick: number of the tick.
    """
    rows, contact = recording.truth.robots[tick], recording.truth.contact[tick]
    ball = recording.truth.ball[tick].tolist()
    placement = Placement(begin=float(recording.times[tick]))
    most_x, most_y = recording.header.field.outer
    holder = None
    for slot, (robot, row) in enumerate(zip(recording.header.robots, rows.tolist(), strict=True)):
        x, y, heading, vx, vy, omega = row
        if not np.isfinite(x):
            placement.robots[robot.id] = (most_x - 0.2 - 0.2 * slot, most_y - 0.1, 0.0)
            continue
        placement.robots[robot.id] = (min(max(x, -most_x), most_x), min(max(y, -most_y), most_y), heading)
        placement.velocities[robot.id], placement.turning[robot.id] = (vx, vy), omega
        c, s = cos(heading), sin(heading)
        given = recording.command(robot.id, max(0, tick - 1))
        placement.commands[robot.id] = given or RobotCommand(c * vx + s * vy, c * vy - s * vx, omega)
        if contact[slot]:
            holder = robot.id
    placement.ball = (ball[0], ball[1], ball[2], ball[3])
    z, vz = (float(np.nan_to_num(value)) for value in ball[4:6])
    placement.flight = (max(0.0, z), vz if z > 0.0 else 0.0)
    placement.slides = holder is None and _slides(recording, tick)
    return placement, holder


def _slides(recording: Recording, tick: int) -> bool:
    """Return whether the ball slows down as one that slides."""
    first = tick - _SLIDE_TICKS
    if first < 0 or recording.truth.contact[first : tick + 1].any():
        return False
    ball, times = recording.truth.ball, recording.times
    before, now = (hypot(float(ball[t, 2]), float(ball[t, 3])) for t in (first, tick))
    model = recording.header.ball_model
    slowing = (before - now) / max(1e-9, float(times[tick] - times[first]))
    return slowing > 0.5 * (model.slide_deceleration + model.roll_deceleration)
