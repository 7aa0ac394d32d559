from __future__ import annotations

from collections.abc import Sequence

import pytest

from robobt.plays.baselines.is_attacker import IsAttacker
from robobt.skills.store import TeamStore
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import OPEN_PLAY, GameState, RobotState, Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import free_kick


class Team3:
    """Robots 1, 2 and 3 of one team, each asking whether it attacks."""

    def __init__(self, farthest: Sequence[float | None] = (None, None, None)) -> None:
        team = TeamStore()
        self.asking = {}
        for number, limit in zip((1, 2, 3), farthest, strict=True):
            self.asking[number] = Alone(IsAttacker(farthest=limit))
            self.asking[number].store.team = team

    def attackers(
        self, robots: Sequence[RobotState], ball: tuple[float, ...], game: GameState = OPEN_PLAY
    ) -> list[int]:
        """Who attacks, asked twice so that all have entered themselves."""
        found: list[int] = []
        for _ in range(2):
            view = frame(robots[0], ball, tuple(robots[1:]), game=game)
            found = [one.id for one in robots if self.asking[one.id].tick(view, one.id) is Status.SUCCESS]
        return found


ROBOTS = (robot(-1.0, 0.0, number=1), robot(-2.0, 1.0, number=2), robot(-3.0, -1.0, number=3))


def test_the_nearest_robot_attacks_and_no_other() -> None:
    assert Team3().attackers(ROBOTS, (0.0, 0.0)) == [1]
    assert Team3().attackers(ROBOTS, (-2.0, 1.2)) == [2]


def test_a_robot_behind_the_ball_goes_before_one_that_has_to_turn_back() -> None:
    robots = (robot(0.5, 0.0, number=1), robot(-0.7, 0.0, number=2))
    assert Team3().attackers(robots, (0.0, 0.0)) == [2]


def test_the_robot_with_the_ball_keeps_it() -> None:
    holder = robot(0.0, 0.0, 2.0, number=1, contact=True)
    rival = robot(-0.25, 0.0, number=2)
    assert Team3().attackers((holder, rival), held(holder)) == [1]


def test_a_little_nearer_is_no_reason_to_change() -> None:
    team = Team3()
    assert team.attackers((robot(-1.0, 0.0, number=1), robot(-1.1, 0.5, number=2)), (0.0, 0.0)) == [1]
    assert team.attackers((robot(-1.0, 0.0, number=1), robot(-0.8, 0.0, number=2)), (0.0, 0.0)) == [1]


def test_much_nearer_is_one() -> None:
    team = Team3()
    assert team.attackers((robot(-1.0, 0.0, number=1), robot(-1.1, 0.5, number=2)), (0.0, 0.0)) == [1]
    assert team.attackers((robot(-1.0, 0.0, number=1), robot(-0.5, 0.0, number=2)), (0.0, 0.0)) == [2]


def test_a_defender_attacks_only_where_it_may() -> None:
    robots = (robot(-1.0, 0.0, number=1), robot(2.0, 0.0, number=2))
    assert Team3((-1.0, None, None)).attackers(robots, (0.0, 0.0)) == [2]
    assert Team3((-1.0, None, None)).attackers(robots, (-1.5, 0.0)) == [1]


def test_a_robot_that_has_left_the_field_is_replaced() -> None:
    team = Team3()
    assert team.attackers(ROBOTS, (0.0, 0.0)) == [1]
    assert team.attackers(ROBOTS[1:], (0.0, 0.0)) == [2]


def test_a_restart_is_taken_by_the_robot_nearest_to_its_place_not_to_the_ball() -> None:
    game = free_kick(Team.BLUE, (-3.0, -1.5))
    assert Team3().attackers(ROBOTS, (0.0, 0.0), game) == [3]


@pytest.mark.parametrize(("vx", "expected"), [(0.0, [1]), (-4.0, [2])])
def test_a_rolling_ball_is_met_where_it_will_be(vx: float, expected: list[int]) -> None:
    robots = (robot(-0.6, 1.4, number=1), robot(-2.0, 0.3, number=2))
    assert Team3().attackers(robots, (0.0, 0.0, vx, 0.0)) == expected
