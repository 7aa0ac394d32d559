"""Contacts of robots, ball and walls, compiled over arrays, for hundreds of arenas.

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
from typing import NamedTuple

import numpy as np
import pymunk

from robobt.sim.bodies import SLOP, Box, disc_material, material_of, moment_of_inertia, outlines
from robobt.sim.contacts.touching import Shapes, find
from robobt.sim.records import (
    BIAS,
    CONTACT,
    CONTACT_MEMORY,
    HALFWAY,
    MASSES,
    MOVING,
    SOLVER,
    Bias,
    Body,
    Contact,
    ContactMemory,
    Halfway,
    IntArray,
    Masses,
    Moving,
    Records,
    Solver,
    filled,
    size,
)
from robobt.sim.settings import SimSettings
from robobt.world.compiled import compiled_inline, compiled_merged
from robobt.world.geometry import FloatArray

_SETTLED_IMPULSE = 1e-12
"""The passes end when no impulse changes by more than this [N s]."""

_LONG_AGO = -1e9

_TOGETHER = 4
"""Arenas whose contacts are solved together; with 2 or 8 it takes as long."""


class ContactArrays(NamedTuple):
    """The solver's arrays for ``n`` arenas with R robots each."""

    walls: FloatArray  # (W, size(WALL))
    edges: FloatArray  # (E, size(EDGE)) of all parts of a hull
    parts: FloatArray  # (P, size(PART)) of a hull
    solver: FloatArray  # (1, size(SOLVER))
    masses: FloatArray  # (n, size(MASSES))
    bias: FloatArray  # (n, R + 1, size(BIAS)) of bodies, for the next step
    memory: FloatArray  # (n, pairs, size(MEMORY)) of pairs that may touch
    # Of the arenas that are solved together, scratch:
    contacts: FloatArray  # (together, pairs, size(CONTACT))
    moving: FloatArray  # (together, R + 2, size(MOVING))
    halfway: FloatArray  # (together, size(HALFWAY))

    def forget(self, arenas: IntArray | int | slice) -> None:
        """Forget the contacts in these arenas, because bodies have been placed elsewhere."""
        self.bias[arenas] = 0.0
        self.memory.view(CONTACT_MEMORY)["when"][arenas] = _LONG_AGO

    def weigh(self, arenas: int | slice, mass: float) -> None:
        """Give the robots of arenas another mass [kg]."""
        masses = self.masses.view(MASSES)
        masses["robot"][arenas] = 1.0 / mass
        masses["robot_turn"][arenas] = 1.0 / moment_of_inertia(mass)


def contact_arrays(
    settings: SimSettings, robots: int, walls: Sequence[tuple[Box, str]], n: int
) -> ContactArrays:
    """Return the solver's arrays for ``n`` arenas with this many ``robots``, without contacts."""
    materials = material_of(settings.contact)
    hull = outlines(settings)
    edges: list[tuple[float, float, float, float]] = []
    parts = []
    for part in hull:
        ends = [*part.corners[1:], part.corners[0]]
        begin = len(edges)
        edges += [(*a, *b) for a, b in zip(part.corners, ends, strict=True)]
        parts.append((begin, len(edges), part.rounding, *part.material))
    space = pymunk.Space()
    bounce, friction = disc_material(settings.contact)
    solver = filled(
        SOLVER,
        space,
        bias=space.collision_bias,
        allowed=SLOP,
        persistence=space.collision_persistence,
        bounce=bounce,
        friction=friction,
        # No wall is nearer to the centre of the field than this, along either axis.
        clear_x=min(abs(x) for (x0, _, x1, _), _ in walls if not x0 < 0.0 < x1 for x in (x0, x1)),
        clear_y=min(abs(y) for (x0, y0, x1, y1), _ in walls if x0 < 0.0 < x1 for y in (y0, y1)),
        reach=max(sqrt(x * x + y * y) + part.rounding for part in hull for x, y in part.corners),
    )
    pairs = (robots + 1) * len(walls) + robots * (robots + len(hull))
    made = ContactArrays(
        walls=np.array([(*box, *materials[kind]) for box, kind in walls]),
        edges=np.array(edges),
        parts=np.array(parts, dtype=np.float64),
        solver=solver.reshape(1).view(np.float64).reshape(1, -1),
        masses=np.zeros((n, size(MASSES))),
        bias=np.zeros((n, robots + 1, size(BIAS))),
        memory=np.zeros((n, pairs, size(CONTACT_MEMORY))),
        contacts=np.zeros((min(n, _TOGETHER), pairs, size(CONTACT))),
        moving=np.zeros((min(n, _TOGETHER), robots + 2, size(MOVING))),
        halfway=np.zeros((min(n, _TOGETHER), size(HALFWAY))),
    )
    made.masses.view(MASSES)["ball"] = 1.0 / settings.ball.mass
    made.weigh(slice(None), settings.body.mass)
    made.forget(slice(None))
    return made


