from __future__ import annotations

import pytest

from robobt.motion.pace import Pace
from robobt.world import RobotLimits

OWN = RobotLimits(max_speed=4.0)
GIVEN = RobotLimits(max_speed=1.5, acceleration=2.5)


def test_without_limits_a_robot_drives_with_its_own() -> None:
    assert Pace(None, 1.0).of(OWN) is OWN


def test_given_limits_win() -> None:
    assert Pace(GIVEN, 1.0).of(OWN) is GIVEN


def test_the_factor_scales_the_speed_and_not_the_acceleration() -> None:
    limits = Pace(GIVEN, 0.5).of(OWN)
    assert limits.max_speed == 0.75
    assert limits.acceleration == 2.5


def test_it_follows_a_change_of_the_robot() -> None:
    pace = Pace(None, 0.5)
    assert pace.of(OWN).max_speed == 2.0
    assert pace.of(GIVEN).max_speed == 0.75


@pytest.mark.parametrize("factor", [0.0, -1.0, 1e308, float("nan"), float("inf")])
def test_a_factor_no_robot_could_follow_is_refused(factor: float):
    with pytest.raises(ValueError, match="speed_factor must be above 0 and at most 10"):
        Pace(None, factor)
