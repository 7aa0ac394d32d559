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

from robobt.sim.columns import (
    BALL_R,
    BOUNCE_DRIVEN,
    BOUNCE_HULL,
    BOUNCE_IDLE,
    FACE,
    GROUND_FRICTION,
    HALF_MOUTH,
    HALF_OPENING,
    HULL_FRICTION,
    JAW,
    ROBOT_R,
    ROLLER,
    ROLLER_FRICTION,
    ROUNDING,
    SLIDE,
    STOP_SPEED,
)
from robobt.world.ball_model import GRAVITY
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray

# Columns of a contact, kept for the length of a step: whether there is one, its normal towards the ball, the
# robot's velocity there, the least speed of parting, friction, how fast the surface moves down, impulses.
_NEAR, _NX, _NY, _VX, _VY, _PART, _MU, _DOWN, _PRESS, _ASIDE, _LIFT = range(11)
CONTACTS = 3
"""Contacts of a ball with one robot: its roller and two jaws."""
SCRATCH = 11

_SWEEPS = 10
"""Passes over the contacts."""

_GAP = 0.004
"""A ball no farther than this from what it may touch is looked at [m]."""

_SOFT = 0.02
"""Slower than this a ball does not bounce [m/s]."""

_TURN = 2.5
"""Change of a solid ball's surface speed over that of its velocity, by an impulse at its surface."""

_IDLE = -1.0
"""Marks a surface that moves up and down with the ball."""


@compiled_lean
def _meet(
    ball: FloatArray,
    velocity: FloatArray,
    robot: FloatArray,
    nx: float,
    ny: float,
    gap: float,
    bounce: float,
    contact: FloatArray,
    p: FloatArray,
    dt: float,
) -> float:
    """Fill in a contact whose normal and gap are given; return after what time the ball bounces, else -1."""
    px, py = ball[0] - robot[0] - p[BALL_R] * nx, ball[1] - robot[1] - p[BALL_R] * ny
    contact[_NX], contact[_NY] = nx, ny
    contact[_VX] = robot[3] - robot[5] * py
    contact[_VY] = robot[4] + robot[5] * px
    contact[_PRESS] = contact[_ASIDE] = contact[_LIFT] = 0.0
    contact[_NEAR] = 1.0
    contact[_PART] = -max(gap, 0.0) / dt
    apart = nx * (velocity[0] - contact[_VX]) + ny * (velocity[1] - contact[_VY])
    if apart > -_SOFT or apart >= contact[_PART]:
        return -1.0
    contact[_PART] = -apart * bounce
    return float(max(gap, 0.0) / -apart)


@compiled_lean
def _arrives(
    ball: FloatArray,
    velocity: FloatArray,
    robot: FloatArray,
    on: float,
    contacts: FloatArray,
    p: FloatArray,
    dt: float,
) -> float:
    """Note where the ball meets a robot in this step; return when it bounces off the roller, else -1."""
    for k in range(CONTACTS):
        contacts[k, _NEAR] = 0.0
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    c, s = cos(robot[2]), sin(robot[2])
    x, y = c * px + s * py, c * py - s * px
    if x < p[FACE] or hypot(px, py) > 4.0 * p[ROBOT_R]:
        return -1.0
    gap = x - p[FACE] - p[BALL_R]
    time, width, there = 0.0, p[HALF_MOUTH], y
    if gap > _GAP:
        # Not there yet: only if it comes in this step, and between the jaws.
        vx, vy = velocity[0] - robot[3] + robot[5] * py, velocity[1] - robot[4] - robot[5] * px
        apart = c * vx + s * vy
        time = gap / -apart if apart < 0.0 else dt
        there += (c * vy - s * vx) * time
        if p[HALF_OPENING] > 0.0:
            width = p[HALF_OPENING] - p[BALL_R]
    bounce = -1.0
    if time < dt and abs(there) <= width:
        bounce = _meet(
            ball,
            velocity,
            robot,
            c,
            s,
            gap,
            p[BOUNCE_DRIVEN] if on > 0.0 else p[BOUNCE_IDLE],
            contacts[0],
            p,
            dt,
        )
        contacts[0, _MU] = p[ROLLER_FRICTION]
        contacts[0, _DOWN] = p[ROLLER] if on > 0.0 else _IDLE
    if p[HALF_OPENING] > 0.0:
        for k in range(1, CONTACTS):
            side = 1.0 if k == 1 else -1.0
            # The middle of the jaw's rounded corner.
            dx = x - p[JAW] + p[ROUNDING]
            dy = y - side * (p[HALF_OPENING] + p[ROUNDING])
            away = hypot(dx, dy)
            gap = away - p[BALL_R] - p[ROUNDING]
            if gap > _GAP or gap < -p[BALL_R] or dx < 0.0 or side * dy > 0.0:
                continue
            nx, ny = (c * dx - s * dy) / away, (s * dx + c * dy) / away
            _meet(ball, velocity, robot, nx, ny, gap, p[BOUNCE_HULL], contacts[k], p, dt)
            contacts[k, _MU] = p[HULL_FRICTION]
            contacts[k, _DOWN] = 0.0
    return bounce


