from __future__ import annotations

from robobt.plays.stuck import get_where_stuck
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import RobotState
from tests.skills.fixed_world import Alone

PERIOD = 1 / 60
BESIDE = (0.093, -0.07)


def after_a_second(alone: Alone, mates: tuple[RobotState, ...] = ()) -> Status:
    status = Status.INVALID
    for tick in range(60):
        status = alone.tick(frame(robot(), BESIDE, mates=mates, time=tick * PERIOD))
    return status


def test_a_ball_beside_the_mouth_is_turned_to() -> None:
    alone = Alone(get_where_stuck())
    assert after_a_second(alone) is Status.RUNNING
    assert alone.command.omega < 0.0
    assert alone.command.dribbler


def test_who_took_the_restart_leaves_the_ball_alone() -> None:
    alone = Alone(get_where_stuck())
    alone.store.team.kicker = 0
    assert after_a_second(alone) is Status.FAILURE


def test_a_mate_that_is_nearer_has_it() -> None:
    assert after_a_second(Alone(get_where_stuck()), (robot(0.15, -0.11, number=1),)) is Status.FAILURE
