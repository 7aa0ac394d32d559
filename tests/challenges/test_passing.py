"""The passing challenge's referee: a ball that leaves is a kick-off for the others."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.passing import OPPONENT, Passing, PassingReferee, passing_referee
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.state import BallState, Frame, RobotId, RobotState

BLUE, YELLOW = Team.BLUE, Team.YELLOW


def referee(stage: Stage = Stage.NORMAL_FIRST_HALF) -> PassingReferee:
    found = PassingReferee(DIVISION_B, RefereeSettings(opening="force_start", opening_team=YELLOW))
    found.update(Frame(0.0, DIVISION_B, BallState(0.0, 0.0)))
    assert found.controller is not None
    found.controller.state.stages.stage = stage
    return found


@pytest.mark.parametrize("kind", ["ball_left_field_touch_line", "ball_left_field_goal_line"])
@pytest.mark.parametrize("team", [BLUE, YELLOW])
def test_a_ball_that_left_is_a_kick_off_for_the_team_that_did_not_touch_it_last(
    kind: str, team: Team
) -> None:
    after = referee().resumption_after(RefereeEvent(1.0, EventKind(kind), team), (0.0, 0.0))
    assert after is not None
    assert (after.restart, after.team, after.spot) == (Restart.KICKOFF, team.other, (0.0, 0.0))


@pytest.mark.parametrize(
    ("stage", "team"), [(Stage.NORMAL_FIRST_HALF, YELLOW), (Stage.NORMAL_SECOND_HALF, BLUE)]
)
def test_without_progress_the_team_that_began_the_half_kicks_off(stage: Stage, team: Team) -> None:
    after = referee(stage).resumption_after(RefereeEvent(1.0, EventKind.NO_PROGRESS_IN_GAME), (1.0, 1.0))
    assert after is not None
    assert (after.restart, after.team) == (Restart.KICKOFF, team)


def test_a_foul_is_still_a_free_kick() -> None:
    after = referee().resumption_after(
        RefereeEvent(1.0, EventKind.BOT_DRIBBLED_BALL_TOO_FAR, BLUE), (1.0, 1.0)
    )
    assert after is not None
    assert (after.restart, after.team) == (Restart.FREE_KICK, YELLOW)


def test_a_goal_is_a_ball_that_left() -> None:
    judge = referee()
    scorer = RobotId(BLUE, 0)
    for step, x in enumerate((4.3, 4.4, 4.5, 4.6), 1):
        frame = Frame(
            step / 60,
            DIVISION_B,
            BallState(x, 0.0, 6.0),
            (RobotState(0, 3.0, 0.0),),
            (RobotState(0, -3.0, 0.0),),
            last_touch=scorer,
        )
        decision = judge.update(frame)
    assert [event.kind for event in decision.events] == [EventKind.BALL_LEFT_FIELD_GOAL_LINE]
    assert (decision.game.blue_score, decision.game.yellow_score) == (0, 0)
    assert decision.game.upcoming is RefereeCommand.PREPARE_KICKOFF_YELLOW


def test_the_match_is_four_against_four_and_yellow_begins() -> None:
    (attempt,) = Passing().attempts(np.random.default_rng(0))
    scenario = attempt.scenario
    assert [len(scenario.robots.of(team)) for team in Team] == [4, 4]
    assert {robot.play for robot in scenario.robots.of(YELLOW)} == {OPPONENT}
    assert attempt.referee is passing_referee
    settings = scenario.referee
    assert settings is not None
    assert (settings.half_length, settings.opening_team, settings.no_progress_time) == (120.0, YELLOW, 10.0)
    assert not settings.defense_areas


def test_before_the_first_pass_all_figures_are_zero() -> None:
    (attempt,) = Passing().attempts(np.random.default_rng(0))
    judge = attempt.judge()
    assert judge.see(Frame(0.0, DIVISION_B, BallState(0.0, 0.0)), GameState()) is False
    figures = Passing().score([judge.figures()])
    assert dict(figures) == {"passes": 0, "opponent's": 0, "difference": 0}
    assert next(iter(figures)) == "passes"
