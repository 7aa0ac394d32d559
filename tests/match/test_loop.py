from __future__ import annotations

import os
import signal
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from py_trees.common import Status

from robobt.match import MatchLoop, MatchResult
from robobt.match.recording import load_recording, recorder
from robobt.match.referee.events import Decision, EventKind, RefereeEvent
from robobt.match.refereeing import RefereeFactory, own_referee
from robobt.match.scenario.scenario import Scenario, ScenarioError, scenario_from
from robobt.signals import ending
from robobt.world import Frame, RobotCommand, RobotId, Team
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, Stage
from robobt.worlds import sim_world
from tests.match.scripted import PlainWorld, data

BLUE_0, YELLOW_0 = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)


def robot(number: int = 0, x: float = -2.0, y: float = 0.0, **params: Any) -> dict[str, Any]:
    return {
        "number": number,
        "play": "scripted",
        "params": params,
        "start": {"position": [x, y], "heading": "towards goal"},
    }


def scenario(**changes: Any) -> Scenario:
    return scenario_from(data(**changes), "test.yaml")


def play(seed: int = 1, **changes: Any) -> MatchResult:
    return MatchLoop(scenario(**changes), seed, PlainWorld).play()


def test_a_robot_that_reaches_the_ball_and_kicks_it_scores():
    result = play()
    assert result.outcome == "goal_blue"
    assert (result.blue_score, result.yellow_score) == (1, 0)
    figures = result.robots["blue 0"]
    # 1.9 m at 1 m/s and up to a tenth less, then one tick until the ball has left.
    assert figures.go_to_ball == pytest.approx(1.9 / 0.95, rel=0.06)
    assert figures.shoot == pytest.approx(0.02)
    assert figures.total == pytest.approx(figures.go_to_ball + 0.02)
    assert (figures.kicks, figures.errors) == (1, 0)


def test_yellow_attacks_the_other_goal():
    result = play(robots={"yellow": [robot(kick=4.0)]})
    assert (result.outcome, result.yellow_score) == ("goal_yellow", 1)


def test_each_team_is_shown_the_field_from_its_own_side():
    both = scenario(robots={"blue": [robot()], "yellow": [robot()]}, ball={"position": [0.0, 1.0]})
    match = MatchLoop(both, 1, PlainWorld)
    match.tick()
    blue, yellow = [player.store for player in match.players]
    assert (blue.frame.team, yellow.frame.team) == (Team.BLUE, Team.YELLOW)
    assert (blue.me.x, yellow.me.x) == (-2.0, -2.0)
    assert (blue.frame.ball.y, yellow.frame.ball.y) == (1.0, -1.0)
    assert blue.frame.opponents[0].x == yellow.frame.opponents[0].x == 2.0


class PlacingReferee:
    """Puts the ball down at one place at every frame."""

    def update(self, _: Frame) -> Decision:
        return Decision(GameState(), place_ball=(1.0, 2.0))

    def close(self) -> None:
        pass


def test_robots_see_a_ball_where_the_referee_has_just_put_it():
    match = MatchLoop(scenario(), 1, sim_world, referee=lambda *_: PlacingReferee())
    with match:
        match.tick()
    assert match.players[0].store.frame.ball.position == (1.0, 2.0)


def test_team_mates_share_a_store_and_opponents_do_not():
    match = MatchLoop(
        scenario(robots={"blue": [robot(), robot(1, y=1.0)], "yellow": [robot()]}), 1, PlainWorld
    )
    first, second, other = [player.store.team for player in match.players]
    assert first is second
    assert first is not other


def test_every_tick_observes_and_acts_once():
    match = MatchLoop(scenario(), 1, PlainWorld)
    for _ in range(5):
        match.tick()
    assert isinstance(match.world, PlainWorld)
    assert [list(commands) for commands in match.world.acts] == [[BLUE_0]] * 5
    assert match.measures.ticks == 5


