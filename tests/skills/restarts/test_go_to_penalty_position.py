from __future__ import annotations

import pytest

from robobt.skills.restarts.go_to_penalty_position import GoToPenaltyPosition
from robobt.testing import robot
from robobt.world import DIVISION_B, Team
from tests.skills.refereed import Drive, penalty, penalty_in_play

OURS = (-1.5, 0.0)
THEIRS = (1.5, 0.0)


@pytest.mark.parametrize("start", [(0.0, 0.0), (-3.0, 1.0), (3.0, -2.0)], ids=str)
def test_everybody_waits_a_metre_behind_our_ball(start: tuple[float, float]) -> None:
    end = Drive(GoToPenaltyPosition(), robot(*start, number=1), penalty(Team.BLUE, OURS), OURS).end
    assert end.x <= OURS[0] - 1.0
    assert end.speed < 0.01


@pytest.mark.parametrize("start", [(0.0, 0.0), (-3.0, 1.0), (3.0, -2.0)], ids=str)
def test_everybody_waits_a_metre_behind_their_ball(start: tuple[float, float]) -> None:
    end = Drive(GoToPenaltyPosition(), robot(*start, number=1), penalty(Team.YELLOW, THEIRS), THEIRS).end
    assert end.x >= THEIRS[0] + 1.0


def test_our_goalkeeper_waits_on_its_line() -> None:
    skill = GoToPenaltyPosition(goalkeeper=True)
    end = Drive(skill, robot(-4.0, 0.4), penalty(Team.YELLOW, THEIRS), THEIRS).end
    assert abs(end.x + DIVISION_B.half_length) <= 0.09
    assert abs(end.y) < DIVISION_B.goal_width / 2


def test_robots_wait_beside_each_other() -> None:
    mates = (robot(-3.0, 0.0, number=2),)
    game = penalty(Team.BLUE, OURS)
    one = Drive(GoToPenaltyPosition(), robot(0.0, 0.0, number=1), game, OURS, mates=mates).end
    two = Drive(GoToPenaltyPosition(), mates[0], game, OURS, mates=(robot(0.0, 0.0, number=1),)).end
    assert abs(one.y - two.y) > 0.3


def test_everybody_stays_behind_a_ball_in_play_that_comes_back() -> None:
    ball = (OURS[0] - 0.8, 0.5)
    end = Drive(GoToPenaltyPosition(), robot(-2.7, 1.0, number=1), penalty_in_play(Team.BLUE), ball).end
    assert end.x <= ball[0] - 1.0


def test_the_kicking_teams_goalkeeper_stays_at_home() -> None:
    skill = GoToPenaltyPosition(goalkeeper=True)
    end = Drive(skill, robot(-3.0, 0.0), penalty(Team.BLUE, OURS), OURS).end
    assert end.x < -DIVISION_B.half_length + DIVISION_B.defense_depth
