"""How long each robot takes from a command to its seen effect, measured while it plays.

A robot's motion is predicted under every delay of a grid at once, from the commands that were sent, by the
laws and limits of the robot (:mod:`robobt.world.delay_hypotheses`), and each prediction is corrected with
each detection as in a Kalman filter. How well they foresee the next detection tells how likely each delay is
(a multiple-model estimator). All axes count: ahead, aside and turning.

The delay is what is left beyond the lag, gains and accelerations that the robot's limits have. If the limits
say less lag than the robot has, the delay holds what is missing, which is what a prediction by these limits
needs.

No sockets and no clock: all times are arguments.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, inf
from statistics import median
from typing import NamedTuple

import numpy as np

from robobt.world.command import RobotCommand
from robobt.world.delay_evidence import judge
from robobt.world.delay_hypotheses import HYPOTHESIS, SEEN_ROBOT, SENDING, advance, nearest, start
from robobt.world.geometry import FloatArray
from robobt.world.limits import DEFAULT_LIMITS, RobotLimits
from robobt.world.records import limits_of
from robobt.world.state import RobotId

_COMPARED = np.arange(0.0, 0.24 + 1e-9, 0.003)
"""Delays that are compared [s]."""

_LONGEST_GAP = 0.2
"""After a longer gap a robot counts as seen for the first time [s]."""

_PUT_ELSEWHERE = 0.3
"""A robot seen this far from where every command would have it was put there, or hit [m]."""

_LEAST_SHARE, _SHARP = 0.8, 0.01
"""A delay counts as measured once this share of the belief lies about its peak, with a standard deviation
below this [s]."""

_SAME_DELAY = 0.02
"""While the peak stays this near to a known delay, the delay stays known, however wide the belief [s]."""

_CONFIRMED = 0.2
"""A new delay counts once the peak has stayed there for this long [s]."""

_LEAST_ERROR = 0.0012
"""Standard error of even the best measurement, because commands take effect in steps [s]."""

_95 = 1.96
"""Half width of a 95 % interval in standard errors."""

_MOST_SENT = 64
"""Commands that are remembered: more than are sent in the longest delay of the grid and a gap."""

_DOUBLE = np.dtype(np.float64).itemsize


class MeasuredDelay(NamedTuple):
    """A measured delay.

    Attributes:
        seconds: from sending a command to its seen effect [s].
        error: its standard error [s].
    """

    seconds: float
    error: float

    @property
    def low(self) -> float:
        """Lower end of the 95 % interval [s]; no effect is seen before its cause."""
        return max(0.0, self.seconds - _95 * self.error)

    @property
    def high(self) -> float:
        """Upper end of the 95 % interval [s]."""
        return self.seconds + _95 * self.error


class DelayWatch:
    """Measures the delay of each robot that is commanded and seen.

    Args:
        limits: of robots that are not named in ``own``.
        own: limits of individual robots.
        nominal: delay to expect until one is measured, of all but the robots themselves [s].
    """

    def __init__(
        self,
        limits: RobotLimits = DEFAULT_LIMITS,
        own: Mapping[RobotId, RobotLimits] | None = None,
        nominal: float = 0.0,
    ) -> None:
        self._limits, self._own, self._nominal = limits, dict(own or {}), nominal
        self._robots: dict[RobotId, _RobotWatch] = {}
        self._excess: float | None = None
        # What has to be compiled is so before the match, not in it.
        probe = _RobotWatch(limits)
        probe.sent(0.0, RobotCommand())
        for time in (0.0, 0.01):
            probe.see(time, 0.0, 0.0, 0.0)

    def sent(self, time: float, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Record commands that are sent.

        Args:
            time: when, on the clock of the detections [s].
            commands: by robot.
        """
        for robot, command in commands.items():
            watch = self._robots.get(robot)
            if watch is None:
                watch = self._robots[robot] = _RobotWatch(self._limits_of(robot))
            watch.sent(time, command)

    def see(self, robot: RobotId, time: float, x: float, y: float, heading: float) -> None:
        """Use a detection.

        Args:
            robot: which was seen; one that was never commanded is ignored.
            time: of the capture, as far as it is known [s].
            x: its x coordinate [m].
            y: its y coordinate [m].
            heading: its heading [rad].
        """
        watch = self._robots.get(robot)
        if watch is not None:
            before = watch.delay
            watch.see(time, x, y, heading)
            if watch.delay is not before:
                self._excess = None

    def of(self, robot: RobotId) -> MeasuredDelay | None:
        """Return the delay of a ``robot``; None while too little was seen."""
        watch = self._robots.get(robot)
        return None if watch is None else watch.delay

    def expected(self, robot: RobotId) -> float:
        """Return the delay by which to predict a ``robot`` [s].

        It is the measured one. For a robot that was not seen enough it is the delay that the nominal one and
        its limits tell, plus the median of what the measured robots have beyond theirs.
        """
        known = self.of(robot)
        if known is not None:
            return known.seconds
        if self._excess is None:
            delays = {other: watch.delay for other, watch in self._robots.items()}
            excess = [it.seconds - self._expected(other) for other, it in delays.items() if it is not None]
            self._excess = median(excess) if excess else 0.0
        return self._expected(robot) + self._excess

    def measured(self, age: float = 0.0) -> dict[RobotId, MeasuredDelay | None]:
        """Return the delay of each robot that was commanded; None while too little was seen.

        Args:
            age: of the pictures, which is added to each delay [s].
        """
        delays = {robot: watch.delay for robot, watch in sorted(self._robots.items())}
        return {
            robot: None if it is None else MeasuredDelay(age + it.seconds, it.error)
            for robot, it in delays.items()
        }

    def expects_as(self, other: DelayWatch) -> bool:
        """Return whether ``other`` was made for the same robots, so that both may share their figures."""
        return (self._limits, self._own, self._nominal) == (other._limits, other._own, other._nominal)

    def interrupt(self) -> None:
        """Forget where robots are, as after they were placed or the clock jumped; keep their delays."""
        for watch in self._robots.values():
            watch.interrupt()

    def _limits_of(self, robot: RobotId) -> RobotLimits:
        return self._own.get(robot, self._limits)

    def _expected(self, robot: RobotId) -> float:
        return self._limits_of(robot).obeys_after(self._nominal)


