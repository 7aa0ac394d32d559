"""A ball in the air: it falls, hops, and passes over what it is higher than.

The hops are those of the league's model chip_fixed_loss: at a touch-down the ball keeps a
share of its speed along the ground, a smaller one at the first than at the others, and
rises with a share of the speed with which it fell. Each step is the closed form, with the
touch-down at its exact time. Once the next hop would be lower than 1 cm the ball rolls.

pymunk's space is flat. A ball below the robots' height is in it as on the ground, and
meets what it meets there. A higher one is kept out of it, meets only the walls around the
field, which end nowhere, and hops on the robot or goal on which it falls.
"""

from __future__ import annotations

from math import sqrt

from robobt.sim.columns import BALL_R, BOUNCE_WALL, HOP_FIRST, HOP_OTHER, HOP_UP, HOPS, RISE, ROBOT_R, Z
from robobt.sim.sweep import in_a_wall
from robobt.world.ball_model import GRAVITY
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray
from robobt.world.state import ROBOT_HEIGHT

_LAST_APEX = 0.01
"""A hop that would be lower than this is none. Source: Sumatra's model of a chip [m]."""

_STADIUM = 4
"""How many of an arena's walls surround the field; the others are the goals'."""


@compiled_lean
def _above_something(
    rows: FloatArray, first: int, robots: int, x: float, y: float, walls: FloatArray, p: FloatArray
) -> bool:
    """Return whether a robot or a goal's wall is below a ball at (x, y), in the arena's coordinates."""
    ball = rows[first + robots]
    reach = p[ROBOT_R] + p[BALL_R]
    for i in range(robots):
        dx, dy = rows[first + i, 0] - ball[0], rows[first + i, 1] - ball[1]
        if dx * dx + dy * dy < reach * reach:
            return True
    return in_a_wall(x, y, walls[_STADIUM:], p[BALL_R])


@compiled_lean
def fly(
    air: FloatArray,
    velocity: FloatArray,
    spin: FloatArray,
    rows: FloatArray,
    first: int,
    robots: int,
    walls: FloatArray,
    p: FloatArray,
    dt: float,
    move: FloatArray,
) -> bool:
    """Let a ball fly for one step.

    Args:
        air: (FLIGHT,) its height above where it lies, its speed upwards and its touch-downs, changed.
        velocity: of the ball along the ground, changed by a touch-down [m/s].
        spin: its rolling as a velocity, changed by a touch-down [m/s].
        rows: of robots and balls.
        first: where the arena's robots begin in them.
        robots: how many there are; the ball's row follows theirs.
        walls: (W, 4) of the arena, those around the field first [m].
        p: parameters of the arena.
        dt: time step [s].
        move: (2,) receives its mean velocity along the ground [m/s].

    Returns:
        whether it is above robots and goals all the time.
    """
    ball = rows[first + robots]
    before, rise = air[Z], air[RISE]
    after = before + (rise - 0.5 * GRAVITY * dt) * dt
    floor = 0.0
    if before >= ROBOT_HEIGHT > after:
        x, y = ball[0], ball[1]
        if _above_something(rows, first, robots, x, y, walls, p):
            floor = ROBOT_HEIGHT
    move[0], move[1] = velocity[0], velocity[1]
    if after > floor:
        air[Z] = after
        air[RISE] = rise - GRAVITY * dt
        return bool(before >= ROBOT_HEIGHT and after >= ROBOT_HEIGHT)
    fall = sqrt(rise * rise + 2.0 * GRAVITY * (before - floor))
    left = dt - min((rise + fall) / GRAVITY, dt)
    up = p[HOP_UP] * fall
    ends = up * up < 2.0 * GRAVITY * _LAST_APEX
    if floor == 0.0 or not ends:
        keep = p[HOP_FIRST] if air[HOPS] == 0.0 else p[HOP_OTHER]
        air[HOPS] += 1.0
        for k in range(2):
            velocity[k] *= keep
            spin[k] = velocity[k]
            move[k] += (velocity[k] - move[k]) * left / dt
    if ends:
        air[Z], air[RISE] = floor, 0.0
    else:
        air[Z] = floor + (up - 0.5 * GRAVITY * left) * left
        air[RISE] = up - GRAVITY * left
    return floor > 0.0


@compiled_lean
def pass_over(
    ball: FloatArray,
    velocity: FloatArray,
    walls: FloatArray,
    move: FloatArray,
    p: FloatArray,
    dt: float,
) -> None:
    """Move a high ball by ``move``, and back where it meets a wall around the field."""
    for k in range(2):
        limit = (walls[2, 0] if k == 0 else walls[0, 1]) - p[BALL_R]
        place = ball[k] + move[k] * dt
        if abs(place) > limit:
            place = limit if place > 0.0 else -limit
            if velocity[k] * place > 0.0:
                velocity[k] *= -p[BOUNCE_WALL]
        ball[k] = place
