from __future__ import annotations

from math import pi

from robobt.skills.team.mate_aims_at_me import MateAimsAtMe
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import RobotState
from tests.skills.fixed_world import Alone

ME = robot(2.0, 0.0, number=0)


def after(seconds: float, mate: RobotState, ball: tuple[float, float] | None = None) -> Status:
    alone = Alone(MateAimsAtMe(rise=0.2))
    status = Status.INVALID
    for tick in range(round(60 * seconds) + 1):
        status = alone.tick(frame(ME, ball or held(mate), mates=(mate,), time=tick / 60))
    return status


def test_a_mate_that_has_faced_this_robot_for_a_while_aims_at_it() -> None:
    mate = robot(0.0, 0.0, heading=0.05, number=1)
    assert after(0.1, mate) is Status.FAILURE
    assert after(0.3, mate) is Status.SUCCESS


def test_one_that_faces_elsewhere_does_not() -> None:
    assert after(0.5, robot(0.0, 0.0, heading=0.3, number=1)) is Status.FAILURE
    assert after(0.5, robot(0.0, 0.0, heading=pi, number=1)) is Status.FAILURE


def test_one_without_the_ball_does_not() -> None:
    assert after(0.5, robot(0.0, 0.0, number=1), ball=(-1.0, 0.0)) is Status.FAILURE


def test_one_close_by_does_not() -> None:
    assert after(0.5, robot(1.2, 0.0, number=1)) is Status.FAILURE
