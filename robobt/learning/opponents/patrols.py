"""Robots that drive to and fro and look at nothing: what a robot on its way has to avoid."""

from __future__ import annotations

from math import atan2, cos, hypot, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits

TRAITS = ("from_x", "from_y", "to_x", "to_y", "speed")
"""What makes a patrol: its two ends [m] and its top speed [m/s]; it drives to the second end first."""

_THERE = 0.1
"""How near an end it turns round [m]."""
_STUCK, _PATIENCE = 0.1, 10.0
"""A patrol slower than this [m/s] for so many ticks is held up, and turns round."""
_LOOK, _TURN = 6.0, 6.0
"""How fast it turns into its way for each radian [1/s], and at most [rad/s]."""


class Patrols:
    """``count`` patrols in each of ``n`` arenas, the last robots there.

    Args:
        limits: what they can do.
        period: control period [s].
        n: number of arenas.
        count: of patrols in an arena.
    """

    def __init__(self, limits: RobotLimits, period: float, n: int, count: int) -> None:
        self._braking = min(limits.braking, limits.lateral_braking)
        self._period = period
        self._traits = np.zeros((n, count, len(TRAITS)))
        # Which end is driven to, 1 for the second, and for how long it has been stuck.
        self._memory = np.zeros((n, count, 2))

    def restart(self, which: NDArray[np.int64], traits: FloatArray) -> None:
        """Begin anew in the arenas ``which``; ``traits`` (m, count, 5) are :data:`TRAITS`."""
        self._traits[which] = traits
        self._memory[which] = 1.0, 0.0

    def decide(self, robots: FloatArray, commands: FloatArray) -> None:
        """Decide one control tick.

        Args:
            robots: (n, R, 6) of all robots.
            commands: (n, count, >= 6) to be filled.
        """
        first = robots.shape[1] - self._traits.shape[1]
        _decide(self._braking, self._period, self._traits, self._memory, robots[:, first:], commands)


@compiled
def _decide(
    braking: float,
    period: float,
    traits: FloatArray,
    memory: FloatArray,
    robots: FloatArray,
    commands: FloatArray,
) -> None:
    for i in range(traits.shape[0]):
        for k in range(traits.shape[1]):
            me, patrol, mind, command = robots[i, k], traits[i, k], memory[i, k], commands[i, k]
            mind[1] = mind[1] + 1.0 if hypot(me[3], me[4]) < _STUCK else 0.0
            end = 2 if mind[0] > 0.0 else 0
            dx, dy = patrol[end] - me[0], patrol[end + 1] - me[1]
            way = hypot(dx, dy)
            if way < _THERE or mind[1] > _PATIENCE:
                mind[0], mind[1] = 1.0 - mind[0], 0.0
                end = 2 - end
                dx, dy = patrol[end] - me[0], patrol[end + 1] - me[1]
                way = hypot(dx, dy)
            # As fast as it may be to stop there, and never slower than it takes to get there.
            speed = min(patrol[4], max(sqrt(2.0 * 0.8 * braking * way), _STUCK), way / period)
            vx, vy = (speed * dx / way, speed * dy / way) if way > 0.0 else (0.0, 0.0)
            c, s = cos(me[2]), sin(me[2])
            command[:] = 0.0
            command[0], command[1] = c * vx + s * vy, c * vy - s * vx
            command[2] = min(max(_LOOK * wrap_angle(atan2(dy, dx) - me[2]), -_TURN), _TURN)