class Solving(NamedTuple):
    """The solver's view of one arena."""

    masses: Masses
    bias: Records[Bias]  # (R + 1,)
    memory: Records[ContactMemory]  # (pairs,)
    contacts: Records[Contact]  # (pairs,) scratch
    moving: Records[Moving]  # (R + 2,) scratch


@compiled_inline
def begin_contacts(bodies: Records[Body], shapes: Shapes, it: Solving, dt: float) -> int:
    """Move an arena's bodies for one step and prepare their contacts; return how many there are.

    Args:
        bodies: (R + 1,) robots and ball, changed.
        shapes: what they can touch.
        it: what belongs to the arena.
        dt: time step [s].
    """
    it.masses.clock += 1
    for i in range(len(bodies)):
        body, bias = bodies[i], it.bias[i]
        body.x += (body.vx + bias.vx) * dt
        body.y += (body.vy + bias.vy) * dt
        body.heading += (body.omega + bias.omega) * dt
        bias.vx = bias.vy = bias.omega = 0.0
    count = find(bodies, shapes, it.contacts)
    if count > 0:
        _prepare(bodies, shapes.solver, it, count, dt)
    return count


@compiled_inline
def end_contacts(bodies: Records[Body], it: Solving, count: int) -> None:
    """Let an arena's bodies have the velocities of its solved contacts, and remember their impulses."""
    if count == 0:
        return
    for i in range(len(bodies)):
        body, bias, moving = bodies[i], it.bias[i], it.moving[i]
        body.vx, body.vy, body.omega = moving.vx, moving.vy, moving.omega
        bias.vx, bias.vy, bias.omega = moving.bias_vx, moving.bias_vy, moving.bias_omega
    for j in range(count):
        contact = it.contacts[j]
        seen = it.memory[contact.pair]
        seen.along, seen.across = contact.normal, contact.tangent
        seen.when = it.masses.clock


@compiled_merged
def _prepare(bodies: Records[Body], solver: Solver, it: Solving, count: int, dt: float) -> None:
    """Prepare the contacts, and apply the impulses of the last step again."""
    robots, clock = len(bodies) - 1, it.masses.clock
    for i in range(robots + 2):
        moving = it.moving[i]
        moving.vx = moving.vy = moving.omega = 0.0
        if i <= robots:
            moving.vx, moving.vy, moving.omega = bodies[i].vx, bodies[i].vy, bodies[i].omega
        moving.bias_vx = moving.bias_vy = moving.bias_omega = 0.0
        moving.mass = it.masses.ball if i == robots else it.masses.robot if i < robots else 0.0
        moving.inertia = it.masses.robot_turn if i < robots else 0.0
    undone = (1.0 - solver.bias**dt) / dt
    for j in range(count):
        row = it.contacts[j]
        a, b = it.moving[row.one], it.moving[row.other]
        nx, ny = row.nx, row.ny
        arm1, arm2 = row.r1x * ny - row.r1y * nx, row.r2x * ny - row.r2y * nx
        row.normal_mass = 1.0 / (a.mass + b.mass + a.inertia * arm1 * arm1 + b.inertia * arm2 * arm2)
        arm1, arm2 = row.r1x * nx + row.r1y * ny, row.r2x * nx + row.r2y * ny
        row.tangent_mass = 1.0 / (a.mass + b.mass + a.inertia * arm1 * arm1 + b.inertia * arm2 * arm2)
        vx = b.vx - b.omega * row.r2y - a.vx + a.omega * row.r1y
        vy = b.vy + b.omega * row.r2x - a.vy - a.omega * row.r1x
        row.back *= vx * nx + vy * ny
        row.push = -undone * min(row.push + solver.allowed, 0.0)
        row.lift = row.normal = row.tangent = row.warm = 0.0
        seen = it.memory[row.pair]
        if clock - seen.when <= solver.persistence:
            row.normal, row.tangent = seen.along, seen.across
            row.warm = 1.0 if clock - seen.when == 1.0 else 0.0
    for j in range(count):
        row = it.contacts[j]
        if row.warm > 0.0:
            _push(it.moving[row.one], it.moving[row.other], row, row.normal, row.tangent)


