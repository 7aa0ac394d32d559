"""The arrays of any number of arenas, which the kernels view as records."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, cast

import numpy as np

from robobt.sim.chipmunk import Calls
from robobt.sim.contacts.solver import ContactArrays
from robobt.sim.parameters import arena_parameters, wheel_parameters
from robobt.sim.records import (
    ARENA,
    BODY,
    FLIGHT,
    FRONT,
    KEPT,
    SEEN_BALL,
    WHEEL_DRIVE,
    BoolArray,
    IntArray,
    size,
)
from robobt.sim.settings import SimSettings
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.records import LIMITS, limits_of


class ArenaArrays(NamedTuple):
    """The arrays of ``n`` arenas with R robots each, as numbers."""

    states: FloatArray  # (n, size(ARENA))
    kept: FloatArray  # (n, R, size(KEPT))
    drives: FloatArray  # (n, R, size(DRIVE))
    bodies: FloatArray  # (n, R + 1 or more, size(BODY)) the robots', the ball's, and spare ones
    flight: FloatArray  # (n, size(FLIGHT))
    touch: IntArray  # (n,)
    kicked: BoolArray  # (n, R) out: kicks fired in a period
    contact: BoolArray  # (n, R) out: ball in the mouth
    robots: FloatArray  # (n, R, size(BODY)) out
    balls: FloatArray  # (n, size(SEEN_BALL)) out
    # (sub_steps or 0, n, R + 1, size(BODY)) out: bodies after every sub-step; a ball's has its height and the
    # rate of that where a robot's has the heading and its rate.
    history: FloatArray
    fronts: FloatArray  # (R, size(FRONT)) scratch
    contacts: ContactArrays
    calls: Calls

    def plain(self) -> ArenaArrays:
        """Return the arrays as plain tuples, whose type numba determines in half the time."""
        return cast(ArenaArrays, (*self[:-2], tuple(self.contacts), tuple(self.calls)))


def arena_arrays(
    settings: SimSettings,
    limits: Sequence[RobotLimits | None],
    history: int,
    bodies: FloatArray,
    contacts: ContactArrays,
    calls: Calls,
) -> ArenaArrays:
    """Return the arrays of arenas with robots of such ``limits``; None takes the settings' own.

    ``history`` is how many sub-steps to keep; ``calls`` are pymunk's.
    """
    n, robots = len(bodies), len(limits)
    states, kept = np.zeros((n, size(ARENA))), np.zeros((n, robots, size(KEPT)))
    states.view(ARENA)["parameters"] = arena_parameters(settings)
    states.view(ARENA)["wheels"] = wheel_parameters(settings.wheels)
    each = kept.view(KEPT)["limits"]
    for i, own in enumerate(limits):
        each[:, i] = limits_of(own or settings.limits).view(LIMITS)
    return ArenaArrays(
        states=states,
        kept=kept,
        drives=np.zeros((n, robots, size(WHEEL_DRIVE))),
        bodies=bodies,
        flight=np.zeros((n, size(FLIGHT))),
        touch=np.full(n, -1, dtype=np.int64),
        kicked=np.zeros((n, robots), dtype=np.bool_),
        contact=np.zeros((n, robots), dtype=np.bool_),
        robots=np.zeros((n, robots, size(BODY))),
        balls=np.zeros((n, size(SEEN_BALL))),
        history=np.zeros((history, n, robots + 1, size(BODY))),
        fronts=np.zeros((robots, size(FRONT))),
        contacts=contacts,
        calls=calls,
    )
