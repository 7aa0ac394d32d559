"""A goalkeeper of a drawn kind in a team of several, at either goal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.keepers import Keepers
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, wrap_angles
from robobt.world.limits import RobotLimits


class TeamKeeper:
    """The robot ``index`` of each arena as a goalkeeper, which minds the opponent nearest to the ball alone.

    Args:
        field: dimensions.
        limits: what it can do.
        period: control period [s].
        n: number of arenas.
        index: of the robot.
        blue: how many robots, the first, are blue, whose goal is at -x.
    """

    def __init__(
        self, field: FieldGeometry, limits: RobotLimits, period: float, n: int, index: int, blue: int
    ) -> None:
        self.index = index
        self._sign = -1.0 if index < blue else 1.0
        self._opponents = slice(blue, None) if index < blue else slice(0, blue)
        self._keepers = Keepers(field, limits, period, n)
        self._commands = np.zeros((n, 6))
        self._all = np.arange(n)

    @property
    def kept(self) -> NDArray[np.bool_]:
        """(n,) whether the ball rests where it is the goalkeeper's to fetch."""
        return self._keepers.kept

    def restart(self, which: NDArray[np.int64], traits: FloatArray) -> None:
        """See :meth:`Keepers.restart`."""
        self._keepers.restart(which, traits)

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick: fill its commands among those of all robots (n, R, >= 6)."""
        opponents = robots[:, self._opponents]
        away = np.hypot(*(opponents[..., :2] - balls[:, None, :2]).transpose(2, 0, 1))
        nearest = away.argmin(axis=1)
        pair = np.stack((opponents[self._all, nearest], robots[:, self.index]), axis=1)
        holds = np.stack((contact[:, self._opponents][self._all, nearest], contact[:, self.index]), axis=1)
        if self._sign < 0.0:
            # Turned round by half a turn its goal is at +x.
            pair *= [-1.0, -1.0, 1.0, -1.0, -1.0, 1.0]
            pair[..., 2] = wrap_angles(pair[..., 2] + np.pi)
            balls = -balls
        self._keepers.decide(pair, balls, holds, self._commands)
        commands[:, self.index, :6] = self._commands