@pytest.mark.integration
@pytest.mark.parametrize(
    ("breaks", "said"),
    [
        ("raise", "Scripted: RuntimeError: broken on purpose"),
        ("nan", "Scripted: command is not finite"),
        ("huge", "Scripted: command is not made of numbers"),
        ("words", "Scripted: command is not made of numbers"),
        ("nothing", "Scripted: command is no RobotCommand: None"),
    ],
)
def test_a_tree_that_fails_stops_its_robot_and_nobody_else(breaks: str, said: str):
    broken = robot(1, y=1.0, breaks=breaks)
    match = MatchLoop(scenario(robots={"blue": [robot(kick=4.0), broken]}), 1, PlainWorld)
    while match.tick():
        pass
    result = match.result()
    assert result.outcome == "goal_blue"
    assert isinstance(match.world, PlainWorld)
    assert all(commands[RobotId(Team.BLUE, 1)] == RobotCommand() for commands in match.world.acts)
    figures = result.robots["blue 1"]
    assert figures.errors == len(match.world.acts)
    assert figures.first_error is not None
    assert said in figures.first_error
    assert figures.first_error.startswith("Scripted")
    assert result.robots["blue 0"].errors == 0


def test_a_robot_that_is_not_seen_is_not_ticked():
    class Blind(PlainWorld):
        def observe(self):
            frame = self.truth()
            frame.own = ()
            return frame

    result = MatchLoop(scenario(robots={"blue": [robot(breaks="raise")]}).lasting(0.2), 1, Blind).play()
    assert result.robots["blue 0"].errors == 0
    assert result.outcome == "time"


class TestEnds:
    def test_the_referee_counts_goals_and_restarts_until_the_score_limit(self):
        ends = {"time_limit": 60.0, "score_limit": 2}
        quick = {"kickoff_wait": 0.1, "stop_time": 0.1, "placement_delay": 0.1, "double_touch": False}
        result = play(
            robots={"blue": [robot(kick=4.0, x=-1.0)]},
            ball={"position": [0.0, 0.0]},
            ends=ends,
            referee={**quick, "opening": "force_start", "aimless_kick": False, "kick_timeout": 0.1},
        )
        assert (result.outcome, result.blue_score) == ("score", 2)
        assert 0.0 < result.in_play < 1.0

    def test_the_referee_ends_the_match(self):
        result = play(
            robots={"blue": [robot(speed=0.0)]},
            referee={
                "half_length": 0.5,
                "placement": "by_hand",
                "stop_time": 0.1,
                "stop_after_halt": 0.1,
                "kickoff_wait": 0.1,
                "kick_timeout": 0.1,
                "no_progress_time": 0.5,
            },
        )
        assert result.outcome == "full_time"


class TestRepeatability:
    RANDOM: ClassVar = {"ball": {"position": {"center": [0, 0], "radius": 1.0}}}

    def test_one_seed_is_one_match_bit_for_bit(self):
        first, second = (MatchLoop(scenario(**self.RANDOM), 7, sim_world).play() for _ in range(2))
        assert first.trace == second.trace
        assert {**first.to_json(), "wall_time": 0} == {**second.to_json(), "wall_time": 0}

    def test_the_trace_sees_the_worlds_random_numbers(self):
        assert play(1).trace != play(2).trace

    def test_a_recording_holds_every_tick_and_the_end(self, tmp_path: Path):
        path = tmp_path / "match.robobt.arrows"
        result = MatchLoop(scenario(), 7, PlainWorld, path, trial=3).play()
        recording = load_recording(path)
        assert recording.complete
        assert recording.header.trial == 3
        assert len(recording.times) == result.ticks
        assert [event.kind for event in recording.events] == ["kick", "goal"]


def test_kicks_are_those_the_simulator_reports():
    match = MatchLoop(scenario(robots={"blue": [robot(kick=1.5)]}), 1, sim_world)
    told, seen = [], []
    while match.tick():
        seen += match.measures.kicked
        told += match.world.kicks
    assert seen == told[: len(seen)]
    assert len(seen) == len(told) > 0


def _replaces(frame: Frame) -> None:
    frame.ball, frame.own, frame.opponents, frame.game = None, (), (), None  # type: ignore[assignment]


def _moves(frame: Frame) -> None:
    frame.ball.x += 1.0
    for robot in (*frame.own, *frame.opponents):
        robot.x, robot.heading, robot.id = robot.x + 1.0, 3.0, 7


def _deletes(frame: Frame) -> None:
    del frame.ball.x, frame.own, frame.opponents[0].vx


def _odd(frame: Frame) -> None:
    frame.ball.x = np.zeros(2)  # type: ignore[assignment]


def _forces(frame: Frame) -> None:
    """Change what refuses it, and belongs to the whole match."""
    for part in (frame.game, frame.game.yellow, frame.field, frame.ball_model, frame.own[0].limits):
        names = getattr(type(part), "__dataclass_fields__", None) or type(part).model_fields
        for name in names:
            object.__setattr__(part, name, "spoilt")
    frame.made.clear()


