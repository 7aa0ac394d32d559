from __future__ import annotations

import pytest

from robobt.skills.conditions.is_restart import IsRestart
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import GameState, Restart, Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import HALT, OPEN, STOP, free_kick, kickoff, penalty_in_play, stop_before

SPOT = (1.0, 1.0)


def holds(skill: IsRestart, game: GameState, team: Team = Team.BLUE) -> bool:
    return Alone(skill).tick(frame(robot(), game=game, team=team)) is Status.SUCCESS


@pytest.mark.parametrize("team", list(Team))
def test_a_restart_is_ours_or_theirs(team: Team) -> None:
    game = free_kick(Team.BLUE, SPOT)
    assert holds(IsRestart(ours=True), game, team) is (team is Team.BLUE)
    assert holds(IsRestart(ours=False), game, team) is (team is Team.YELLOW)
    assert holds(IsRestart(), game, team)


def test_a_restart_begins_with_the_stop_before_it() -> None:
    assert holds(IsRestart(ours=True), stop_before(Restart.FREE_KICK, Team.BLUE, SPOT))


def test_only_the_asked_kind_counts() -> None:
    assert holds(IsRestart(kind=Restart.KICKOFF), kickoff(Team.BLUE, False))
    assert not holds(IsRestart(kind=Restart.PENALTY), kickoff(Team.BLUE, False))


@pytest.mark.parametrize("game", [HALT, STOP, OPEN], ids=["halt", "stop for both", "open play"])
def test_without_a_restart_there_is_none(game: GameState) -> None:
    assert not holds(IsRestart(), game)


@pytest.mark.parametrize("team", list(Team))
def test_a_penalty_kick_lasts_until_it_ends_though_the_ball_is_in_play(team: Team) -> None:
    game = penalty_in_play(Team.BLUE)
    assert holds(IsRestart(kind=Restart.PENALTY, ours=True), game, team) is (team is Team.BLUE)
    assert holds(IsRestart(kind=Restart.PENALTY, ours=False), game, team) is (team is Team.YELLOW)
    assert not holds(IsRestart(kind=Restart.FREE_KICK), game, team)
