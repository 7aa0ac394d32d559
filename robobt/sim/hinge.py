"""The joint between robots that hold the same ball: grSim hinges the ball to each of them.

Two such robots turn about the ball and move only as both drive; neither can leave with it.
Source: two robots face to face in the running grSim, which the tests repeat.
"""

from __future__ import annotations

from math import cos, sin

from robobt.sim.records import Body, Hinge, Records, WheelDrive, Wheels
from robobt.world.compiled import compiled_merged

_HINGE_SWEEPS = 4
"""Passes over the robots that hold the ball."""

_SOFTNESS = 0.2
"""Share of a gap between two hinges that is closed in a step, as ODE does by default."""


@compiled_merged
def take_hold(body: Body, robot: Body, hinge: Hinge) -> None:
    """Hinge the ball to a robot at its present place."""
    c, s = cos(robot.heading), sin(robot.heading)
    px, py = body.x - robot.x, body.y - robot.y
    hinge.held, hinge.ahead, hinge.aside = 1.0, c * px + s * py, c * py - s * px


@compiled_merged
def tie(robots: Records[Body], drives: Records[WheelDrive], carrier: int, w: Wheels, dt: float) -> None:
    """Keep all robots that hold the ball together with the robot that carries it.

    Args:
        robots: (R,) bodies; velocities are changed.
        drives: (R,) what is kept of their wheels, and of how they hold the ball.
        carrier: the robot that carries the ball.
        w: parameters of their wheels.
        dt: time step [s].
    """
    one = robots[carrier]
    ax, ay = _arm(one, drives[carrier].hinge)
    mass, inertia = 1.0 / w.mass, 1.0 / w.inertia
    for _ in range(_HINGE_SWEEPS):
        for i in range(len(robots)):
            if i == carrier or drives[i].hinge.held == 0.0:
                continue
            other = robots[i]
            bx, by = _arm(other, drives[i].hinge)
            # How fast the hinges part, and how fast they are to come together.
            gx = one.vx - one.omega * ay - other.vx + other.omega * by
            gy = one.vy + one.omega * ax - other.vy - other.omega * bx
            gx += _SOFTNESS / dt * (one.x + ax - other.x - bx)
            gy += _SOFTNESS / dt * (one.y + ay - other.y - by)
            # The impulse that does it: a point constraint between two rigid bodies.
            kxx = 2.0 * mass + (ay * ay + by * by) * inertia
            kyy = 2.0 * mass + (ax * ax + bx * bx) * inertia
            kxy = -(ax * ay + bx * by) * inertia
            scale = 1.0 / (kxx * kyy - kxy * kxy)
            jx, jy = scale * (kyy * gx - kxy * gy), scale * (kxx * gy - kxy * gx)
            one.vx -= jx * mass
            one.vy -= jy * mass
            one.omega -= (ax * jy - ay * jx) * inertia
            other.vx += jx * mass
            other.vy += jy * mass
            other.omega += (bx * jy - by * jx) * inertia


@compiled_merged
def _arm(robot: Body, hinge: Hinge) -> tuple[float, float]:
    """Return from the robot's centre to its hinge [m]."""
    c, s = cos(robot.heading), sin(robot.heading)
    return c * hinge.ahead - s * hinge.aside, s * hinge.ahead + c * hinge.aside
