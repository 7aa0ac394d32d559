from __future__ import annotations

import pytest

from robobt.skills.tactics.defence import threats
from robobt.skills.tactics_settings import DEFAULT_TACTICS
from robobt.testing import frame, robot
from robobt.world import RobotState

KEEPER = robot(-4.3, 0.0, number=0)


def ranked(
    *theirs: RobotState, ball: tuple[float, float] = (1.0, 0.0), marked: tuple[int, ...] = ()
) -> list[int]:
    return [one.id for one in threats(frame(KEEPER, ball, opponents=theirs), DEFAULT_TACTICS, marked)]


def test_who_is_nearer_to_the_goal_is_more_dangerous() -> None:
    assert ranked(robot(-1.0, 0.0, number=1), robot(-2.0, 1.0, number=2)) == [2, 1]


def test_a_marked_opponent_stays_before_one_that_is_hardly_more_dangerous() -> None:
    near, far = robot(-2.0, 0.8, number=1), robot(-1.8, -0.8, number=2)
    assert ranked(near, far) == [1, 2]
    assert ranked(near, far, marked=(2,)) == [2, 1]


@pytest.mark.parametrize("other", [robot(1.5, 0.0, number=3), robot(0.3, 0.1, number=3)])
def test_nobody_fears_one_far_away_or_at_the_ball(other: RobotState) -> None:
    assert ranked(other, ball=(0.2, 0.0)) == []
