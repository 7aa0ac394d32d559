from __future__ import annotations

import pytest

from robobt.skills import KeepDistance, Stop
from robobt.skills.restarts.referee_switch import Phase, RefereeSwitch, phase
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import OPEN_PLAY, GameState, RefereeCommand, Restart, Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import HALT, OPEN, STOP, free_kick, kickoff, penalty, stop_before

SPOT = (1.0, 1.0)
PLACEMENT = GameState(
    RefereeCommand.BALL_PLACEMENT_BLUE,
    restart=Restart.BALL_PLACEMENT,
    restart_team=Team.BLUE,
    placement=SPOT,
)


@pytest.mark.parametrize(
    ("game", "ours", "theirs"),
    [
        (OPEN_PLAY, "play", "play"),
        (OPEN, "play", "play"),
        (HALT, "halt", "halt"),
        (GameState(RefereeCommand.TIMEOUT_YELLOW), "halt", "halt"),
        (STOP, "stop", "stop"),
        (stop_before(Restart.FREE_KICK, Team.BLUE, SPOT), "stop", "stop"),
        (kickoff(Team.BLUE, may_touch=False), "our_kickoff", "their_kickoff"),
        (kickoff(Team.BLUE, may_touch=True), "our_kickoff", "their_kickoff"),
        (free_kick(Team.BLUE, SPOT), "our_free_kick", "their_free_kick"),
        (penalty(Team.BLUE, SPOT), "our_penalty", "their_penalty"),
        (PLACEMENT, "our_ball_placement", "their_ball_placement"),
        (GameState(RefereeCommand.PREPARE_KICKOFF_BLUE), "stop", "stop"),
    ],
)
def test_each_word_of_the_referee_is_a_phase_of_both_teams(game: GameState, ours: str, theirs: str) -> None:
    assert phase(game, Team.BLUE) == ours
    assert phase(game, Team.YELLOW) == theirs


def test_every_phase_comes_about() -> None:
    games = [OPEN, HALT, STOP, kickoff(Team.BLUE, True), free_kick(Team.BLUE, SPOT), penalty(Team.BLUE, SPOT)]
    assert {phase(game, team) for game in [*games, PLACEMENT] for team in Team} == set(Phase)


def test_only_the_child_of_the_phase_is_ticked() -> None:
    switch = RefereeSwitch("referee", {"play": KeepDistance(), "stop": Stop(name="stand")})
    alone = Alone(switch)
    alone.tick(frame(robot(), (0.3, 0.0), game=OPEN))
    assert [child.name for child in switch.children if child.status is not Status.INVALID] == ["KeepDistance"]
    alone.tick(frame(robot(), (0.3, 0.0), game=STOP))
    assert [child.name for child in switch.children if child.status is not Status.INVALID] == ["stand"]


def test_one_child_may_serve_several_phases_and_the_rest() -> None:
    away = KeepDistance()
    switch = RefereeSwitch("referee", {"their_free_kick": away, "stop": away, "halt": Stop()}, otherwise=away)
    assert len(switch.children) == 2
    alone = Alone(switch)
    for game in (STOP, free_kick(Team.YELLOW, SPOT), OPEN):
        assert alone.tick(frame(robot(), (0.3, 0.0), game=game)) is Status.RUNNING
        assert switch.current_child is away


def test_a_phase_without_a_child_fails_with_its_name_and_the_robot_stands() -> None:
    switch = RefereeSwitch("referee", {"play": KeepDistance()})
    alone = Alone(switch)
    assert alone.tick(frame(robot(), (0.3, 0.0), game=HALT)) is Status.FAILURE
    assert switch.feedback_message == "nothing to do in halt"
    assert (alone.command.vx, alone.command.vy, alone.command.omega) == (0.0, 0.0, 0.0)


def test_a_misspelt_phase_is_an_error_that_lists_the_phases() -> None:
    with pytest.raises(ValueError, match="'our_free kick' is no phase; there are halt, stop, our_kickoff"):
        RefereeSwitch("referee", {"our_free kick": Stop()})