class _RobotWatch:
    """Measures one robot's delay; what was measured last stays known while the robot stands."""

    def __init__(self, limits: RobotLimits) -> None:
        self.delay: MeasuredDelay | None = None
        self._limits: FloatArray = limits_of(limits)
        self._rows: FloatArray = np.zeros((len(_COMPARED), HYPOTHESIS.itemsize // _DOUBLE))
        hypotheses = self._rows.view(HYPOTHESIS)[:, 0]
        hypotheses["delay"] = _COMPARED
        hypotheses["misfit"] = hypotheses["turn_misfit"] = 1.0
        self._seen: FloatArray = np.zeros(SEEN_ROBOT.itemsize // _DOUBLE)
        self._sendings: FloatArray = np.zeros((2 * _MOST_SENT, SENDING.itemsize // _DOUBLE))
        self._first = self._end = 0
        self._time = self._candidate_since = -inf
        self._candidate = inf

    def sent(self, time: float, command: RobotCommand) -> None:
        if self._end == len(self._sendings):
            self._sendings[:_MOST_SENT] = self._sendings[-_MOST_SENT:]
            self._first, self._end = max(0, self._first - _MOST_SENT), _MOST_SENT
        self._sendings[self._end] = command.vx, command.vy, command.omega, time
        self._end += 1
        self._first = max(self._first, self._end - _MOST_SENT)

    def interrupt(self) -> None:
        self._time = -inf
        self._first = self._end

    def see(self, time: float, x: float, y: float, heading: float) -> None:
        before, seen = self._time, self._seen
        if 0.0 >= time - before > -_LONGEST_GAP:
            return
        seen[:3] = x, y, heading
        self._time = time
        if not 0.0 < time - before < _LONGEST_GAP:
            start(self._rows, seen)
            return
        advance(self._rows, self._sendings[self._first : self._end], self._limits, before, time)
        if nearest(self._rows, seen) > _PUT_ELSEWHERE:
            start(self._rows, seen)
            return
        delay, deviation, share = judge(self._rows, seen, time - before)
        sure = share > _LEAST_SHARE and deviation < _SHARP
        known = self.delay is not None and abs(delay - self.delay.seconds) < _SAME_DELAY
        if not sure or abs(delay - self._candidate) > _SAME_DELAY:
            self._candidate, self._candidate_since = delay, time
        if known or (sure and time - self._candidate_since > _CONFIRMED):
            self.delay = MeasuredDelay(delay, hypot(deviation, _LEAST_ERROR))
