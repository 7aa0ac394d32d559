from __future__ import annotations

import pytest

from robobt.skills.conditions.stuck_at_ball import StuckAtBall
from robobt.testing import frame, held, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone

PERIOD = 1 / 60
BESIDE = (0.093, -0.07)
"""Where a ball lies at which a robot of the real grSim stood until the time was over [m]."""


class Robot:
    """One robot that looks at a ball for a while."""

    def __init__(self, patience: float = 0.5) -> None:
        self._alone = Alone(StuckAtBall(distance=0.4, patience=patience))
        self._tick = 0

    def pauses(self, seconds: float) -> None:
        self._tick += round(seconds / PERIOD)

    def looks(self, seconds: float, ball: tuple[float, float], contact: bool = False) -> Status:
        status = Status.INVALID
        for _ in range(round(seconds / PERIOD)):
            status = self._alone.tick(frame(robot(contact=contact), ball, time=self._tick * PERIOD))
            self._tick += 1
        return status


@pytest.mark.parametrize("ball", [BESIDE, (-0.3, 0.2)])
def test_who_is_near_the_ball_for_long_and_does_not_get_it_is_stuck(ball: tuple[float, float]) -> None:
    mine = Robot()
    assert mine.looks(0.45, ball) is Status.FAILURE
    assert mine.looks(0.1, ball) is Status.SUCCESS


def test_who_is_far_from_the_ball_or_has_it_is_not() -> None:
    assert Robot().looks(2.0, (0.3, 0.3)) is Status.FAILURE
    assert Robot().looks(2.0, held(robot()), contact=True) is Status.FAILURE


def test_the_ball_in_the_mouth_ends_it_once_it_stays_there() -> None:
    mine = Robot()
    mine.looks(1.0, BESIDE)
    assert mine.looks(0.05, held(robot()), contact=True) is Status.SUCCESS
    assert mine.looks(0.1, held(robot()), contact=True) is Status.FAILURE
    assert mine.looks(0.3, BESIDE) is Status.FAILURE


def test_who_has_had_it_for_long_counts_anew() -> None:
    mine = Robot()
    mine.looks(0.3, BESIDE)
    mine.looks(0.3, held(robot()), contact=True)
    assert mine.looks(0.3, BESIDE) is Status.FAILURE


def test_time_in_which_it_was_not_asked_does_not_count() -> None:
    mine = Robot()
    assert mine.looks(0.3, BESIDE) is Status.FAILURE
    mine.pauses(10.0)
    assert mine.looks(0.3, BESIDE) is Status.FAILURE
    assert mine.looks(0.3, BESIDE) is Status.SUCCESS


@pytest.mark.parametrize("parameter", ["distance", "patience"])
def test_nothing_negative(parameter: str) -> None:
    with pytest.raises(ValueError, match=f"{parameter} must be 0 or more, not -1"):
        StuckAtBall(**{parameter: -1.0})
