"""What comes back for a served field's pictures: round trips, losses, and how late the robots obey."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from robobt.sim.settings import SimSettings
from robobt.world.command import RobotCommand
from robobt.world.delay import DelayWatch, MeasuredDelay
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId, RobotState

_SILENT = 1.0
"""A robot that gets no command for this long is no longer commanded [s]."""


@dataclass(slots=True)
class RoundTrips:
    """A robot's round trips: from a picture's sending to the first command that comes then.

    Attributes:
        commands: number of commands that came.
        lost: how many of them the field's realism has lost.
        pictures: number of pictures that were sent while the robot was commanded.
        answered: to how many of them a command came before the next picture.
        mean: mean time of these [s].
        maximum: longest time [s].
    """

    commands: int = 0
    lost: int = 0
    pictures: int = 0
    answered: int = 0
    mean: float = 0.0
    maximum: float = 0.0
    _squares: float = 0.0

    @property
    def variance(self) -> float:
        """Variance of the times [s^2]; 0 for a single one."""
        return self._squares / (self.answered - 1) if self.answered > 1 else 0.0

    @property
    def unanswered(self) -> int:
        """Number of pictures to which no command came before the next."""
        return self.pictures - self.answered

    def add(self, seconds: float) -> None:
        """Add a round trip of this time [s]."""
        self.answered += 1
        off = seconds - self.mean
        self.mean += off / self.answered
        self._squares += off * (seconds - self.mean)
        self.maximum = max(self.maximum, seconds)


class TripWatch:
    """Follows what clients do, and how late the robots obey.

    Args:
        settings: of the field.
        limits: of individual robots.
        clock: monotonic seconds, by which round trips are measured.

    Attributes:
        robots: round trips of each robot that was commanded.
    """

    def __init__(
        self,
        settings: SimSettings,
        limits: Mapping[RobotId, RobotLimits],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.robots: dict[RobotId, RoundTrips] = {}
        self._clock = clock
        self._delays = DelayWatch(settings.limits, limits)
        self._picture_at: float | None = None
        self._open: set[RobotId] = set()
        self._commanded_at: dict[RobotId, float] = {}

    def picture_sent(self) -> None:
        """Take note that a picture is sent now."""
        now = self._picture_at = self._clock()
        self._open = {robot for robot, at in self._commanded_at.items() if now - at < _SILENT}
        for robot in self._open:
            self.robots[robot].pictures += 1

    def commanded(self, robot: RobotId, command: RobotCommand, at: float, lost: bool) -> None:
        """Take note of a command that has come.

        Args:
            robot: whose.
            command: the command.
            at: time on the field [s].
            lost: whether the field's realism has lost it.
        """
        now = self._commanded_at[robot] = self._clock()
        trips = self.robots.setdefault(robot, RoundTrips())
        trips.commands += 1
        trips.lost += lost
        if robot in self._open and self._picture_at is not None:
            self._open.discard(robot)
            trips.add(now - self._picture_at)
        if not lost:
            # Its client, which does not know, counts it as sent; then waiting for the next one is delay too.
            self._delays.sent(at, {robot: command})

    def stopped(self, robot: RobotId, at: float) -> None:
        """Take note that the field stops a robot whose commands stay away.

        Args:
            robot: which.
            at: time on the field [s].
        """
        self._delays.sent(at, {robot: RobotCommand()})

    def stepped(self, at: float, robots: Mapping[RobotId, RobotState]) -> None:
        """Take note of where robots are at a time on the field [s]."""
        for robot in self.robots:
            state = robots.get(robot)
            if state is not None:
                self._delays.see(robot, at, state.x, state.y, state.heading)

    def delays(self, age: float) -> dict[RobotId, MeasuredDelay | None]:
        """Return each commanded robot's delay, from a command's coming until its effect is sent.

        It is None for a robot that was not seen enough, or whose commands were all lost. Commands that the
        field's realism has lost do not make it longer.

        Args:
            age: of a picture when it is sent [s].
        """
        return dict.fromkeys(self.robots) | self._delays.measured(age)
