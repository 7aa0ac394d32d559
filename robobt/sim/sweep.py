"""When a moving ball meets a robot, a wall or a goal within one physics step."""

from __future__ import annotations

from math import cos, sin, sqrt

from robobt.sim.columns import BALL_R, FACE, HALF_OPENING, JAW, ROBOT_R, SOLID
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray


@compiled_lean
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


@compiled_lean
def _meets_disc(px: float, py: float, dx: float, dy: float, reach: float) -> tuple[float, float]:
    """Return when p + t * d enters and leaves the disc of radius ``reach`` at the origin, else (2, -1)."""
    a = dx * dx + dy * dy
    b = px * dx + py * dy
    root = b * b - a * (px * px + py * py - reach * reach)
    if a <= 0.0 or root <= 0.0:
        return 2.0, -1.0
    root = sqrt(root)
    return (-b - root) / a, (-b + root) / a


@compiled_lean
def _meets_box(x: float, y: float, dx: float, dy: float, box: FloatArray, radius: float) -> float:
    """Return when in (0, 1) a moving disc first meets a box, 1 if not: the box grown by a rounded rim."""
    first = 1.0
    t_in, t_out = _enters(x, dx, box[0] - radius, box[2] + radius, -1.0, 2.0)
    t_in, t_out = _enters(y, dy, box[1] - radius, box[3] + radius, t_in, t_out)
    if not (t_in <= t_out and t_in < 1.0 and t_out > 0.0):
        return first
    for wide, high in ((radius, 0.0), (0.0, radius)):
        t_in, t_out = _enters(x, dx, box[0] - wide, box[2] + wide, -1.0, 2.0)
        t_in, t_out = _enters(y, dy, box[1] - high, box[3] + high, t_in, t_out)
        if 0.0 < t_in <= t_out and t_in < first:
            first = t_in
    for corner_x in (box[0], box[2]):
        for corner_y in (box[1], box[3]):
            t_in, t_out = _meets_disc(x - corner_x, y - corner_y, dx, dy, radius)
            if 0.0 < t_in <= t_out and t_in < first:
                first = t_in
    return first


@compiled_lean
def _meets_robot(x: float, y: float, dx: float, dy: float, p: FloatArray) -> float:
    """Return when in (0, 1) the moving ball first meets a robot, in the robot's frame, 1 if not."""
    radius, round_, face, inner = p[BALL_R], p[ROBOT_R], p[JAW], p[HALF_OPENING]
    if p[SOLID] > 0.0:
        t_in, t_out = _meets_disc(x, y, dx, dy, p[SOLID] + radius)
        return t_in if 0.0 < t_in <= t_out and t_in < 1.0 else 1.0
    half = sqrt(round_ * round_ - face * face)
    first = 1.0
    if dx < 0.0 and x > face + radius:
        t = (x - face - radius) / -dx
        if t < first and inner <= abs(y + t * dy) <= half:
            first = t
    if inner > 0.0 and dx < 0.0 and x > p[FACE] + radius:
        # Between the jaws, the ball goes on to where the mouth lies back.
        t = (x - p[FACE] - radius) / -dx
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
def sweep(
    rows: FloatArray,
    first: int,
    robots: int,
    walls: FloatArray,
    move: FloatArray,
    p: FloatArray,
    dt: float,
    met: FloatArray,
    clear_x: float,
    clear_y: float,
) -> float:
    """Return the share of the step after which a fast ball first meets a robot or a wall, 1 if none.

    ``met`` (2,) takes the velocity of what it meets [m/s]; ``clear_x`` and ``clear_y`` are how far from the
    field's centre the nearest wall is [m].

    At 6.5 m/s and 5 ms the ball moves 33 mm a step, more than its radius and
    than the goal's walls are thick: a solver that looks only at where the ball
    ends up would let it through.
    """
    ball = rows[first + robots]
    radius = p[BALL_R]
    share = 1.0
    for i in range(robots):
        row = rows[first + i]
        px, py = ball[0] - row[0], ball[1] - row[1]
        dx, dy = (move[0] - row[3]) * dt, (move[1] - row[4]) * dt
        reach = p[ROBOT_R] + radius + abs(dx) + abs(dy)
        if px * dx + py * dy >= 0.0 or px * px + py * py > reach * reach:
            continue
        c, s = cos(row[2]), sin(row[2])
        when = _meets_robot(c * px + s * py, c * py - s * px, c * dx + s * dy, c * dy - s * dx, p)
        if when < share:
            share = when
            met[0], met[1] = row[3], row[4]
    x, y = ball[0], ball[1]
    dx, dy = move[0] * dt, move[1] * dt
    if max(abs(x), abs(x + dx)) + radius < clear_x and max(abs(y), abs(y + dy)) + radius < clear_y:
        return share
    for k in range(walls.shape[0]):
        when = _meets_box(x, y, dx, dy, walls[k], radius)
        if when < share:
            share = when
            met[0] = met[1] = 0.0
    return share


@compiled_lean
def in_a_wall(x: float, y: float, walls: FloatArray, radius: float) -> bool:
    """Return whether a disc reaches into one of the boxes."""
    for k in range(walls.shape[0]):
        beside = max(walls[k, 0] - x, x - walls[k, 2], 0.0)
        above = max(walls[k, 1] - y, y - walls[k, 3], 0.0)
        if beside * beside + above * above < radius * radius:
            return True
    return False