@pytest.mark.parametrize("spoil", [_replaces, _moves, _deletes, _odd, _forces])
@pytest.mark.parametrize("team", ["blue", "yellow"])
def test_a_skill_that_spoils_its_frame_spoils_nobody_elses(
    team: str, spoil: Callable[[Frame], None], caplog: pytest.LogCaptureFixture
) -> None:
    places = {"blue": -1.0, "yellow": 1.0}
    robots = {name: [robot(number=i, x=i / 2 - 2.0, y=y) for i in range(3)] for name, y in places.items()}
    plain, spoilt = [MatchLoop(scenario(robots=robots), 3, PlainWorld) for _ in range(2)]
    first = next(player for player in spoilt.players if player.robot == RobotId(Team(team), 0))
    decide = first.runner.tick

    def tick() -> Status:
        status = decide()
        spoil(first.store.frame)
        return status

    first.runner.tick = tick  # type: ignore[method-assign]
    for _ in range(3):
        plain.tick()
        spoilt.tick()
    assert spoilt.result().trace == plain.result().trace
    assert caplog.text.count(f"{team} 0: a skill of its tree changed the frame") == 1
    assert "a skill may only read the frame, and acts through self.store.command" in caplog.text


class ScriptedReferee:
    """Gives blue a goal at 0.1 s and ends the match at 0.2 s."""

    name = "scripted"

    def __init__(self) -> None:
        self.closed = 0

    def __call__(self, scenario: Scenario, field: FieldGeometry) -> ScriptedReferee:
        return self

    def update(self, frame: Frame) -> Decision:
        over = frame.time > 0.199
        stage = Stage.POST_GAME if over else Stage.NORMAL_FIRST_HALF
        scored = frame.time > 0.099
        return Decision(GameState(stage=stage, blue_score=int(scored)))

    def close(self) -> None:
        self.closed += 1


def test_another_referee_decides_instead_of_the_scenarios_own() -> None:
    referee = ScriptedReferee()
    result = MatchLoop(scenario(), 1, PlainWorld, referee=referee).play()
    assert (result.outcome, result.blue_score) == ("full_time", 1)
    assert referee.closed == 1


def test_the_referee_is_closed_when_a_match_breaks_off() -> None:
    referee = ScriptedReferee()
    with suppress(ZeroDivisionError), MatchLoop(scenario(), 1, PlainWorld, referee=referee) as match:
        match.tick()
        raise ZeroDivisionError
    assert referee.closed == 1


class Controlled(PlainWorld):
    """A world with a game controller, which reports a foul once."""

    @property
    def refereed(self) -> bool:
        return True

    def reported(self) -> list[RefereeEvent]:
        if self.ticks != 3:
            return []
        return [RefereeEvent(self.ticks * self.period, EventKind.BOT_CRASH_UNIQUE, Team.BLUE, BLUE_0)]


@pytest.mark.parametrize("referee", [own_referee, lambda scenario, field: ScriptedReferee()])
def test_a_referee_beside_a_game_controller_is_refused(referee: RefereeFactory) -> None:
    with pytest.raises(ScenarioError, match=r"test.yaml: referee: .* a game controller decides there; set"):
        MatchLoop(scenario(referee=True), 1, Controlled, referee=referee)


def test_what_the_worlds_own_referee_reports_is_counted_and_recorded(tmp_path: Path):
    path = tmp_path / "match.robobt.arrows"
    result = MatchLoop(scenario().lasting(0.3), 1, Controlled, path).play()
    assert (result.teams["blue"].fouls, result.teams["yellow"].fouls) == (1, 0)
    crashes = [event for event in load_recording(path).events if event.kind == "bot_crash_unique"]
    assert [(crash.team, crash.robot) for crash in crashes] == [(Team.BLUE, BLUE_0)]


def test_a_signal_while_the_recording_is_begun_leaves_a_complete_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, begun = tmp_path / "begun.robobt.arrows", recorder.new_stream

    def told(*given: Any) -> Any:
        os.kill(os.getpid(), signal.SIGINT)
        return begun(*given)

    monkeypatch.setattr(recorder, "new_stream", told)
    with ending(), pytest.raises(KeyboardInterrupt):
        MatchLoop(scenario(), 1, PlainWorld, path)
    assert path.read_bytes().endswith(b"\xff\xff\xff\xff\x00\x00\x00\x00")
    assert len(load_recording(path)) == 0
