"""What ties robots together that hold the same ball: grSim hinges it to each of them.

Two such robots turn about the ball and drive where both agree; neither gets away with it.
Source: two robots face to face in the running grSim, which the tests repeat.
"""

from __future__ import annotations

from math import cos, sin

from robobt.sim.columns import INERTIA, MASS
from robobt.sim.wheels import AHEAD, ASIDE, HELD
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray

_SWEEPS = 4
"""Passes over the robots that hold the ball."""

_SOFTNESS = 0.2
"""Share of a gap between two hinges that is closed in a step, as ODE does by default."""


@compiled_lean
def take_hold(ball: FloatArray, robot: FloatArray, state: FloatArray) -> None:
    """Hinge the ball to a robot where it lies."""
    c, s = cos(robot[2]), sin(robot[2])
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    state[HELD], state[AHEAD], state[ASIDE] = 1.0, c * px + s * py, c * py - s * px


@compiled_lean
def tie(rows: FloatArray, first: int, carrier: int, wheels: FloatArray, w: FloatArray, dt: float) -> None:
    """Let no robot that holds the ball leave the one that carries it.

    Args:
        rows: of the arenas' bodies; velocities are changed.
        first: row of the arena's first robot.
        carrier: the robot that carries the ball.
        wheels: (R, WHEEL_STATE) of the arena's robots.
        w: parameters of their wheels.
        dt: time step [s].
    """
    one = rows[first + carrier]
    ax, ay = _arm(one, wheels[carrier])
    mass, inertia = 1.0 / w[MASS], 1.0 / w[INERTIA]
    for _ in range(_SWEEPS):
        for i in range(len(wheels)):
            if i == carrier or wheels[i, HELD] == 0.0:
                continue
            other = rows[first + i]
            bx, by = _arm(other, wheels[i])
            # How fast the hinges part, and how fast they are to come together.
            gx = one[3] - one[5] * ay - other[3] + other[5] * by
            gy = one[4] + one[5] * ax - other[4] - other[5] * bx
            gx += _SOFTNESS / dt * (one[0] + ax - other[0] - bx)
            gy += _SOFTNESS / dt * (one[1] + ay - other[1] - by)
            # The impulse that does it: a point constraint between two rigid bodies.
            kxx = 2.0 * mass + (ay * ay + by * by) * inertia
            kyy = 2.0 * mass + (ax * ax + bx * bx) * inertia
            kxy = -(ax * ay + bx * by) * inertia
            scale = 1.0 / (kxx * kyy - kxy * kxy)
            jx, jy = scale * (kyy * gx - kxy * gy), scale * (kxx * gy - kxy * gx)
            one[3] -= jx * mass
            one[4] -= jy * mass
            one[5] -= (ax * jy - ay * jx) * inertia
            other[3] += jx * mass
            other[4] += jy * mass
            other[5] += (bx * jy - by * jx) * inertia


@compiled_lean
def _arm(robot: FloatArray, state: FloatArray) -> tuple[float, float]:
    """Return from the robot's centre to its hinge [m]."""
    c, s = cos(robot[2]), sin(robot[2])
    return c * state[AHEAD] - s * state[ASIDE], s * state[AHEAD] + c * state[ASIDE]
