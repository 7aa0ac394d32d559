"""A served field keeps its speed, leaves out what a stall has cost, and gets back in time unnoticed."""

from __future__ import annotations

import pytest

from robobt.league.serve.pace import ServingPace

PERIOD = 1 / 60


class Served:
    """A field that is simulated whenever it is due, on a machine with a clock of its own.

    Args:
        speed: of the field.
        cost: how long a step takes there [s].
    """

    def __init__(self, speed: float = 1.0, cost: float = 0.0) -> None:
        self.now = 1000.0
        self.time = 0.0
        self.steps: list[float] = []
        self.told: list[float] = []
        self.speed, self.cost = speed, cost
        self.pace = ServingPace(self.now, self.time)

    def run(self, seconds: float) -> None:
        end = self.now + seconds
        while self.now < end:
            self.pace.advance(self.now, self.speed)
            self.pace.reached(self.time, PERIOD)
            if self.pace.due >= self.time + PERIOD:
                self.time += PERIOD
                self.now += self.cost
                self.steps.append(self.now)
                slow = self.pace.slow()
                if slow is not None:
                    self.told.append(slow)
            self.now += 0.002

    def stall(self, seconds: float) -> None:
        self.now += seconds


@pytest.mark.parametrize("speed", [0.1, 1.0, 5.0])
def test_time_passes_at_the_speed_that_is_asked_for(speed: float) -> None:
    served = Served(speed)
    served.run(10.0)
    assert served.time == pytest.approx(10.0 * speed, abs=2 * PERIOD)
    assert served.pace.kept == 1.0
    assert served.told == []


def test_a_short_stall_is_made_up_for_at_once() -> None:
    served = Served()
    served.run(1.0)
    served.stall(0.2)
    served.run(0.05)
    assert served.time == pytest.approx(1.25, abs=2 * PERIOD)


def test_a_long_stall_is_made_up_for_little_by_little() -> None:
    served = Served()
    served.run(1.0)
    served.stall(1.0)
    before = served.time
    served.run(0.1)
    assert served.time - before < 0.1 + 2 * PERIOD
    assert served.pace.kept < 0.6
    # At most half a percent faster, which no client takes for another speed.
    before = served.time
    served.run(10.0)
    assert served.time - before == pytest.approx(10.05, abs=2 * PERIOD)
    served.run(300.0)
    assert served.time == pytest.approx(served.now - 1000.0, abs=2 * PERIOD)


def test_a_machine_that_is_too_slow_is_told() -> None:
    served = Served(cost=0.025)
    served.run(20.0)
    assert len(served.told) >= 3
    assert served.told[0] == pytest.approx(PERIOD / 0.027, abs=0.06)
    assert served.pace.kept == pytest.approx(PERIOD / 0.027, abs=0.03)
    # It goes on all the time instead of waiting for what it cannot reach.
    gaps = [later - sooner for sooner, later in zip(served.steps, served.steps[1:], strict=False)]
    assert max(gaps) < 0.032


def test_another_speed_holds_from_now_on() -> None:
    served = Served()
    served.run(2.0)
    served.speed = 3.0
    served.run(2.0)
    assert served.time == pytest.approx(8.0, abs=5 * PERIOD)
    assert served.pace.kept == 1.0
