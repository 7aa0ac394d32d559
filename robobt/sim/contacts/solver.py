"""Contacts of robots, ball and walls, compiled over arrays: for arenas by the hundred.

An arena has few bodies, and all of them are round to what they meet but a robot's hull, which meets only
the ball. So every contact has one point, and finding it takes a distance. What follows is a step of
Chipmunk, the solver of pymunk's spaces: positions first, then contacts, then sequential impulses that begin
with those of the last step, and overlaps undone by velocities of their own. The same bodies, materials and
settings give the same motion to the last digits (a test compares the two) without trees, pools and
pointers, so that what a thousand arenas keep fits into a processor's cache. Contacts are solved in a fixed
order, where Chipmunk's follows from its trees: the two part where several bodies touch at once.

Source: what Chipmunk's ``cpSpaceStep`` and ``cpArbiter`` do, with pymunk's default settings.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, inf, sin, sqrt

import numpy as np
import pymunk
from numpy.typing import NDArray

from robobt.sim.bodies import SLOP, Box, disc_material, material_of, moment_of_inertia, outlines
from robobt.sim.settings import SimSettings
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_SETTLED = 1e-12
"""After a pass over the contacts that changed no impulse by more than this there is no other [N s]."""

# Columns of the numbers of the solver, and of what all robots are as discs.
_ITERATIONS, _BIAS, _SLOP, _PERSISTENCE, _BOUNCE, _RUB, CLEAR_X, CLEAR_Y, _REACH = range(9)

# Columns of a part of a hull: its edges, the radius of its rounded corners, restitution and friction.
_FIRST, _LAST, _ROUNDING, _PART_BOUNCE, _PART_RUB = range(5)

# Columns of the inverse masses of an arena's bodies.
_ROBOT, _ROBOT_TURN, _BALL = range(3)

# Columns of what is remembered of a pair: impulses along and across the normal, and when they last touched.
_ALONG, _ACROSS, _WHEN = range(3)

# Columns of a contact: normal, its place seen from either body, mass along and across the normal, the
# velocities that overlap and bounce ask for, friction, the impulses so far, and whether those are of the
# last step.
# Where a contact is found, its gap and restitution stand where those velocities will.
_NX, _NY, _R1X, _R1Y, _R2X, _R2Y, _NM, _TM, _PUSH, _BACK, _MU, _JN, _JT, _JB, _WARM = range(15)
CONTACT = 15

_LONG_AGO = -1e9


class Contacts:
    """What the solver knows of ``n`` arenas with ``robots`` each.

    Attributes:
        numbers: of the solver and the discs.
        walls: (W, 2) restitution and friction of the boxes.
        edges: (E, 4) from and to x and y, of all parts of a hull, in the robot's frame [m].
        parts: (P, 5) of a hull.
        inverse: (n, 3) inverse masses and moments of inertia of robots and ball.
        bias: (n, R + 1, 3) velocities that undo overlaps in the next step [m/s, rad/s].
        memory: (n, pairs, 3) what is remembered of each two bodies, or parts of them, that may touch.
        clock: (n,) steps so far.
    """

    def __init__(self, settings: SimSettings, robots: int, walls: Sequence[tuple[Box, str]], n: int) -> None:
        materials = material_of(settings.contact)
        self.walls = np.array([materials[kind] for _, kind in walls])
        hull = outlines(settings)
        edges: list[tuple[float, float, float, float]] = []
        parts = []
        for part in hull:
            ends = [*part.corners[1:], part.corners[0]]
            begin = len(edges)
            edges += [(*a, *b) for a, b in zip(part.corners, ends, strict=True)]
            parts.append((begin, len(edges), part.rounding, *part.material))
        self.edges = np.array(edges)
        self.parts = np.array(parts, dtype=np.float64)
        reach = max(sqrt(x * x + y * y) + part.rounding for part in hull for x, y in part.corners)
        space = pymunk.Space()
        # No wall is nearer to the centre of the field than this, along either axis.
        beside = min(abs(y) for (x0, y0, x1, y1), _ in walls if x0 < 0.0 < x1 for y in (y0, y1))
        ahead = min(abs(x) for (x0, _, x1, _), _ in walls if not x0 < 0.0 < x1 for x in (x0, x1))
        self.numbers = np.array(
            [
                space.iterations,
                space.collision_bias,
                SLOP,
                space.collision_persistence,
                *disc_material(settings.contact),
                ahead,
                beside,
                reach,
            ]
        )
        mass = settings.body.mass
        row = 1.0 / mass, 1.0 / moment_of_inertia(mass), 1.0 / settings.ball.mass
        self.inverse = np.tile(np.array(row), (n, 1))
        self.bias = np.zeros((n, robots + 1, 3))
        pairs = (robots + 1) * len(walls) + robots * (robots + len(hull))
        self.memory = np.zeros((n, pairs, 3))
        self.memory[..., _WHEN] = _LONG_AGO
        self.clock: NDArray[np.int64] = np.zeros(n, dtype=np.int64)

    def forget(self, arenas: NDArray[np.int64] | int) -> None:
        """Forget what touched in these arenas: bodies have been put elsewhere."""
        self.bias[arenas] = 0.0
        self.memory[arenas, :, _WHEN] = _LONG_AGO

    def weigh(self, arena: int, mass: float) -> None:
        """Give the robots of one arena another mass [kg]."""
        self.inverse[arena, :_BALL] = 1.0 / mass, 1.0 / moment_of_inertia(mass)


@compiled_lean
def collide(
    rows: FloatArray,
    boxes: FloatArray,
    numbers: FloatArray,
    walls: FloatArray,
    edges: FloatArray,
    parts: FloatArray,
    inverse: FloatArray,
    bias: FloatArray,
    memory: FloatArray,
    clock: int,
    contacts: FloatArray,
    who: NDArray[np.int64],
    speeds: FloatArray,
    dt: float,
) -> None:
    """Move an arena's bodies for one step and let them push each other off.

    Args:
        rows: (R + 1, 6) of robots and ball, changed.
        boxes: (W, 4) walls [m].
        numbers: of :class:`Contacts`, as are those that follow, of the arena.
        walls: (W, 2).
        edges: (E, 4).
        parts: (P, 5).
        inverse: (3,).
        bias: (R + 1, 3), changed.
        memory: (pairs, 3), changed.
        clock: which step of the arena's it is.
        contacts: (pairs, CONTACT) scratch.
        who: (pairs, 3) scratch.
        speeds: (R + 2, 8) scratch.
        dt: time step [s].
    """
    robots = len(rows) - 1
    for i in range(robots + 1):
        for k in range(3):
            rows[i, k] += (rows[i, 3 + k] + bias[i, k]) * dt
            bias[i, k] = 0.0
    if not _near(rows, numbers):
        return
    count = _find(rows, boxes, numbers, walls, edges, parts, contacts, who)
    if count > 0:
        _prepare(rows, numbers, inverse, memory, clock, contacts, who, speeds, count, dt)
        _solve(numbers, contacts, who, speeds, count)
        for i in range(robots + 1):
            for k in range(3):
                rows[i, 3 + k] = speeds[i, k]
                bias[i, k] = speeds[i, 3 + k]
        for j in range(count):
            seen = memory[who[j, 2]]
            seen[_ALONG], seen[_ACROSS] = contacts[j, _JN], contacts[j, _JT]
            seen[_WHEN] = clock


@compiled_lean
def _near(rows: FloatArray, numbers: FloatArray) -> bool:
    """Return whether anything may touch anything, which is quick to see where nothing does."""
    robots = len(rows) - 1
    clear_x, clear_y = numbers[CLEAR_X] - ROBOT_RADIUS, numbers[CLEAR_Y] - ROBOT_RADIUS
    reach, discs = numbers[_REACH] + BALL_RADIUS, 4.0 * ROBOT_RADIUS * ROBOT_RADIUS
    for i in range(robots):
        x, y = rows[i, 0], rows[i, 1]
        ball_x, ball_y = rows[robots, 0] - x, rows[robots, 1] - y
        if abs(x) >= clear_x or abs(y) >= clear_y or ball_x * ball_x + ball_y * ball_y <= reach * reach:
            return True
        for j in range(i):
            dx, dy = rows[j, 0] - x, rows[j, 1] - y
            if dx * dx + dy * dy < discs:
                return True
    return bool(
        abs(rows[robots, 0]) + BALL_RADIUS >= numbers[CLEAR_X]
        or abs(rows[robots, 1]) + BALL_RADIUS >= numbers[CLEAR_Y]
    )


@compiled_lean
def _find(
    rows: FloatArray,
    boxes: FloatArray,
    numbers: FloatArray,
    walls: FloatArray,
    edges: FloatArray,
    parts: FloatArray,
    contacts: FloatArray,
    who: NDArray[np.int64],
) -> int:
    """Fill in the contacts there are; return how many."""
    robots, count = len(rows) - 1, 0
    static = robots + 1
    discs = (robots + 1) * len(boxes)
    hulls = discs + robots * robots
    for i in range(robots + 1):
        x, y = rows[i, 0], rows[i, 1]
        radius = BALL_RADIUS if i == robots else ROBOT_RADIUS
        if abs(x) + radius < numbers[CLEAR_X] and abs(y) + radius < numbers[CLEAR_Y]:
            continue
        bounce = 1.0 if i == robots else sqrt(numbers[_BOUNCE])
        rub = 1.0 if i == robots else sqrt(numbers[_RUB])
        for w in range(len(boxes)):
            nx, ny, gap = _to_box(x, y, boxes[w])
            if gap <= radius:
                row = contacts[count]
                row[_NX], row[_NY] = nx, ny
                row[_R1X], row[_R1Y] = radius * nx, radius * ny
                row[_R2X] = row[_R2Y] = 0.0  # which moves nothing: a wall stands still
                row[_BACK], row[_MU], row[_PUSH] = bounce * walls[w, 0], rub * walls[w, 1], gap - radius
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
                row[_NX], row[_NY] = nx, ny
                row[_R1X], row[_R1Y] = ROBOT_RADIUS * nx, ROBOT_RADIUS * ny
                row[_R2X], row[_R2Y] = -ROBOT_RADIUS * nx, -ROBOT_RADIUS * ny
                row[_BACK], row[_MU] = numbers[_BOUNCE], numbers[_RUB]
                row[_PUSH] = away - 2.0 * ROBOT_RADIUS
                who[count, 0], who[count, 1], who[count, 2] = i, j, discs + i * robots + j
                count += 1
    near = numbers[_REACH] + BALL_RADIUS
    for i in range(robots):
        x, y = rows[robots, 0] - rows[i, 0], rows[robots, 1] - rows[i, 1]
        if x * x + y * y > near * near:
            continue
        c, s = cos(rows[i, 2]), sin(rows[i, 2])
        ahead, aside = c * x + s * y, c * y - s * x
        for k in range(len(parts)):
            part = parts[k]
            hx, hy, gap = _to_outline(ahead, aside, edges, int(part[_FIRST]), int(part[_LAST]))
            gap -= part[_ROUNDING]
            if gap <= BALL_RADIUS:
                nx, ny = c * hx - s * hy, s * hx + c * hy
                row = contacts[count]
                row[_NX], row[_NY] = nx, ny
                row[_R1X], row[_R1Y] = BALL_RADIUS * nx, BALL_RADIUS * ny
                row[_R2X], row[_R2Y] = x + gap * nx, y + gap * ny
                row[_BACK], row[_MU] = part[_PART_BOUNCE], part[_PART_RUB]
                row[_PUSH] = gap - BALL_RADIUS
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


@compiled_lean
def _prepare(
    rows: FloatArray,
    numbers: FloatArray,
    inverse: FloatArray,
    memory: FloatArray,
    clock: int,
    contacts: FloatArray,
    who: NDArray[np.int64],
    speeds: FloatArray,
    count: int,
    dt: float,
) -> None:
    """Compute what the contacts ask for, and apply again the impulses of the last step."""
    robots = len(rows) - 1
    for i in range(robots + 2):
        for k in range(3):
            speeds[i, k] = rows[i, 3 + k] if i <= robots else 0.0
            speeds[i, 3 + k] = 0.0
        speeds[i, 6] = inverse[_BALL] if i == robots else inverse[_ROBOT] if i < robots else 0.0
        speeds[i, 7] = inverse[_ROBOT_TURN] if i < robots else 0.0
    undone = (1.0 - numbers[_BIAS] ** dt) / dt
    for j in range(count):
        row = contacts[j]
        a, b = speeds[who[j, 0]], speeds[who[j, 1]]
        nx, ny = row[_NX], row[_NY]
        arm1, arm2 = row[_R1X] * ny - row[_R1Y] * nx, row[_R2X] * ny - row[_R2Y] * nx
        row[_NM] = 1.0 / (a[6] + b[6] + a[7] * arm1 * arm1 + b[7] * arm2 * arm2)
        arm1, arm2 = row[_R1X] * nx + row[_R1Y] * ny, row[_R2X] * nx + row[_R2Y] * ny
        row[_TM] = 1.0 / (a[6] + b[6] + a[7] * arm1 * arm1 + b[7] * arm2 * arm2)
        vx = b[0] - b[2] * row[_R2Y] - a[0] + a[2] * row[_R1Y]
        vy = b[1] + b[2] * row[_R2X] - a[1] - a[2] * row[_R1X]
        row[_BACK] *= vx * nx + vy * ny
        row[_PUSH] = -undone * min(row[_PUSH] + numbers[_SLOP], 0.0)
        row[_JB] = row[_JN] = row[_JT] = row[_WARM] = 0.0
        seen = memory[who[j, 2]]
        if clock - seen[_WHEN] <= numbers[_PERSISTENCE]:
            row[_JN], row[_JT] = seen[_ALONG], seen[_ACROSS]
            row[_WARM] = 1.0 if clock - seen[_WHEN] == 1.0 else 0.0
    for j in range(count):
        if contacts[j, _WARM] > 0.0:
            row = contacts[j]
            _push(speeds[who[j, 0]], speeds[who[j, 1]], row, row[_JN], row[_JT])


@compiled_lean
def _push(a: FloatArray, b: FloatArray, row: FloatArray, along: float, across: float) -> None:
    """Apply an impulse to both bodies of a contact."""
    jx, jy = row[_NX] * along - row[_NY] * across, row[_NY] * along + row[_NX] * across
    a[0] -= jx * a[6]
    a[1] -= jy * a[6]
    a[2] -= a[7] * (row[_R1X] * jy - row[_R1Y] * jx)
    b[0] += jx * b[6]
    b[1] += jy * b[6]
    b[2] += b[7] * (row[_R2X] * jy - row[_R2Y] * jx)


@compiled_lean
def _solve(
    numbers: FloatArray, contacts: FloatArray, who: NDArray[np.int64], speeds: FloatArray, count: int
) -> None:
    """Improve the impulses, contact by contact, until they agree."""
    for _ in range(int(numbers[_ITERATIONS])):
        most = 0.0
        for j in range(count):
            row = contacts[j]
            a, b = speeds[who[j, 0]], speeds[who[j, 1]]
            nx, ny = row[_NX], row[_NY]
            vx = b[0] - b[2] * row[_R2Y] - a[0] + a[2] * row[_R1Y]
            vy = b[1] + b[2] * row[_R2X] - a[1] - a[2] * row[_R1X]
            press = max(row[_JN] - (row[_BACK] + vx * nx + vy * ny) * row[_NM], 0.0)
            limit = row[_MU] * press
            rub = min(max(row[_JT] - (vy * nx - vx * ny) * row[_TM], -limit), limit)
            along, across = press - row[_JN], rub - row[_JT]
            row[_JN], row[_JT] = press, rub
            _push(a, b, row, along, across)
            most = max(most, abs(along), abs(across))
            # Overlaps are undone by velocities of their own, which last for a step.
            vx = b[3] - b[5] * row[_R2Y] - a[3] + a[5] * row[_R1Y]
            vy = b[4] + b[5] * row[_R2X] - a[4] - a[5] * row[_R1X]
            lift = max(row[_JB] + (row[_PUSH] - vx * nx - vy * ny) * row[_NM], 0.0)
            along = lift - row[_JB]
            row[_JB] = lift
            if along != 0.0:
                jx, jy = nx * along, ny * along
                a[3] -= jx * a[6]
                a[4] -= jy * a[6]
                a[5] -= a[7] * (row[_R1X] * jy - row[_R1Y] * jx)
                b[3] += jx * b[6]
                b[4] += jy * b[6]
                b[5] += b[7] * (row[_R2X] * jy - row[_R2Y] * jx)
                most = max(most, abs(along))
        if most < _SETTLED:
            return
