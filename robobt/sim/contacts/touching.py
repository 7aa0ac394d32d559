"""Which of an arena's robots, ball and walls touch, and where; see :mod:`robobt.sim.contacts.solver`."""

from __future__ import annotations

from math import cos, inf, sin, sqrt
from typing import NamedTuple

from robobt.sim.records import Body, Contact, Edge, HullPart, Records, Solver, WallBox
from robobt.world.compiled import compiled_inline, compiled_lean, compiled_merged
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


class Shapes(NamedTuple):
    """The shapes that bodies can touch, equal in all arenas."""

    walls: Records[WallBox]  # (W,) relative to an arena's centre
    edges: Records[Edge]  # (E,) of all parts of a hull
    parts: Records[HullPart]  # (P,) of a hull
    solver: Solver


@compiled_inline
def find(bodies: Records[Body], shapes: Shapes, contacts: Records[Contact]) -> int:
    """Fill in the contacts; return their number.

    Args:
        bodies: (R + 1,) robots and ball.
        shapes: what they can touch.
        contacts: (pairs,) to be filled; their bodies are R + 1 for the walls.
    """
    count = _find_walls(bodies, shapes, contacts)
    discs = len(bodies) * len(shapes.walls)
    count = _find_robots(bodies, shapes.solver, contacts, count, discs)
    robots = len(bodies) - 1
    return _find_ball(bodies, shapes, contacts, count, discs + robots * robots)


@compiled_merged
def _find_walls(bodies: Records[Body], shapes: Shapes, contacts: Records[Contact]) -> int:
    """Fill in the contacts of bodies and walls; return how many."""
    solver, walls = shapes.solver, shapes.walls
    robots, count = len(bodies) - 1, 0
    for i in range(robots + 1):
        x, y = bodies[i].x, bodies[i].y
        radius = BALL_RADIUS if i == robots else ROBOT_RADIUS
        if abs(x) + radius < solver.clear_x and abs(y) + radius < solver.clear_y:
            continue
        bounce = 1.0 if i == robots else sqrt(solver.bounce)
        friction = 1.0 if i == robots else sqrt(solver.friction)
        for w in range(len(walls)):
            wall = walls[w]
            nx, ny, gap = _to_box(x, y, wall)
            if gap <= radius:
                it = contacts[count]
                it.nx, it.ny = nx, ny
                it.r1x, it.r1y = radius * nx, radius * ny
                it.r2x = it.r2y = 0.0  # which moves nothing: a wall stands still
                it.back, it.friction = bounce * wall.bounce, friction * wall.friction
                it.push = gap - radius
                it.one, it.other, it.pair = i, robots + 1, i * len(walls) + w
                count += 1
    return count


@compiled_merged
def _find_robots(
    bodies: Records[Body], solver: Solver, contacts: Records[Contact], count: int, first: int
) -> int:
    """Fill in the contacts of robots with each other after ``count`` others; return how many there are."""
    robots = len(bodies) - 1
    for i in range(robots):
        for j in range(i + 1, robots):
            x, y = bodies[j].x - bodies[i].x, bodies[j].y - bodies[i].y
            square = x * x + y * y
            if square < 4.0 * ROBOT_RADIUS * ROBOT_RADIUS:
                away = sqrt(square)
                nx, ny = (x / away, y / away) if away > 0.0 else (1.0, 0.0)
                it = contacts[count]
                it.nx, it.ny = nx, ny
                it.r1x, it.r1y = ROBOT_RADIUS * nx, ROBOT_RADIUS * ny
                it.r2x, it.r2y = -ROBOT_RADIUS * nx, -ROBOT_RADIUS * ny
                it.back, it.friction = solver.bounce, solver.friction
                it.push = away - 2.0 * ROBOT_RADIUS
                it.one, it.other, it.pair = i, j, first + i * robots + j
                count += 1
    return count


@compiled_merged
def _find_ball(
    bodies: Records[Body], shapes: Shapes, contacts: Records[Contact], count: int, first: int
) -> int:
    """Fill in the contacts of the ball and hulls after ``count`` others; return how many there are."""
    parts, robots = shapes.parts, len(bodies) - 1
    near = shapes.solver.reach + BALL_RADIUS
    ball = bodies[robots]
    for i in range(robots):
        robot = bodies[i]
        x, y = ball.x - robot.x, ball.y - robot.y
        if x * x + y * y > near * near:
            continue
        c, s = cos(robot.heading), sin(robot.heading)
        ahead, aside = c * x + s * y, c * y - s * x
        for k in range(len(parts)):
            part = parts[k]
            hx, hy, gap = _to_outline(ahead, aside, shapes.edges, part)
            gap -= part.rounding
            if gap <= BALL_RADIUS:
                nx, ny = c * hx - s * hy, s * hx + c * hy
                it = contacts[count]
                it.nx, it.ny = nx, ny
                it.r1x, it.r1y = BALL_RADIUS * nx, BALL_RADIUS * ny
                it.r2x, it.r2y = x + gap * nx, y + gap * ny
                it.back, it.friction = part.bounce, part.friction
                it.push = gap - BALL_RADIUS
                it.one, it.other, it.pair = robots, i, first + i * len(parts) + k
                count += 1
    return count


@compiled_lean
def _to_box(x: float, y: float, box: WallBox) -> tuple[float, float, float]:
    """Return the direction from a point to the nearest one of a box, and how far it is.

    Inside the box that is the direction away from the nearest side, and minus the depth.
    """
    px, py = min(max(x, box.x0), box.x1) - x, min(max(y, box.y0), box.y1) - y
    if px != 0.0 or py != 0.0:
        away = sqrt(px * px + py * py)
        return px / away, py / away, away
    left, right, below, above = box.x0 - x, x - box.x1, box.y0 - y, y - box.y1
    most = max(left, right, below, above)
    if most == left:
        return 1.0, 0.0, most
    if most == right:
        return -1.0, 0.0, most
    if most == below:
        return 0.0, 1.0, most
    return 0.0, -1.0, most


@compiled_merged
def _to_outline(x: float, y: float, edges: Records[Edge], part: HullPart) -> tuple[float, float, float]:
    """Return direction and distance for a convex outline, which may have only one corner."""
    first, last = int(part.first), int(part.last)
    inside = last > first + 1
    best, bx, by, ex, ey = inf, 0.0, 0.0, 0.0, 0.0
    for k in range(first, last):
        edge = edges[k]
        dx, dy = edge.x1 - edge.x0, edge.y1 - edge.y0
        px, py = x - edge.x0, y - edge.y0
        length = dx * dx + dy * dy
        share = min(max((px * dx + py * dy) / length, 0.0), 1.0) if length > 0.0 else 0.0
        qx, qy = share * dx - px, share * dy - py
        square = qx * qx + qy * qy
        if dx * py - dy * px < 0.0:
            inside = False
        if square < best:
            best, bx, by, ex, ey = square, qx, qy, dx, dy
    away = sqrt(best)
    if away < 1e-12:
        length = sqrt(ex * ex + ey * ey)
        return (-ey / length, ex / length, 0.0) if length > 0.0 else (1.0, 0.0, 0.0)
    if inside:
        return -bx / away, -by / away, -away
    return bx / away, by / away, away
