"""How late each robot was measured to obey in a trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pydantic import ConfigDict

from robobt.world.delay import MeasuredDelay
from robobt.world.state import RobotId


@dataclass(slots=True, frozen=True)
class DelayResult:
    """A robot's delay from a command to its seen effect, at the end of a trial.

    Attributes:
        seconds: the delay [s].
        low, high: ends of its 95 % interval [s].
    """

    __pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)

    seconds: float
    low: float
    high: float


def delay_results(measured: Mapping[RobotId, MeasuredDelay | None]) -> dict[str, DelayResult | None]:
    """Return the delays by the robots' names ("blue 0"), None for a robot that was not seen enough."""
    return {
        str(robot): None if it is None else DelayResult(it.seconds, it.low, it.high)
        for robot, it in sorted(measured.items())
    }
