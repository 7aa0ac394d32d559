"""Robots that drive back and forth and ignore all others, as moving obstacles."""

from __future__ import annotations

from math import hypot
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.straight import DRIVING_LIMITS, TURN, DrivingLimits, drive_of, drive_straight
from robobt.sim.records import COMMAND
from robobt.world.compiled import compilable, compiled_lean, record_dtype
from robobt.world.geometry import FloatArray, Point
from robobt.world.limits import RobotLimits
from robobt.world.records import ROBOT

_TURNING_DISTANCE = 0.1
"""Distance to an end at which it turns round [m]."""
_STUCK_SPEED, _STUCK_TICKS = 0.1, 10.0
"""A patrol slower than this [m/s] for this many ticks is blocked, and turns round."""


class Patrol(Protocol):
    """The traits of a patrol: its two ends [m] and top speed [m/s]; it drives to the second end first."""

    from_x: float
    from_y: float
    to_x: float
    to_y: float
    speed: float


class _PatrolMemory(Protocol):
    """Whether it is on its way to the second end, and for how many ticks it has been blocked."""

    there: float
    stuck: float


PATROL, _PATROL_MEMORY = record_dtype(Patrol), record_dtype(_PatrolMemory)
PATROL_TRAITS = PATROL.names or ()


class Patrols:
    """``count`` patrols in each of ``n`` arenas, the last robots there.

    Args:
        limits: what they can do.
        period: control period [s].
        n: number of arenas.
        count: number of patrols in an arena.
    """

    def __init__(self, limits: RobotLimits, period: float, n: int, count: int) -> None:
        self._drive = drive_of(limits, period, _STUCK_SPEED)
        self._traits = np.zeros((n, count, len(PATROL_TRAITS)))
        self._memory = np.zeros((n, count, 2))

    def restart(self, which: NDArray[np.int64], traits: FloatArray) -> None:
        """Reset the arenas ``which``; ``traits`` (m, count, 5) are of :class:`Patrol`."""
        self._traits[which] = traits
        self._memory[which] = 1.0, 0.0

    def decide(self, robots: FloatArray, commands: FloatArray) -> None:
        """Decide one control tick: fill their ``commands`` (n, R, size(COMMAND)), given all ``robots``."""
        _decide(self._drive, self._traits, self._memory, robots, commands)


@compiled_lean
def _decide(
    drive_: FloatArray, traits: FloatArray, memory: FloatArray, robots: FloatArray, commands: FloatArray
) -> None:
    drive: DrivingLimits = drive_.view(DRIVING_LIMITS)[0]
    patrols, minds = traits.view(PATROL)[..., 0], memory.view(_PATROL_MEMORY)[..., 0]
    all_, orders = robots.view(ROBOT)[..., 0], commands.view(COMMAND)[..., 0]
    arenas, count = patrols.shape
    first = all_.shape[1] - count
    for i in range(arenas):
        for k in range(count):
            patrol: Patrol = patrols[i, k]
            mind: _PatrolMemory = minds[i, k]
            me, command = all_[i, first + k], orders[i, first + k]
            mind.stuck = mind.stuck + 1.0 if hypot(me.vx, me.vy) < _STUCK_SPEED else 0.0
            x, y = _end(patrol, mind)
            if hypot(x - me.x, y - me.y) < _TURNING_DISTANCE or mind.stuck > _STUCK_TICKS:
                mind.there, mind.stuck = 1.0 - mind.there, 0.0
                x, y = _end(patrol, mind)
            commands[i, first + k] = 0.0
            command.vx, command.vy, command.omega = drive_straight(
                me, (x, y), (x, y), patrol.speed, TURN, drive
            )


@compilable
def _end(patrol: Patrol, mind: _PatrolMemory) -> Point:
    return (patrol.to_x, patrol.to_y) if mind.there > 0.0 else (patrol.from_x, patrol.from_y)
