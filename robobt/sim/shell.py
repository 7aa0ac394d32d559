"""What the ball meets on a robot of grSim: a front plate, four wheels, and a sphere between them.

grSim's robot has no hull for the ball: it rebounds from the faces and edges of the
wheels, obliquely, and comes to rest in the gaps between them. grSim's contacts are
soft: they are found once a step, take the speed of approach away, and push a ball out
by a share of its depth. So a ball comes back the faster the deeper it got before it was
noticed, and one that is being pushed stays a little inside the plate.

Friction turns the ball about the vertical, and stops the rolling of a ball that comes.
"""

from __future__ import annotations

from math import cos, hypot, sin

from robobt.sim.columns import (
    BALL_M,
    BALL_R,
    CORE,
    FACE,
    FRONT_FRICTION,
    HALF_MOUTH,
    HALF_WHEEL,
    HULL_FRICTION,
    INERTIA,
    INNER,
    MASS,
    OUTER,
    SLIDE,
    SOFTNESS,
    WHEEL_COS,
    WHEEL_SIN,
)
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray

_DEEP = 0.03
"""How far behind its face a plate still pushes the ball forward [m]."""

_SWING = 0.03
"""A held ball this far off the middle moves sideways only with its robot [m]."""

_BALL_INERTIA = 0.4
"""Moment of inertia of a solid ball over its mass and radius squared."""


@compiled_lean
def _out_of_box(
    x: float, y: float, low: float, high: float, half: float, radius: float, hit: FloatArray
) -> None:
    """Put the normal and depth of a ball at a box [low, high] x [-half, half] into ``hit``; < 0 is apart.

    A ball whose centre has got into the box, or just behind its face, leaves by the face.
    """
    if abs(y) <= half and x > low:
        hit[0], hit[1], hit[2] = 1.0, 0.0, high + radius - x
        return
    dx = x - min(max(x, low), high)
    dy = y - min(max(y, -half), half)
    away = hypot(dx, dy)
    hit[2] = radius - away
    if away > 0.0:
        hit[0], hit[1] = dx / away, dy / away
    else:
        hit[0], hit[1] = 1.0, 0.0


@compiled_lean
def meet(
    ball: FloatArray,
    velocity: FloatArray,
    spin: FloatArray,
    twist: FloatArray,
    robot: FloatArray,
    p: FloatArray,
    w: FloatArray,
    dt: float,
    hit: FloatArray,
) -> None:
    """Let the ball and one robot's plate, wheels and core push each other for one step.

    Args:
        ball: its row.
        velocity: of the ball, changed [m/s].
        spin: its rolling as a velocity, changed [m/s].
        twist: (1,) its turning about the vertical, changed [rad/s].
        robot: its row, changed.
        p: parameters of the arena.
        w: parameters of its robots' wheels.
        dt: time step [s].
        hit: (3,) scratch.
    """
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    radius = p[BALL_R]
    reach = w[OUTER] + 2.0 * radius
    if px * px + py * py > reach * reach:
        return
    c, s = cos(robot[2]), sin(robot[2])
    x, y = c * px + s * py, c * py - s * px
    for part in range(6):
        friction = p[HULL_FRICTION]
        turn_c, turn_s = 1.0, 0.0
        if part == 0:
            _out_of_box(x, y, p[FACE] - _DEEP, p[FACE], p[HALF_MOUTH], radius, hit)
            friction = p[FRONT_FRICTION]
        elif part < 5:
            turn_c, turn_s = w[WHEEL_COS + part - 1], w[WHEEL_SIN + part - 1]
            ahead, aside = turn_c * x + turn_s * y, turn_c * y - turn_s * x
            _out_of_box(ahead, aside, w[INNER], w[OUTER], p[HALF_WHEEL], radius, hit)
        else:
            away = hypot(x, y)
            hit[2] = p[CORE] + radius - away
            if away > 0.0:
                hit[0], hit[1] = x / away, y / away
        depth = hit[2]
        if depth <= 0.0:
            continue
        # The normal, from the part's frame to the robot's and on to the field's.
        nx, ny = turn_c * hit[0] - turn_s * hit[1], turn_s * hit[0] + turn_c * hit[1]
        nx, ny = c * nx - s * ny, s * nx + c * ny
        tx, ty = -ny, nx
        # Where they touch, from the robot's centre.
        rx, ry = px - radius * nx, py - radius * ny
        normal_arm, tangent_arm = rx * ny - ry * nx, rx * ty - ry * tx
        vx = velocity[0] - robot[3] + robot[5] * ry
        vy = velocity[1] - robot[4] - robot[5] * rx
        mass = 1.0 / p[BALL_M]
        give = mass + 1.0 / w[MASS] + normal_arm * normal_arm / w[INERTIA]
        push = (p[SOFTNESS] * depth / dt - (vx * nx + vy * ny)) / give
        if push <= 0.0:
            continue
        slip = vx * tx + vy * ty - twist[0] * radius
        give = mass * (1.0 + 1.0 / _BALL_INERTIA) + 1.0 / w[MASS] + tangent_arm * tangent_arm / w[INERTIA]
        most = friction * push
        rub = min(max(-slip / give, -most), most)
        jx, jy = push * nx + rub * tx, push * ny + rub * ty
        velocity[0] += jx * mass
        velocity[1] += jy * mass
        twist[0] -= rub * mass / (_BALL_INERTIA * radius)
        robot[3] -= jx / w[MASS]
        robot[4] -= jy / w[MASS]
        robot[5] -= (push * normal_arm + rub * tangent_arm) / w[INERTIA]
        # A ball that rolls away is pressed to the ground, which turns it again; one that comes is lifted.
        rolling = spin[0] * nx + spin[1] * ny
        loss = max(min(rolling, 0.0), -most * mass / _BALL_INERTIA)
        spin[0] -= loss * nx
        spin[1] -= loss * ny


@compiled_lean
def drag(
    ball: FloatArray,
    velocity: FloatArray,
    move: FloatArray,
    robot: FloatArray,
    p: FloatArray,
    w: FloatArray,
    dt: float,
) -> None:
    """Let a held ball weigh on its robot: its inertia, and its friction with the ground.

    The joint's axis lies ahead, above the ball: the ball rolls and swings sideways, the more freely the
    nearer it is to the middle, and slides forward.
    """
    c, s = cos(robot[2]), sin(robot[2])
    rx, ry = ball[0] - robot[0], ball[1] - robot[1]
    forward = c * move[0] + s * move[1]
    slide = min(max(forward, -p[SLIDE] * dt), p[SLIDE] * dt)
    gain_x, gain_y = move[0] - velocity[0], move[1] - velocity[1]
    along = p[BALL_M] * (c * gain_x + s * gain_y + slide)
    across = p[BALL_M] * (c * gain_y - s * gain_x) * min(abs(c * ry - s * rx) / _SWING, 1.0)
    jx, jy = c * along - s * across, s * along + c * across
    robot[3] -= jx / w[MASS]
    robot[4] -= jy / w[MASS]
    robot[5] -= (rx * jy - ry * jx) / w[INERTIA]
