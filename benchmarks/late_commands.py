"""A simulated field whose robots get their commands late, unevenly late, or never."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from robobt.sim import SimWorld
from robobt.world.command import RobotCommand
from robobt.world.protocol import Placement, WrappedWorld
from robobt.world.state import Frame, RobotId

PARTS = 8
"""Usual number of parts of a control period at whose beginnings commands arrive."""


@dataclass(slots=True)
class _Robot:
    """The command that a robot obeys, by when it was sent, and those on their way to it by arrival [s]."""

    sent: float = -1.0
    obeyed: RobotCommand = field(default_factory=RobotCommand)
    coming: list[tuple[float, float, RobotCommand]] = field(default_factory=list)


class LateCommands(WrappedWorld):
    """A world to which commands are sent over a radio.

    Args:
        fast: the simulated field, whose period is such a part of the control period.
        delay: of a robot's commands at a time [s], from the robot and the time.
        jitter: standard deviation of the delay from command to command [s].
        lost: share of commands that never arrive.
        parts: of a control period.
    """

    def __init__(
        self,
        fast: SimWorld,
        delay: Callable[[RobotId, float], float],
        jitter: float = 0.0,
        lost: float = 0.0,
        parts: int = PARTS,
    ) -> None:
        super().__init__(fast)
        self._part, self._parts = fast.period, parts
        self._delay, self._jitter, self._lost = delay, jitter, lost
        self._rng = np.random.default_rng(0)
        self._robots: dict[RobotId, _Robot] = {}
        self._ticks = 0

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`robobt.world.World.reset`."""
        self.world.reset(placement, seed)
        self._rng = np.random.default_rng(seed)
        self._robots = {robot: _Robot() for robot in placement.robots}
        self._ticks = 0

    def observe(self) -> Frame:
        """See :meth:`robobt.world.World.observe`."""
        return replace(self.world.observe(), period=self._parts * self._part)

    def truth(self) -> Frame:
        """See :meth:`robobt.world.World.truth`."""
        return replace(self.world.truth(), period=self._parts * self._part)

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Send the commands, and let a control period pass; a robot obeys the newest that has reached it."""
        now = self._ticks * self._part
        for robot, command in commands.items():
            late, lost = self._rng.normal(self._delay(robot, now), self._jitter), self._rng.random()
            if lost >= self._lost:
                self._robots[robot].coming.append((now + max(0.0, late), now, command))
        for _ in range(self._parts):
            # A command counts from the nearest part on, so that arrivals are not late on the average.
            due = (self._ticks + 0.5) * self._part
            for it in self._robots.values():
                arrived = [one for one in it.coming if one[0] <= due]
                it.coming = [one for one in it.coming if one[0] > due]
                for _, sent, command in arrived:
                    if sent > it.sent:
                        it.sent, it.obeyed = sent, command
            self.world.act({robot: it.obeyed for robot, it in self._robots.items()})
            self._ticks += 1
