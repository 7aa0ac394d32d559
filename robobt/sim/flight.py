"""A ball in the air: it falls, hops, and passes over lower objects.

The hops are those of the league's model chip_fixed_loss: at a touch-down the ball keeps a
share of its speed along the ground, a smaller one at the first than at the others, and
rises with a share of the speed with which it fell. Each step is the closed form, with the
touch-down at its exact time. Once the next hop would be lower than 1 cm the ball rolls.

pymunk's space is flat. A ball below the robots' height is treated as on the ground, with the same contacts. A
higher ball is kept out of the space, meets only the walls around the field, which have unlimited height, and
hops on a robot or goal on which it falls.
"""

from __future__ import annotations

from math import sqrt

from robobt.sim.records import Arena
from robobt.sim.sweep import in_a_wall
from robobt.world.ball_model import GRAVITY, LOWEST_HOP
from robobt.world.compiled import compiled_merged
from robobt.world.state import BALL_RADIUS, ROBOT_HEIGHT, ROBOT_RADIUS

_STADIUM = 4
"""Number of an arena's walls around the field; the others belong to the goals."""

_LEFT_WALL, _FRONT_WALL = 0, 2
"""Which of them bound y and x."""


@compiled_merged
def _above_something(arena: Arena) -> bool:
    """Return whether a robot or a goal's wall is below the ball."""
    body = arena.body
    reach = ROBOT_RADIUS + BALL_RADIUS
    for i in range(len(arena.robots)):
        dx, dy = arena.robots[i].x - body.x, arena.robots[i].y - body.y
        if dx * dx + dy * dy < reach * reach:
            return True
    return in_a_wall(body.x, body.y, arena.walls[_STADIUM:])


@compiled_merged
def fly(arena: Arena, dt: float) -> bool:
    """Let the ball fly for one step; return whether it stays above robots and goals.

    A touch-down changes its velocity along the ground and its rolling.
    """
    ball, air, settings = arena.ball, arena.air, arena.parameters.ball
    before, rise = air.z, air.vz
    after = before + (rise - 0.5 * GRAVITY * dt) * dt
    floor = ROBOT_HEIGHT if before >= ROBOT_HEIGHT > after and _above_something(arena) else 0.0
    ball.move_x, ball.move_y = ball.vx, ball.vy
    if after > floor:
        air.z = after
        air.vz = rise - GRAVITY * dt
        return bool(before >= ROBOT_HEIGHT and after >= ROBOT_HEIGHT)
    fall = sqrt(rise * rise + 2.0 * GRAVITY * (before - floor))
    left = dt - min((rise + fall) / GRAVITY, dt)
    up = settings.rebound * fall
    ends = up * up < 2.0 * GRAVITY * LOWEST_HOP
    if floor == 0.0 or not ends:
        keep = settings.first_hop if air.hops == 0.0 else settings.other_hops
        air.hops += 1.0
        ball.vx *= keep
        ball.vy *= keep
        ball.spin_x, ball.spin_y = ball.vx, ball.vy
        ball.move_x += (ball.vx - ball.move_x) * left / dt
        ball.move_y += (ball.vy - ball.move_y) * left / dt
    if ends:
        air.z, air.vz = floor, 0.0
    else:
        air.z = floor + (up - 0.5 * GRAVITY * left) * left
        air.vz = up - GRAVITY * left
    return floor > 0.0


@compiled_merged
def pass_over(arena: Arena, dt: float) -> None:
    """Move a high ball, and back where it meets a wall around the field."""
    body, ball, bounce = arena.body, arena.ball, arena.parameters.contact.wall_restitution
    body.x, ball.vx = _along(body.x, ball.vx, ball.move_x * dt, arena.walls[_FRONT_WALL].x0, bounce)
    body.y, ball.vy = _along(body.y, ball.vy, ball.move_y * dt, arena.walls[_LEFT_WALL].y0, bounce)


@compiled_merged
def _along(place: float, speed: float, way: float, wall: float, bounce: float) -> tuple[float, float]:
    """Return where a ball is along one axis, and its speed, after a ``way`` on which a wall may be."""
    limit = wall - BALL_RADIUS
    place += way
    if abs(place) > limit:
        place = limit if place > 0.0 else -limit
        if speed * place > 0.0:
            speed *= -bounce
    return place, speed
