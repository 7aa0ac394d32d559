"""A driven roller that spins the ball backwards, so that the ground drives it against the robot.

Nothing pulls at the ball. The roller's surface moves down where it touches the ball, the
ball spins up to that speed, and its friction with the ground pushes it towards the roller;
pressed down by the roller, it weighs more and is pushed harder. So the ball is held while
the robot backs away gently, and slower than the roller turns; it is lost once the roller
no longer presses hard enough to keep up the spin. Sideways the ball rolls along the
roller until a jaw beside the mouth carries it.

Impulses are per mass of the ball, hence changes of velocity. Source of the model: Coulomb
friction at both contacts of a solid ball; ER-Force's simulator has such a roller, with the
coefficients of the preset ``erforce``.
"""

from __future__ import annotations

from math import cos, hypot, sin

from robobt.sim.records import Arena, Body, Front, Parameters, Rub, SimulatedBall
from robobt.world.ball_model import GRAVITY
from robobt.world.compiled import compiled_lean, compiled_merged
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_CONTACTS = 3
"""Contacts of a ball with one robot: its roller and two jaws."""

_ROLLER = 0
"""Which of them is the roller."""

_ROLLER_SWEEPS = 10
"""Passes over the contacts."""

_CONTACT_GAP = 0.004
"""A ball no farther than this from what it may touch is looked at [m]."""

_SOFT = 0.02
"""Slower than this a ball does not bounce [m/s]."""

_SURFACE_SPEED_RATIO = 2.5
"""Change of a solid ball's surface speed over that of its velocity, by an impulse at its surface."""

_IDLE_SURFACE = -1.0
"""Marks a surface that moves up and down with the ball."""


@compiled_merged
def _meet(
    body: Body,
    ball: SimulatedBall,
    robot: Body,
    nx: float,
    ny: float,
    gap: float,
    bounce: float,
    rub: Rub,
    dt: float,
) -> float:
    """Fill in a contact whose normal and gap are given; return after what time the ball bounces, else -1."""
    px, py = body.x - robot.x - BALL_RADIUS * nx, body.y - robot.y - BALL_RADIUS * ny
    rub.nx, rub.ny = nx, ny
    rub.vx = robot.vx - robot.omega * py
    rub.vy = robot.vy + robot.omega * px
    rub.press = rub.aside = rub.lift = 0.0
    rub.near = 1.0
    rub.part = -max(gap, 0.0) / dt
    apart = nx * (ball.vx - rub.vx) + ny * (ball.vy - rub.vy)
    if apart > -_SOFT or apart >= rub.part:
        return -1.0
    rub.part = -apart * bounce
    return float(max(gap, 0.0) / -apart)


@compiled_merged
def _arrives(body: Body, ball: SimulatedBall, robot: Body, front: Front, p: Parameters, dt: float) -> float:
    """Note where the ball meets a robot in this step; return when it bounces off the roller, else -1."""
    for k in range(_CONTACTS):
        front.rubs[k].near = 0.0
    px, py = body.x - robot.x, body.y - robot.y
    c, s = cos(robot.heading), sin(robot.heading)
    x, y = c * px + s * py, c * py - s * px
    if x < p.body.face or hypot(px, py) > 4.0 * ROBOT_RADIUS:
        return -1.0
    gap = x - p.body.face - BALL_RADIUS
    time, width, there = 0.0, p.half_mouth, y
    if gap > _CONTACT_GAP:
        # Not there yet: only if it comes in this step, and between the jaws.
        vx, vy = ball.vx - robot.vx + robot.omega * py, ball.vy - robot.vy - robot.omega * px
        apart = c * vx + s * vy
        time = gap / -apart if apart < 0.0 else dt
        there += (c * vy - s * vx) * time
        if p.half_opening > 0.0:
            width = p.half_opening - BALL_RADIUS
    bounce = -1.0
    if time < dt and abs(there) <= width:
        rub, driven = front.rubs[_ROLLER], front.driven > 0.0
        share = p.dribbler.roller_restitution if driven else p.contact.front_restitution
        bounce = _meet(body, ball, robot, c, s, gap, share, rub, dt)
        rub.friction = p.dribbler.roller_friction
        rub.down = p.roller if driven else _IDLE_SURFACE
    if p.half_opening > 0.0:
        for k in range(_ROLLER + 1, _CONTACTS):
            side = 1.0 if k == _ROLLER + 1 else -1.0
            # The middle of the jaw's rounded corner.
            dx = x - p.front + p.rounding
            dy = y - side * (p.half_opening + p.rounding)
            away = hypot(dx, dy)
            gap = away - BALL_RADIUS - p.rounding
            if gap > _CONTACT_GAP or gap < -BALL_RADIUS or dx < 0.0 or side * dy > 0.0:
                continue
            nx, ny = (c * dx - s * dy) / away, (s * dx + c * dy) / away
            rub = front.rubs[k]
            _meet(body, ball, robot, nx, ny, gap, p.contact.hull_restitution, rub, dt)
            rub.friction = p.contact.hull_friction
            rub.down = 0.0
    return bounce


