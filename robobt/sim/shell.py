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

from robobt.sim.records import Body, Parameters, SimulatedBall, Wheels
from robobt.world.compiled import compiled_lean, compiled_merged
from robobt.world.state import BALL_RADIUS

_DEEP = 0.03
"""How far behind its face a plate still pushes the ball forward [m]."""

_SWING = 0.03
"""A held ball this far off the middle moves sideways only with its robot [m]."""

_BALL_INERTIA = 0.4
"""Moment of inertia of a solid ball over its mass and radius squared."""


_FRONT_PLATE, _CORE_SPHERE = 0, 5
"""Parts of a robot: its front plate, the four wheels, and its core."""


@compiled_merged
def _out_of_box(x: float, y: float, low: float, high: float, half: float) -> tuple[float, float, float]:
    """Return the normal and depth of a ball at a box [low, high] x [-half, half]; depth < 0 is apart.

    A ball whose centre has got into the box, or just behind its face, leaves by the face.
    """
    if abs(y) <= half and x > low:
        return 1.0, 0.0, high + BALL_RADIUS - x
    dx = x - min(max(x, low), high)
    dy = y - min(max(y, -half), half)
    away = hypot(dx, dy)
    depth = BALL_RADIUS - away
    if away > 0.0:
        return dx / away, dy / away, depth
    return 1.0, 0.0, depth


@compiled_lean
def meet(body: Body, ball: SimulatedBall, robot: Body, p: Parameters, w: Wheels, dt: float) -> None:
    """Let the ball and one robot's plate, wheels and core push each other for one step.

    Args:
        body: of the ball.
        ball: changed.
        robot: its body, changed.
        p: parameters of the arena.
        w: parameters of its robots' wheels.
        dt: time step [s].
    """
    px, py = body.x - robot.x, body.y - robot.y
    reach = w.outer_edge + 2.0 * BALL_RADIUS
    if px * px + py * py > reach * reach:
        return
    c, s = cos(robot.heading), sin(robot.heading)
    x, y = c * px + s * py, c * py - s * px
    ahead = aside = 0.0
    for part in range(_CORE_SPHERE + 1):
        friction = p.contact.hull_friction
        turn_c, turn_s = 1.0, 0.0
        if part == _FRONT_PLATE:
            face = p.body.face
            ahead, aside, depth = _out_of_box(x, y, face - _DEEP, face, p.half_mouth)
            friction = p.contact.front_friction
        elif part < _CORE_SPHERE:
            wheel = w.each[part - _FRONT_PLATE - 1]
            turn_c, turn_s = wheel.cos, wheel.sin
            ahead, aside = turn_c * x + turn_s * y, turn_c * y - turn_s * x
            ahead, aside, depth = _out_of_box(ahead, aside, w.inner_edge, w.outer_edge, p.half_wheel)
        else:
            away = hypot(x, y)
            depth = p.core + BALL_RADIUS - away
            if away > 0.0:
                ahead, aside = x / away, y / away
        if depth <= 0.0:
            continue
        # The normal, from the part's frame to the robot's and on to the field's.
        nx, ny = turn_c * ahead - turn_s * aside, turn_s * ahead + turn_c * aside
        nx, ny = c * nx - s * ny, s * nx + c * ny
        _push_apart(body, ball, robot, nx, ny, p.softness * depth / dt, friction, p, w)


@compiled_merged
def _push_apart(
    body: Body,
    ball: SimulatedBall,
    robot: Body,
    nx: float,
    ny: float,
    parting: float,
    friction: float,
    p: Parameters,
    w: Wheels,
) -> None:
    """Let ball and robot part along the normal (nx, ny) at the speed that their overlap asks for [m/s]."""
    tx, ty = -ny, nx
    # Where they touch, from the robot's centre.
    rx, ry = body.x - robot.x - BALL_RADIUS * nx, body.y - robot.y - BALL_RADIUS * ny
    normal_arm, tangent_arm = rx * ny - ry * nx, rx * ty - ry * tx
    vx = ball.vx - robot.vx + robot.omega * ry
    vy = ball.vy - robot.vy - robot.omega * rx
    mass = 1.0 / p.ball.mass
    give = mass + 1.0 / w.mass + normal_arm * normal_arm / w.inertia
    push = (parting - (vx * nx + vy * ny)) / give
    if push <= 0.0:
        return
    slip = vx * tx + vy * ty - ball.twist * BALL_RADIUS
    give = mass * (1.0 + 1.0 / _BALL_INERTIA) + 1.0 / w.mass + tangent_arm * tangent_arm / w.inertia
    most = friction * push
    rub = min(max(-slip / give, -most), most)
    jx, jy = push * nx + rub * tx, push * ny + rub * ty
    ball.vx += jx * mass
    ball.vy += jy * mass
    ball.twist -= rub * mass / (_BALL_INERTIA * BALL_RADIUS)
    robot.vx -= jx / w.mass
    robot.vy -= jy / w.mass
    robot.omega -= (push * normal_arm + rub * tangent_arm) / w.inertia
    # A ball that rolls away is pressed to the ground, which turns it again; one that comes is lifted.
    rolling = ball.spin_x * nx + ball.spin_y * ny
    loss = max(min(rolling, 0.0), -most * mass / _BALL_INERTIA)
    ball.spin_x -= loss * nx
    ball.spin_y -= loss * ny


@compiled_merged
def drag(body: Body, ball: SimulatedBall, robot: Body, p: Parameters, w: Wheels, dt: float) -> None:
    """Let a held ball weigh on its robot: its inertia, and its friction with the ground.

    The joint's axis lies ahead, above the ball: the ball rolls and swings sideways, the more freely the
    nearer it is to the middle, and slides forward.
    """
    c, s = cos(robot.heading), sin(robot.heading)
    rx, ry = body.x - robot.x, body.y - robot.y
    forward = c * ball.move_x + s * ball.move_y
    most, mass = p.ball.slide_deceleration * dt, p.ball.mass
    slide = min(max(forward, -most), most)
    gain_x, gain_y = ball.move_x - ball.vx, ball.move_y - ball.vy
    along = mass * (c * gain_x + s * gain_y + slide)
    across = mass * (c * gain_y - s * gain_x) * min(abs(c * ry - s * rx) / _SWING, 1.0)
    jx, jy = c * along - s * across, s * along + c * across
    robot.vx -= jx / w.mass
    robot.vy -= jy / w.mass
    robot.omega -= (rx * jy - ry * jx) / w.inertia