@compiled_merged
def _push(a: Moving, b: Moving, row: Contact, along: float, across: float) -> None:
    """Apply an impulse to both bodies of a contact."""
    jx, jy = row.nx * along - row.ny * across, row.ny * along + row.nx * across
    a.vx -= jx * a.mass
    a.vy -= jy * a.mass
    a.omega -= a.inertia * (row.r1x * jy - row.r1y * jx)
    b.vx += jx * b.mass
    b.vy += jy * b.mass
    b.omega += b.inertia * (row.r2x * jy - row.r2y * jx)


@compiled_inline
def solve(
    solver: Solver,
    contacts: Records[Records[Contact]],
    moving: Records[Records[Moving]],
    halfway: Records[Halfway],
) -> None:
    """Improve the impulses of several arenas, contact by contact, until they agree.

    A contact waits for the one before it, but not for those of other arenas: the processor works at several.

    Args:
        solver: its numbers.
        contacts: (arenas, pairs) of each arena.
        moving: (arenas, R + 2) its bodies.
        halfway: (arenas,) how many contacts it has.
    """
    most_contacts = 0
    for g in range(len(halfway)):
        halfway[g].unsettled = halfway[g].contacts
        most_contacts = max(most_contacts, halfway[g].contacts)
    for _ in range(int(solver.iterations)):
        if most_contacts == 0:
            return
        for g in range(len(halfway)):
            halfway[g].most = 0.0
        for j in range(most_contacts):
            for g in range(len(halfway)):
                if j < halfway[g].unsettled:
                    change = _improve(contacts[g][j], moving[g])
                    halfway[g].most = max(halfway[g].most, change)
        most_contacts = 0
        for g in range(len(halfway)):
            if halfway[g].most < _SETTLED_IMPULSE:
                halfway[g].unsettled = 0
            most_contacts = max(most_contacts, halfway[g].unsettled)


@compiled_inline
def _improve(row: Contact, moving: Records[Moving]) -> float:
    """Improve a contact's impulses; return the largest change."""
    a, b = moving[row.one], moving[row.other]
    nx, ny = row.nx, row.ny
    vx = b.vx - b.omega * row.r2y - a.vx + a.omega * row.r1y
    vy = b.vy + b.omega * row.r2x - a.vy - a.omega * row.r1x
    press = max(row.normal - (row.back + vx * nx + vy * ny) * row.normal_mass, 0.0)
    limit = row.friction * press
    rub = min(max(row.tangent - (vy * nx - vx * ny) * row.tangent_mass, -limit), limit)
    along, across = press - row.normal, rub - row.tangent
    row.normal, row.tangent = press, rub
    _push(a, b, row, along, across)
    most = max(abs(along), abs(across))
    # Overlaps are undone by velocities of their own, which last for a step.
    vx = b.bias_vx - b.bias_omega * row.r2y - a.bias_vx + a.bias_omega * row.r1y
    vy = b.bias_vy + b.bias_omega * row.r2x - a.bias_vy - a.bias_omega * row.r1x
    lift = max(row.lift + (row.push - vx * nx - vy * ny) * row.normal_mass, 0.0)
    along = lift - row.lift
    row.lift = lift
    if along != 0.0:
        jx, jy = nx * along, ny * along
        a.bias_vx -= jx * a.mass
        a.bias_vy -= jy * a.mass
        a.bias_omega -= a.inertia * (row.r1x * jy - row.r1y * jx)
        b.bias_vx += jx * b.mass
        b.bias_vy += jy * b.mass
        b.bias_omega += b.inertia * (row.r2x * jy - row.r2y * jx)
        most = max(most, abs(along))
    return most