@compiled_merged
def _press(ball: SimulatedBall, rub: Rub) -> None:
    """Improve the impulses of one contact and apply what changed."""
    nx, ny = rub.nx, rub.ny
    vx, vy = ball.vx - rub.vx, ball.vy - rub.vy
    press = max(rub.press + rub.part - (nx * vx + ny * vy), 0.0)
    aside = rub.aside - (nx * vy - ny * vx - BALL_RADIUS * ball.twist) / (1.0 + _SURFACE_SPEED_RATIO)
    lift = rub.lift
    if rub.down != _IDLE_SURFACE:
        # A ball that rolls away from the robot moves up where they touch.
        lift -= (nx * ball.spin_x + ny * ball.spin_y + rub.down) / _SURFACE_SPEED_RATIO
    slip = hypot(aside, lift)
    if slip > rub.friction * press:
        aside *= rub.friction * press / slip
        lift *= rub.friction * press / slip
    push, side, up = press - rub.press, aside - rub.aside, lift - rub.lift
    rub.press, rub.aside, rub.lift = press, aside, lift
    ball.vx += nx * push - ny * side
    ball.vy += ny * push + nx * side
    ball.twist -= _SURFACE_SPEED_RATIO * side / BALL_RADIUS
    ball.spin_x += _SURFACE_SPEED_RATIO * up * nx
    ball.spin_y += _SURFACE_SPEED_RATIO * up * ny


@compiled_lean
def roll(arena: Arena, dt: float) -> bool:
    """Let the rollers, jaws and the ground push the ball at a robot's front for one step.

    It is moved only when it bounces off a roller.

    Returns:
        whether the ball is at a front; it moves freely and is unchanged if not.
    """
    body, ball, fronts, p = arena.body, arena.ball, arena.fronts, arena.parameters
    ground, stop = p.dribbler.ground_friction, p.ball.stop_speed
    found = False
    bounce = -1.0
    for i in range(len(fronts)):
        time = _arrives(body, ball, arena.robots[i], fronts[i], p, dt)
        bounce = max(bounce, time)
        for k in range(_CONTACTS):
            found = found or fronts[i].rubs[k].near > 0.0
    if not found:
        return False
    before_x, before_y = ball.vx, ball.vy
    speed = hypot(ball.vx, ball.vy)
    if speed > 0.0:
        # What slows a sliding ball beside friction.
        keep = max(0.0, 1.0 - max(p.ball.slide_deceleration - ground * GRAVITY, 0.0) * dt / speed)
        ball.vx *= keep
        ball.vy *= keep
    ground_x = ground_y = 0.0
    for _ in range(_ROLLER_SWEEPS):
        weight = GRAVITY * dt
        for i in range(len(fronts)):
            for k in range(_CONTACTS):
                rub = fronts[i].rubs[k]
                if rub.near > 0.0:
                    _press(ball, rub)
                    weight -= rub.lift
        jx = ground_x - (ball.vx - ball.spin_x) / (1.0 + _SURFACE_SPEED_RATIO)
        jy = ground_y - (ball.vy - ball.spin_y) / (1.0 + _SURFACE_SPEED_RATIO)
        most, slip = ground * max(weight, 0.0), hypot(jx, jy)
        if slip > most:
            jx *= most / slip
            jy *= most / slip
        ball.vx += jx - ground_x
        ball.vy += jy - ground_y
        ball.spin_x -= _SURFACE_SPEED_RATIO * (jx - ground_x)
        ball.spin_y -= _SURFACE_SPEED_RATIO * (jy - ground_y)
        ground_x, ground_y = jx, jy
    if bounce > 0.0:
        # It moves on as it came until it bounces.
        body.x += (before_x - ball.vx) * bounce
        body.y += (before_y - ball.vy) * bounce
    if hypot(ball.vx, ball.vy) < stop and hypot(ball.spin_x, ball.spin_y) < stop:
        ball.vx = ball.vy = ball.spin_x = ball.spin_y = 0.0
    return True
