from __future__ import annotations

import pytest

from robobt.skills.driving import DrivingSkill
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import RobotLimits
from tests.skills.fixed_world import Alone

OWN = RobotLimits(max_speed=4.0)
GIVEN = RobotLimits(max_speed=1.5, acceleration=2.5)


class Driving(DrivingSkill):
    def on_running(self) -> Status:
        return self.run()


@pytest.mark.parametrize(("given", "used"), [(None, OWN), (GIVEN, GIVEN)])
def test_given_limits_win_over_the_robots_own(given: RobotLimits | None, used: RobotLimits) -> None:
    skill = Driving(limits=given)
    Alone(skill).tick(frame(robot(limits=OWN)))
    assert skill.drive_limits is used


def test_the_factor_scales_the_speed_and_not_the_acceleration_of_whichever_robot_it_is() -> None:
    skill = Driving(speed_factor=0.5)
    alone = Alone(skill)
    for own in (OWN, GIVEN):
        alone.tick(frame(robot(limits=own)))
        assert skill.drive_limits.max_speed == 0.5 * own.max_speed
        assert skill.drive_limits.acceleration == own.acceleration


@pytest.mark.parametrize("factor", [0.0, 11.0])
def test_a_factor_no_robot_could_follow_is_refused(factor: float) -> None:
    with pytest.raises(ValueError, match="speed_factor must be above 0 and at most 10"):
        Driving(speed_factor=factor)
