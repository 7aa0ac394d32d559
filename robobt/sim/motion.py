"""How a robot follows its command, and how a free ball slides and rolls.

The ball is modelled as Sumatra does, with the spin as a second velocity: ``spin``
is the velocity at which the ball would roll without sliding. While the two
differ the ball slides, losing speed and gaining spin; once they agree it rolls.
A ball kicked from rest then rolls from ``switch_share`` of its first speed on.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

from robobt.sim.columns import (
    FORWARD_DOWN,
    FORWARD_UP,
    MAX_SPEED,
    MAX_TURN,
    OMEGA,
    ROLL,
    SIDE_DOWN,
    SIDE_UP,
    SLIDE,
    SPIN_GAIN,
    STOP_SPEED,
    TURN_RATE,
    VX,
    VY,
)
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray

_SURE = 1.0 - 1e-9
"""Rounding may not make more of a change of velocity than it is."""


@compiled_lean
def drive(row: FloatArray, command: FloatArray, p: FloatArray, dt: float) -> None:
    """Move a robot's velocity towards its command within its limits."""
    c, s = cos(row[2]), sin(row[2])
    target_vx, target_vy = command[VX], command[VY]
    if abs(target_vx) + abs(target_vy) > p[MAX_SPEED]:
        speed = hypot(target_vx, target_vy)
        if speed > p[MAX_SPEED]:
            target_vx *= p[MAX_SPEED] / speed
            target_vy *= p[MAX_SPEED] / speed
    dx = c * target_vx - s * target_vy - row[3]
    dy = s * target_vx + c * target_vy - row[4]
    if dx * row[3] + dy * row[4] < 0.0:
        along, across = p[FORWARD_DOWN], p[SIDE_DOWN]
    else:
        along, across = p[FORWARD_UP], p[SIDE_UP]
    # What the weaker limit allows needs no longer look.
    if abs(dx) + abs(dy) > _SURE * min(along, across) * dt:
        step = hypot(dx, dy)
        ahead = (c * dx + s * dy) / step
        aside = (c * dy - s * dx) / step
        # The wheels' limits form an ellipse in the robot's frame.
        most = dt / sqrt((ahead / along) ** 2 + (aside / across) ** 2)
        if step > most:
            dx *= most / step
            dy *= most / step
    row[3] += dx
    row[4] += dy
    turn = min(max(command[OMEGA], -p[MAX_TURN]), p[MAX_TURN]) - row[5]
    most = p[TURN_RATE] * dt
    row[5] += min(max(turn, -most), most)


@compiled_lean
def friction(velocity: FloatArray, spin: FloatArray, p: FloatArray, dt: float, move: FloatArray) -> None:
    """Let a free ball slide and roll for ``dt``; ``move`` receives its mean velocity."""
    start_x, start_y = velocity[0], velocity[1]
    left = dt
    moved_x = moved_y = 0.0
    slip_x, slip_y = velocity[0] - spin[0], velocity[1] - spin[1]
    slip = hypot(slip_x, slip_y) if slip_x != 0.0 or slip_y != 0.0 else 0.0
    if slip > 1e-9:
        slip_x /= slip
        slip_y /= slip
        sliding = min(slip / (p[SLIDE] * (1.0 + p[SPIN_GAIN])), dt)
        loss = p[SLIDE] * sliding
        moved_x = (start_x - 0.5 * loss * slip_x) * sliding
        moved_y = (start_y - 0.5 * loss * slip_y) * sliding
        velocity[0] -= loss * slip_x
        velocity[1] -= loss * slip_y
        spin[0] += p[SPIN_GAIN] * loss * slip_x
        spin[1] += p[SPIN_GAIN] * loss * slip_y
        left = dt - sliding
    if left > 0.0:
        speed = hypot(velocity[0], velocity[1])
        if speed > 0.0:
            rolling = min(left, speed / p[ROLL])
            mean = (speed - 0.5 * p[ROLL] * rolling) * rolling / speed
            moved_x += velocity[0] * mean
            moved_y += velocity[1] * mean
            keep = (speed - p[ROLL] * rolling) / speed
            velocity[0] *= keep
            velocity[1] *= keep
        spin[0] = velocity[0]
        spin[1] = velocity[1]
        if abs(velocity[0]) < p[STOP_SPEED] and hypot(velocity[0], velocity[1]) < p[STOP_SPEED]:
            velocity[0] = velocity[1] = spin[0] = spin[1] = 0.0
    move[0] = moved_x / dt
    move[1] = moved_y / dt
