"""When a moving ball meets a robot, a wall or a goal within one physics step."""

from __future__ import annotations

from math import cos, sin, sqrt

from robobt.sim.records import Arena, Parameters, Records, Solver, WallBox
from robobt.world.compiled import compiled_lean, compiled_merged
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


@compiled_merged
def _enters(
    start: float, step: float, low: float, high: float, t_in: float, t_out: float
) -> tuple[float, float]:
    """Clip the time interval in which start + t * step lies in [low, high]."""
    if step == 0.0:
        if start < low or start > high:
            return 2.0, -1.0
        return t_in, t_out
    first, second = (low - start) / step, (high - start) / step
    if first > second:
        first, second = second, first
    return max(t_in, first), min(t_out, second)


@compiled_merged
def _meets_disc(px: float, py: float, dx: float, dy: float, reach: float) -> tuple[float, float]:
    """Return when p + t * d enters and leaves the disc of radius ``reach`` at the origin, else (2, -1)."""
    a = dx * dx + dy * dy
    b = px * dx + py * dy
    root = b * b - a * (px * px + py * py - reach * reach)
    if a <= 0.0 or root <= 0.0:
        return 2.0, -1.0
    root = sqrt(root)
    return (-b - root) / a, (-b + root) / a


@compiled_merged
def _meets_box(x: float, y: float, dx: float, dy: float, box: WallBox, radius: float) -> float:
    """Return when in (0, 1) a moving disc first meets a box, 1 if not: the box grown by a rounded rim."""
    first = 1.0
    t_in, t_out = _enters(x, dx, box.x0 - radius, box.x1 + radius, -1.0, 2.0)
    t_in, t_out = _enters(y, dy, box.y0 - radius, box.y1 + radius, t_in, t_out)
    if not (t_in <= t_out and t_in < 1.0 and t_out > 0.0):
        return first
    for wide, high in ((radius, 0.0), (0.0, radius)):
        t_in, t_out = _enters(x, dx, box.x0 - wide, box.x1 + wide, -1.0, 2.0)
        t_in, t_out = _enters(y, dy, box.y0 - high, box.y1 + high, t_in, t_out)
        if 0.0 < t_in <= t_out and t_in < first:
            first = t_in
    for corner_x in (box.x0, box.x1):
        for corner_y in (box.y0, box.y1):
            t_in, t_out = _meets_disc(x - corner_x, y - corner_y, dx, dy, radius)
            if 0.0 < t_in <= t_out and t_in < first:
                first = t_in
    return first


@compiled_merged
def _meets_robot(x: float, y: float, dx: float, dy: float, p: Parameters) -> float:
    """Return when in (0, 1) the moving ball first meets a robot, in the robot's frame, 1 if not."""
    radius, round_, face, inner = BALL_RADIUS, ROBOT_RADIUS, p.front, p.half_opening
    if p.solid > 0.0:
        t_in, t_out = _meets_disc(x, y, dx, dy, p.solid + radius)
        return t_in if 0.0 < t_in <= t_out and t_in < 1.0 else 1.0
    half = sqrt(round_ * round_ - face * face)
    first = 1.0
    if dx < 0.0 and x > face + radius:
        t = (x - face - radius) / -dx
        if t < first and inner <= abs(y + t * dy) <= half:
            first = t
    if inner > 0.0 and dx < 0.0 and x > p.body.face + radius:
        # Between the jaws, the ball goes on to where the mouth lies back.
        t = (x - p.body.face - radius) / -dx
        if t < first and abs(y + t * dy) <= inner:
            first = t
    t_in, t_out = _meets_disc(x, y, dx, dy, round_ + radius)
    # The disc counts only where it is not cut off.
    if 0.0 < t_in <= t_out and t_in < first and x + t_in * dx <= face * (round_ + radius) / round_:
        first = t_in
    for edge in (half, inner):
        for corner in (edge, -edge):
            t_in, t_out = _meets_disc(x - face, y - corner, dx, dy, radius)
            if edge > 0.0 and 0.0 < t_in <= t_out and t_in < first:
                first = t_in
    return first


@compiled_lean
def sweep(arena: Arena, solver: Solver, dt: float) -> tuple[float, float, float]:
    """Return after which share of the step a fast ball meets a robot or a wall, and how fast that moves.

    The share is 1 if it meets none. At 6.5 m/s and 5 ms the ball moves 33 mm a step, more than its radius and
    than the goal's walls are thick: a solver that looks only at where the ball
    ends up would let it through.
    """
    body, ball = arena.body, arena.ball
    share, met_x, met_y = 1.0, 0.0, 0.0
    for i in range(len(arena.robots)):
        robot = arena.robots[i]
        px, py = body.x - robot.x, body.y - robot.y
        dx, dy = (ball.move_x - robot.vx) * dt, (ball.move_y - robot.vy) * dt
        reach = ROBOT_RADIUS + BALL_RADIUS + abs(dx) + abs(dy)
        if px * dx + py * dy >= 0.0 or px * px + py * py > reach * reach:
            continue
        c, s = cos(robot.heading), sin(robot.heading)
        when = _meets_robot(
            c * px + s * py, c * py - s * px, c * dx + s * dy, c * dy - s * dx, arena.parameters
        )
        if when < share:
            share, met_x, met_y = when, robot.vx, robot.vy
    x, y = body.x, body.y
    dx, dy = ball.move_x * dt, ball.move_y * dt
    far_x, far_y = max(abs(x), abs(x + dx)) + BALL_RADIUS, max(abs(y), abs(y + dy)) + BALL_RADIUS
    if far_x < solver.clear_x and far_y < solver.clear_y:
        return share, met_x, met_y
    for k in range(len(arena.walls)):
        when = _meets_box(x, y, dx, dy, arena.walls[k], BALL_RADIUS)
        if when < share:
            share, met_x, met_y = when, 0.0, 0.0
    return share, met_x, met_y


@compiled_merged
def in_a_wall(x: float, y: float, walls: Records[WallBox]) -> bool:
    """Return whether a ball reaches into one of the boxes."""
    for k in range(len(walls)):
        wall = walls[k]
        beside = max(wall.x0 - x, x - wall.x1, 0.0)
        above = max(wall.y0 - y, y - wall.y1, 0.0)
        if beside * beside + above * above < BALL_RADIUS * BALL_RADIUS:
            return True
    return False
