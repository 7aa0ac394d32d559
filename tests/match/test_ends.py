"""When a trial is over, frame by frame; tests of the loop play whole trials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from robobt.match.ends import EndJudge, Outcome
from robobt.match.scenario.scenario import scenario_from
from robobt.world import (
    BALL_RADIUS,
    DIVISION_B,
    OPEN_PLAY,
    BallState,
    Frame,
    GameState,
    RefereeCommand,
    Restart,
    RobotId,
    RobotState,
    Stage,
    Team,
)
from robobt.world.rules import HELD_GAP
from tests.match.scripted import data

PERIOD = 0.02
EDGE = DIVISION_B.half_length + BALL_RADIUS
KEEPER = RobotId(Team.YELLOW, 0)
REACH = 0.09 + BALL_RADIUS + HELD_GAP


class Trial:
    """Frames by hand for the judge of a scenario; the ball stays where it was put last."""

    def __init__(self, ends: dict[str, Any] | None = None, **changes: Any) -> None:
        keeper = {**data()["robots"]["blue"][0], "goalkeeper": True}
        robots = {"blue": data()["robots"]["blue"], "yellow": [keeper]}
        ends = {"time_limit": 10.0, **(ends or {})}
        self.judge = EndJudge(scenario_from(data(robots=robots, ends=ends, **changes), "test.yaml"))
        self.time = 0.0
        self.keeper = RobotState(0, 4.0, 0.0)

    def see(
        self,
        x: float = 0.0,
        y: float = 0.0,
        *,
        speed: float = 0.0,
        game: GameState = OPEN_PLAY,
        kicks: int = 0,
        kicked: Sequence[RobotId] = (),
    ) -> Outcome | None:
        """Judge the next frame, the ball at (x, y)."""
        ball = BallState(x, y, speed, 0.0)
        truth = Frame(self.time, DIVISION_B, ball, (RobotState(0, -2.0, 0.0),), (self.keeper,), period=PERIOD)
        self.time += PERIOD
        return self.judge.judge(truth, game, kicks, kicked)

    def wait(self, seconds: float, x: float = 0.0, y: float = 0.0, kicks: int = 0) -> list[Outcome | None]:
        return [self.see(x, y, kicks=kicks) for _ in range(round(seconds / PERIOD))]


def test_without_a_referee_a_goal_ends_the_trial_and_is_counted() -> None:
    trial = Trial()
    assert trial.see(EDGE - 0.05) is None
    assert trial.see(EDGE + 0.05) is Outcome.GOAL_BLUE
    assert trial.judge.scores == {Team.BLUE: 1, Team.YELLOW: 0}


def test_the_crossing_decides_whether_it_is_a_goal() -> None:
    trial = Trial()
    trial.see(EDGE - 0.1, 0.4)
    # At the line it was still between the posts, which stand at 0.5 m.
    assert trial.see(EDGE + 0.1, 0.55) is Outcome.GOAL_BLUE
    trial = Trial()
    trial.see(EDGE - 0.1, 0.7)
    assert trial.see(EDGE + 0.1, 0.45) is Outcome.OUT


def test_a_goal_that_does_not_end_the_trial_is_counted_once() -> None:
    trial = Trial({"goal": False, "ball_out": False})
    trial.see(EDGE - 0.05)
    assert [trial.see(EDGE + 0.01 * tick) for tick in range(1, 5)] == [None] * 4
    assert trial.judge.scores[Team.BLUE] == 1
    trial.see(0.0)
    trial.see(-EDGE - 0.01)
    assert trial.judge.scores == {Team.BLUE: 1, Team.YELLOW: 1}


def test_a_ball_that_starts_outside_is_out_and_no_goal() -> None:
    trial = Trial()
    assert trial.see(EDGE + 0.05) is Outcome.OUT
    assert trial.judge.scores[Team.BLUE] == 0


def test_with_a_referee_its_score_counts_and_neither_goal_nor_line_ends_the_trial() -> None:
    trial = Trial(referee={})
    trial.see(EDGE - 0.05)
    assert trial.see(EDGE + 0.05) is None
    assert trial.judge.scores == {Team.BLUE: 0, Team.YELLOW: 0}
    assert trial.see(0.0, game=replace(OPEN_PLAY, yellow_score=1)) is None
    assert trial.judge.scores == {Team.BLUE: 0, Team.YELLOW: 1}


def test_the_score_limit_and_the_end_of_the_match() -> None:
    trial = Trial({"score_limit": 2}, referee={})
    assert trial.see(game=replace(OPEN_PLAY, blue_score=1)) is None
    assert trial.see(game=replace(OPEN_PLAY, blue_score=2)) is Outcome.SCORE
    assert Trial(referee={}).see(game=replace(OPEN_PLAY, stage=Stage.POST_GAME)) is Outcome.FULL_TIME


def test_a_goal_on_the_last_tick_is_a_goal() -> None:
    trial = Trial({"time_limit": PERIOD})
    trial.see(EDGE - 0.05)
    assert trial.see(EDGE + 0.05) is Outcome.GOAL_BLUE


@pytest.mark.parametrize("limit", [0.5, 0.501, 0.519])
def test_the_time_limit_ends_at_the_first_tick_that_reaches_it(limit: float) -> None:
    trial = Trial({"time_limit": limit})
    outcomes = trial.wait(0.54)
    assert outcomes[:-1].count(None) == (25 if limit == 0.5 else 26)
    assert outcomes[25 if limit == 0.5 else 26] is Outcome.TIME


def test_the_time_limit_is_one_of_the_frames_time_however_many_there_are() -> None:
    trial = Trial({"time_limit": 0.5})
    outcomes = []
    for _ in range(9):
        trial.time += 2 * PERIOD
        outcomes.append(trial.see())
    assert outcomes == [None] * 8 + [Outcome.TIME]


@pytest.mark.parametrize(("gap", "saved"), [(REACH - 0.001, True), (REACH + 0.001, False)])
def test_a_goalkeeper_holds_the_ball_on_any_side_of_its_hull(gap: float, saved: bool) -> None:
    trial = Trial({"held_by_goalkeeper": 0.1})
    outcomes = trial.wait(0.2, x=trial.keeper.x, y=gap)
    assert (Outcome.SAVED in outcomes) is saved
    assert outcomes[:5] == [None] * 5


def test_holding_counts_anew_when_the_goalkeeper_has_lost_the_ball() -> None:
    trial = Trial({"held_by_goalkeeper": 0.1})
    assert trial.wait(0.1, x=trial.keeper.x, y=REACH - 0.001) == [None] * 5
    assert trial.see(trial.keeper.x, REACH + 0.1) is None
    assert trial.wait(0.1, x=trial.keeper.x, y=REACH - 0.001) == [None] * 5


def test_a_goalkeepers_kick_is_a_save_where_saves_end_the_trial() -> None:
    assert Trial({"held_by_goalkeeper": 1.0}).see(kicked=[KEEPER]) is Outcome.SAVED
    assert Trial({"held_by_goalkeeper": 1.0}).see(kicked=[RobotId(Team.BLUE, 0)]) is None
    assert Trial().see(kicked=[KEEPER]) is None


def test_a_ball_at_rest_ends_the_trial_once_it_was_kicked() -> None:
    trial = Trial({"ball_at_rest": 0.1})
    assert trial.wait(0.5) == [None] * 25
    assert trial.see(speed=1.0, kicks=1) is None
    assert trial.wait(0.1, kicks=1) == [None] * 5
    assert trial.see(kicks=1) is Outcome.REST


@pytest.mark.parametrize(
    ("event", "outcome"),
    [("placement_succeeded", Outcome.PLACED), ("placement_failed", Outcome.NOT_PLACED)],
)
def test_a_drill_ends_with_its_ball_placement(event: str, outcome: Outcome) -> None:
    placing = GameState(
        RefereeCommand.BALL_PLACEMENT_BLUE, restart=Restart.BALL_PLACEMENT, restart_team=Team.BLUE
    )
    over = GameState(RefereeCommand.STOP, events=(event,))
    for ends, last in (({"placement": True}, outcome), ({}, None)):
        trial = Trial(ends, referee={})
        assert trial.see(game=placing) is None
        assert trial.see(game=over) is last


def test_a_drill_of_placements_needs_a_referee() -> None:
    with pytest.raises(ValueError, match=r"ends\.placement.*referee"):
        Trial({"placement": True})
