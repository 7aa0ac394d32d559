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
from math import sqrt

import numpy as np
import pymunk
from numpy.typing import NDArray

from robobt.sim.bodies import SLOP, Box, disc_material, material_of, moment_of_inertia, outlines
from robobt.sim.contacts.touching import (
    ALLOWED,
    BACK,
    BIAS,
    ITERATIONS,
    JB,
    JN,
    JT,
    MU,
    NM,
    NX,
    NY,
    PERSISTENCE,
    PUSH,
    R1X,
    R1Y,
    R2X,
    R2Y,
    TM,
    WARM,
    find,
)
from robobt.sim.settings import SimSettings
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray

_SETTLED = 1e-12
"""After a pass over the contacts that changed no impulse by more than this there is no other [N s]."""

# Columns of the inverse masses of an arena's bodies.
_ROBOT, _ROBOT_TURN, _BALL = range(3)

# Columns of what is remembered of a pair: impulses along and across the normal, and when they last touched.
_ALONG, _ACROSS, _WHEN = range(3)

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
    count = find(rows, boxes, numbers, walls, edges, parts, contacts, who)
    if count > 0:
        _prepare(rows, numbers, inverse, memory, clock, contacts, who, speeds, count, dt)
        _solve(numbers, contacts, who, speeds, count)
        for i in range(robots + 1):
            for k in range(3):
                rows[i, 3 + k] = speeds[i, k]
                bias[i, k] = speeds[i, 3 + k]
        for j in range(count):
            seen = memory[who[j, 2]]
            seen[_ALONG], seen[_ACROSS] = contacts[j, JN], contacts[j, JT]
            seen[_WHEN] = clock


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
    undone = (1.0 - numbers[BIAS] ** dt) / dt
    for j in range(count):
        row = contacts[j]
        a, b = speeds[who[j, 0]], speeds[who[j, 1]]
        nx, ny = row[NX], row[NY]
        arm1, arm2 = row[R1X] * ny - row[R1Y] * nx, row[R2X] * ny - row[R2Y] * nx
        row[NM] = 1.0 / (a[6] + b[6] + a[7] * arm1 * arm1 + b[7] * arm2 * arm2)
        arm1, arm2 = row[R1X] * nx + row[R1Y] * ny, row[R2X] * nx + row[R2Y] * ny
        row[TM] = 1.0 / (a[6] + b[6] + a[7] * arm1 * arm1 + b[7] * arm2 * arm2)
        vx = b[0] - b[2] * row[R2Y] - a[0] + a[2] * row[R1Y]
        vy = b[1] + b[2] * row[R2X] - a[1] - a[2] * row[R1X]
        row[BACK] *= vx * nx + vy * ny
        row[PUSH] = -undone * min(row[PUSH] + numbers[ALLOWED], 0.0)
        row[JB] = row[JN] = row[JT] = row[WARM] = 0.0
        seen = memory[who[j, 2]]
        if clock - seen[_WHEN] <= numbers[PERSISTENCE]:
            row[JN], row[JT] = seen[_ALONG], seen[_ACROSS]
            row[WARM] = 1.0 if clock - seen[_WHEN] == 1.0 else 0.0
    for j in range(count):
        if contacts[j, WARM] > 0.0:
            row = contacts[j]
            _push(speeds[who[j, 0]], speeds[who[j, 1]], row, row[JN], row[JT])


@compiled_lean
def _push(a: FloatArray, b: FloatArray, row: FloatArray, along: float, across: float) -> None:
    """Apply an impulse to both bodies of a contact."""
    jx, jy = row[NX] * along - row[NY] * across, row[NY] * along + row[NX] * across
    a[0] -= jx * a[6]
    a[1] -= jy * a[6]
    a[2] -= a[7] * (row[R1X] * jy - row[R1Y] * jx)
    b[0] += jx * b[6]
    b[1] += jy * b[6]
    b[2] += b[7] * (row[R2X] * jy - row[R2Y] * jx)


@compiled_lean
def _solve(
    numbers: FloatArray, contacts: FloatArray, who: NDArray[np.int64], speeds: FloatArray, count: int
) -> None:
    """Improve the impulses, contact by contact, until they agree."""
    for _ in range(int(numbers[ITERATIONS])):
        most = 0.0
        for j in range(count):
            row = contacts[j]
            a, b = speeds[who[j, 0]], speeds[who[j, 1]]
            nx, ny = row[NX], row[NY]
            vx = b[0] - b[2] * row[R2Y] - a[0] + a[2] * row[R1Y]
            vy = b[1] + b[2] * row[R2X] - a[1] - a[2] * row[R1X]
            press = max(row[JN] - (row[BACK] + vx * nx + vy * ny) * row[NM], 0.0)
            limit = row[MU] * press
            rub = min(max(row[JT] - (vy * nx - vx * ny) * row[TM], -limit), limit)
            along, across = press - row[JN], rub - row[JT]
            row[JN], row[JT] = press, rub
            _push(a, b, row, along, across)
            most = max(most, abs(along), abs(across))
            # Overlaps are undone by velocities of their own, which last for a step.
            vx = b[3] - b[5] * row[R2Y] - a[3] + a[5] * row[R1Y]
            vy = b[4] + b[5] * row[R2X] - a[4] - a[5] * row[R1X]
            lift = max(row[JB] + (row[PUSH] - vx * nx - vy * ny) * row[NM], 0.0)
            along = lift - row[JB]
            row[JB] = lift
            if along != 0.0:
                jx, jy = nx * along, ny * along
                a[3] -= jx * a[6]
                a[4] -= jy * a[6]
                a[5] -= a[7] * (row[R1X] * jy - row[R1Y] * jx)
                b[3] += jx * b[6]
                b[4] += jy * b[6]
                b[5] += b[7] * (row[R2X] * jy - row[R2Y] * jx)
                most = max(most, abs(along))
        if most < _SETTLED:
            return