@compiled_lean
def _press(velocity: FloatArray, spin: FloatArray, twist: FloatArray, row: FloatArray, radius: float) -> None:
    """Improve the impulses of one contact and apply what changed."""
    nx, ny = row[_NX], row[_NY]
    vx, vy = velocity[0] - row[_VX], velocity[1] - row[_VY]
    press = max(row[_PRESS] + row[_PART] - (nx * vx + ny * vy), 0.0)
    aside = row[_ASIDE] - (nx * vy - ny * vx - radius * twist[0]) / (1.0 + _TURN)
    lift = row[_LIFT]
    if row[_DOWN] != _IDLE:
        # A ball that rolls away from the robot moves up where they touch.
        lift -= (nx * spin[0] + ny * spin[1] + row[_DOWN]) / _TURN
    rub = hypot(aside, lift)
    if rub > row[_MU] * press:
        aside *= row[_MU] * press / rub
        lift *= row[_MU] * press / rub
    push, side, up = press - row[_PRESS], aside - row[_ASIDE], lift - row[_LIFT]
    row[_PRESS], row[_ASIDE], row[_LIFT] = press, aside, lift
    velocity[0] += nx * push - ny * side
    velocity[1] += ny * push + nx * side
    twist[0] -= _TURN * side / radius
    spin[0] += _TURN * up * nx
    spin[1] += _TURN * up * ny


@compiled_lean
def roll(
    ball: FloatArray,
    velocity: FloatArray,
    spin: FloatArray,
    twist: FloatArray,
    rows: FloatArray,
    first: int,
    driven: FloatArray,
    contacts: FloatArray,
    p: FloatArray,
    dt: float,
) -> bool:
    """Let the rollers, jaws and the ground push a ball at a robot's front for one step.

    Args:
        ball: its row, moved only when it bounces off a roller.
        velocity: of the ball, changed [m/s].
        spin: its rolling as a velocity, changed [m/s].
        twist: (1,) its turning about the vertical, changed [rad/s].
        rows: of robots and balls.
        first: where the arena's robots begin in them.
        driven: (robots,) 1 where the dribbler is on, else 0.
        contacts: (robots, CONTACTS, SCRATCH) scratch.
        p: parameters of the arena.
        dt: time step [s].

    Returns:
        whether the ball is at a front; it moves freely and is unchanged if not.
    """
    found = False
    bounce = -1.0
    for i in range(driven.shape[0]):
        time = _arrives(ball, velocity, rows[first + i], driven[i], contacts[i], p, dt)
        bounce = max(bounce, time)
        for k in range(CONTACTS):
            found = found or contacts[i, k, _NEAR] > 0.0
    if not found:
        return False
    before_x, before_y = velocity[0], velocity[1]
    speed = hypot(velocity[0], velocity[1])
    if speed > 0.0:
        # What slows a sliding ball beside friction.
        keep = max(0.0, 1.0 - max(p[SLIDE] - p[GROUND_FRICTION] * GRAVITY, 0.0) * dt / speed)
        velocity[0] *= keep
        velocity[1] *= keep
    ground_x = ground_y = 0.0
    for _ in range(_SWEEPS):
        weight = GRAVITY * dt
        for i in range(driven.shape[0]):
            for k in range(CONTACTS):
                if contacts[i, k, _NEAR] > 0.0:
                    _press(velocity, spin, twist, contacts[i, k], p[BALL_R])
                    weight -= contacts[i, k, _LIFT]
        jx = ground_x - (velocity[0] - spin[0]) / (1.0 + _TURN)
        jy = ground_y - (velocity[1] - spin[1]) / (1.0 + _TURN)
        most, rub = p[GROUND_FRICTION] * max(weight, 0.0), hypot(jx, jy)
        if rub > most:
            jx *= most / rub
            jy *= most / rub
        velocity[0] += jx - ground_x
        velocity[1] += jy - ground_y
        spin[0] -= _TURN * (jx - ground_x)
        spin[1] -= _TURN * (jy - ground_y)
        ground_x, ground_y = jx, jy
    if bounce > 0.0:
        # It moves on as it came until it bounces.
        ball[0] += (before_x - velocity[0]) * bounce
        ball[1] += (before_y - velocity[1]) * bounce
    if hypot(velocity[0], velocity[1]) < p[STOP_SPEED] and hypot(spin[0], spin[1]) < p[STOP_SPEED]:
        velocity[0] = velocity[1] = spin[0] = spin[1] = 0.0
    return True
