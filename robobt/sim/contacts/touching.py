"""Which of an arena's robots, ball and walls touch, and where; see :mod:`robobt.sim.contacts.solver`."""

from __future__ import annotations

from math import cos, inf, sin, sqrt

from numpy import int64
from numpy.typing import NDArray

from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

# Columns of the numbers of the solver: passes, bias, overlap that is allowed, for how many steps a contact is
# remembered, restitution and friction of two robots, how far from the centre of the field the nearest wall
# is along either axis, and how far a hull reaches.
ITERATIONS, BIAS, ALLOWED, PERSISTENCE, BOUNCE, RUB, CLEAR_X, CLEAR_Y, REACH = range(9)

# Columns of a part of a hull: its edges, the radius of its rounded corners, restitution and friction.
FIRST, LAST, ROUNDING, PART_BOUNCE, PART_RUB = range(5)

# Columns of a contact: normal, its place seen from either body, mass along and across the normal, the
# velocities that overlap and bounce ask for, friction, the impulses so far, and whether those are of the
# last step.
# Where a contact is found, its gap and restitution stand where those velocities will.
NX, NY, R1X, R1Y, R2X, R2Y, NM, TM, PUSH, BACK, MU, JN, JT, JB, WARM = range(15)
CONTACT = 15


@compiled_lean
def find(
    rows: FloatArray,
    boxes: FloatArray,
    numbers: FloatArray,
    walls: FloatArray,
    edges: FloatArray,
    parts: FloatArray,
    contacts: FloatArray,
    who: NDArray[int64],
) -> int:
    """Fill in the contacts there are; return how many.

    Args:
        rows: (R + 1, 6) of robots and ball.
        boxes: (W, 4) walls [m].
        numbers: of :class:`~robobt.sim.contacts.solver.Contacts`, as are those that follow.
        walls: (W, 2).
        edges: (E, 4).
        parts: (P, 5).
        contacts: (pairs, CONTACT) to be filled.
        who: (pairs, 3) to be filled: the two bodies, R + 1 for the walls, and the index of their pair.
    """
    robots, count = len(rows) - 1, 0
    static = robots + 1
    discs = (robots + 1) * len(boxes)
    hulls = discs + robots * robots
    for i in range(robots + 1):
        x, y = rows[i, 0], rows[i, 1]
        radius = BALL_RADIUS if i == robots else ROBOT_RADIUS
        if abs(x) + radius < numbers[CLEAR_X] and abs(y) + radius < numbers[CLEAR_Y]:
            continue
        bounce = 1.0 if i == robots else sqrt(numbers[BOUNCE])
        rub = 1.0 if i == robots else sqrt(numbers[RUB])
        for w in range(len(boxes)):
            nx, ny, gap = _to_box(x, y, boxes[w])
            if gap <= radius:
                row = contacts[count]
                row[NX], row[NY] = nx, ny
                row[R1X], row[R1Y] = radius * nx, radius * ny
                row[R2X] = row[R2Y] = 0.0  # which moves nothing: a wall stands still
                row[BACK], row[MU], row[PUSH] = bounce * walls[w, 0], rub * walls[w, 1], gap - radius
                who[count, 0], who[count, 1], who[count, 2] = i, static, i * len(boxes) + w
                count += 1
    for i in range(robots):
        for j in range(i + 1, robots):
            x, y = rows[j, 0] - rows[i, 0], rows[j, 1] - rows[i, 1]
            square = x * x + y * y
            if square < 4.0 * ROBOT_RADIUS * ROBOT_RADIUS:
                away = sqrt(square)
                nx, ny = (x / away, y / away) if away > 0.0 else (1.0, 0.0)
                row = contacts[count]
                row[NX], row[NY] = nx, ny
                row[R1X], row[R1Y] = ROBOT_RADIUS * nx, ROBOT_RADIUS * ny
                row[R2X], row[R2Y] = -ROBOT_RADIUS * nx, -ROBOT_RADIUS * ny
                row[BACK], row[MU] = numbers[BOUNCE], numbers[RUB]
                row[PUSH] = away - 2.0 * ROBOT_RADIUS
                who[count, 0], who[count, 1], who[count, 2] = i, j, discs + i * robots + j
                count += 1
    near = numbers[REACH] + BALL_RADIUS
    for i in range(robots):
        x, y = rows[robots, 0] - rows[i, 0], rows[robots, 1] - rows[i, 1]
        if x * x + y * y > near * near:
            continue
        c, s = cos(rows[i, 2]), sin(rows[i, 2])
        ahead, aside = c * x + s * y, c * y - s * x
        for k in range(len(parts)):
            part = parts[k]
            hx, hy, gap = _to_outline(ahead, aside, edges, int(part[FIRST]), int(part[LAST]))
            gap -= part[ROUNDING]
            if gap <= BALL_RADIUS:
                nx, ny = c * hx - s * hy, s * hx + c * hy
                row = contacts[count]
                row[NX], row[NY] = nx, ny
                row[R1X], row[R1Y] = BALL_RADIUS * nx, BALL_RADIUS * ny
                row[R2X], row[R2Y] = x + gap * nx, y + gap * ny
                row[BACK], row[MU] = part[PART_BOUNCE], part[PART_RUB]
                row[PUSH] = gap - BALL_RADIUS
                who[count, 0], who[count, 1], who[count, 2] = robots, i, hulls + i * len(parts) + k
                count += 1
    return count


@compiled_lean
def _to_box(x: float, y: float, box: FloatArray) -> tuple[float, float, float]:
    """Return the direction from a point to the nearest one of a box, and how far it is.

    Inside the box that is the direction away from the nearest side, and minus the depth.
    """
    px, py = min(max(x, box[0]), box[2]) - x, min(max(y, box[1]), box[3]) - y
    if px != 0.0 or py != 0.0:
        away = sqrt(px * px + py * py)
        return px / away, py / away, away
    left, right, below, above = box[0] - x, x - box[2], box[1] - y, y - box[3]
    most = max(left, right, below, above)
    if most == left:
        return 1.0, 0.0, most
    if most == right:
        return -1.0, 0.0, most
    if most == below:
        return 0.0, 1.0, most
    return 0.0, -1.0, most


@compiled_lean
def _to_outline(x: float, y: float, edges: FloatArray, first: int, last: int) -> tuple[float, float, float]:
    """Return the same for a convex outline, which may have no more than one corner."""
    inside = last > first + 1
    best, bx, by, ex, ey = inf, 0.0, 0.0, 0.0, 0.0
    for k in range(first, last):
        edge = edges[k]
        dx, dy = edge[2] - edge[0], edge[3] - edge[1]
        px, py = x - edge[0], y - edge[1]
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
