"""A match under a controller: set up, played and brought to its end by nobody's click."""

from __future__ import annotations

import os
import pickle
from collections.abc import Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from robobt.league.referee.official import OfficialReferee, OfficialRefereeFactory
from robobt.league.referee.process import GameControllerError
from robobt.league.referee.setup import ORIGIN, MatchSetup, command
from robobt.league.wire.messages import CiInput, CiOutput, Message
from robobt.match import MatchLoop, load_scenario, run_trials_in
from robobt.match.recording import load_recording
from robobt.match.referee.events import EventKind
from robobt.match.referee.settings import RefereeSettings
from robobt.match.scenario.scenario import scenario_from
from robobt.world.field import DIVISION_A, DIVISION_B, FieldGeometry
from robobt.world.game import RefereeCommand, Stage, Team
from robobt.world.state import BallState, Frame, RobotId, RobotState
from robobt.worlds import sim_world
from tests.league.mutations import mutations
from tests.league.referee.conftest import Connect
from tests.league.referee.fake_controller import FakeController
from tests.match.scripted import PlainWorld, data

pytestmark = pytest.mark.integration

OFFICIAL = os.environ.get("ROBOBT_GAME_CONTROLLER", "")

SIX = {Team.BLUE: 6, Team.YELLOW: 6}
BLUE_1, YELLOW_2 = RobotId(Team.BLUE, 1), RobotId(Team.YELLOW, 2)
PERIOD = 0.025


class Started:
    """A started controller, as far as a referee sees it."""

    def __init__(self, stream: object) -> None:
        self.stream = stream
        self.closed = 0

    def crash(self) -> str:
        return ""

    def close(self) -> None:
        self.closed += 1


class Played:
    """A referee with a fake controller, and a ball that is moved by hand."""

    def __init__(self, connect: Connect, field: FieldGeometry = DIVISION_B, **settings: Any) -> None:
        self.fake = FakeController(settings.get("half_length", 300.0))
        self.given: Mapping[str, object] = {}
        setup = MatchSetup(field, RefereeSettings(**settings), SIX)
        self.started = Started(connect(self.fake.handle)._stream)

        def start(given: Mapping[str, object]) -> Any:
            self.given = given
            return self.started

        self.field = field
        self.referee = OfficialReferee(setup, start)
        self.time = 0.0
        self.ball = BallState(0.0, 0.0)
        self.touched: RobotId | None = None
        self.events: list[Any] = []
        self.placed: list[tuple[float, float]] = []

    def play(self, seconds: float) -> RefereeCommand:
        own = (RobotState(1, -2.0, 1.0),)
        opponents = (RobotState(2, 2.0, -1.0),)
        for _ in range(round(seconds / PERIOD)):
            frame = Frame(
                self.time, self.field, self.ball, own, opponents, period=PERIOD, last_touch=self.touched
            )
            decision = self.referee.update(frame)
            self.game = decision.game
            self.events += decision.events
            if decision.place_ball is not None:
                self.placed.append(decision.place_ball)
                self.ball = BallState(*decision.place_ball)
            self.time += PERIOD
        return self.game.command

    def until(self, wanted: RefereeCommand, within: float = 30.0) -> None:
        end = self.time + within
        while self.play(PERIOD) is not wanted:
            assert self.time < end, f"{wanted.name} does not come; it is {self.game.command.name}"

    def kick_off(self) -> None:
        self.until(RefereeCommand.NORMAL_START)
        self.touched, self.ball = BLUE_1, BallState(0.2, 0.0)
        self.play(PERIOD)
        assert self.game.in_play


def test_a_match_begins_by_itself(connect: Connect) -> None:
    played = Played(connect)
    assert played.play(PERIOD) is RefereeCommand.STOP
    # Ten seconds from HALT to the kick-off, two to its start, a tenth each to be told.
    played.until(RefereeCommand.PREPARE_KICKOFF_BLUE, 10.3)
    played.until(RefereeCommand.NORMAL_START, 2.4)
    assert played.game.stage is Stage.NORMAL_FIRST_HALF
    assert played.game.restart_team is Team.BLUE


@pytest.mark.parametrize(("field", "division", "robots"), [(DIVISION_B, 2, 6), (DIVISION_A, 1, 11)])
def test_the_match_is_set_up_as_the_scenario_has_it(
    connect: Connect, field: FieldGeometry, division: int, robots: int
) -> None:
    played = Played(connect, field, half_length=120.0, blue_keeper=3, yellow_keeper=1, no_progress_time=7.0)
    played.play(PERIOD)
    changes = [it.change for sent in played.fake.inputs for it in sent.api_inputs]
    config = next(it.update_config_change for it in changes if it.HasField("update_config_change"))
    assert (config.division, config.first_kickoff_team) == (division, 2)
    assert config.max_robots_per_team.value == robots
    # Without a type of match nothing goes on after a HALT.
    assert config.match_type != 0
    teams = {
        it.update_team_state_change.team_name.value: it.update_team_state_change
        for it in changes
        if it.HasField("update_team_state_change")
    }
    assert {name: team.goalkeeper.value for name, team in teams.items()} == {"blue": 3, "yellow": 1}
    assert not teams["blue"].on_positive_half.value
    assert teams["yellow"].on_positive_half.value
    assert all(team.can_place_ball.value for team in teams.values())
    delta = next(it.config_delta for sent in played.fake.inputs for it in sent.api_inputs)
    assert delta.auto_continue
    assert set(delta.auto_ref_configs[ORIGIN].game_event_behavior.values()) == {1}
    sizes = [sent.geometry.field for sent in played.fake.inputs if sent.HasField("geometry")]
    assert [size.field_length for size in sizes] == [round(field.length * 1000)]
    assert played.given["auto-approve-goals"]
    assert played.given["normal"] == {"half-duration": "120.000s"}
    assert played.given["no-progress-timeout"] == {"DIV_A": "7.000s", "DIV_B": "7.000s"}
    # By the rules: the controller knows them.
    assert "free-kick-timeout" not in played.given


@pytest.mark.parametrize(
    ("opening", "sent"),
    [
        ("force_start", ["new_command_change"]),
        ("kickoff", ["new_command_change"]),
        ("shoot_out", ["change_stage_change", "new_command_change"]),
        ("penalty", ["change_stage_change", "new_command_change", "add_game_event_change"]),
        ("free_kick", ["change_stage_change", "new_command_change", "add_game_event_change"]),
        (
            "ball_placement",
            ["change_stage_change", "new_command_change", "add_game_event_change", "new_command_change"],
        ),
    ],
)
def test_a_drill_begins_with_its_restart(connect: Connect, opening: str, sent: list[str]) -> None:
    played = Played(connect, opening=opening, opening_team="yellow", opening_spot=(1.0, -1.0))
    played.play(PERIOD)
    changes = [it.change for given in played.fake.inputs for it in given.api_inputs]
    kinds = [change.WhichOneof("change") for change in changes]
    # After config and teams, without the marks that say that a change is done.
    assert [kind for kind in kinds if kind not in (None, "set_status_message_change")][3:] == sent
    events = [it.add_game_event_change.game_event for it in changes if it.HasField("add_game_event_change")]
    for event in events:
        # At once: it is not for an automatic referee to say.
        assert list(event.origin) == ["UI"]
    if opening == "free_kick":
        (event,) = events
        assert event.attacker_double_touched_ball.by_team == 2
        assert event.attacker_double_touched_ball.location.x == 1.0


def test_a_goal_counts_the_ball_is_carried_back_and_the_other_team_kicks_off(connect: Connect) -> None:
    played = Played(connect)
    played.kick_off()
    played.ball = BallState(4.7, 0.1)
    played.until(RefereeCommand.HALT, 1.5)
    assert (played.game.blue_score, played.game.yellow_score) == (1, 0)
    assert [event.kind for event in played.events] == [EventKind.POSSIBLE_GOAL, EventKind.GOAL]
    assert played.events[1].details["message"] == "Valid and auto approved"
    assert played.events[0].robot == BLUE_1
    played.until(RefereeCommand.STOP, 2.2)
    assert played.placed == [(0.0, 0.0)]
    played.until(RefereeCommand.PREPARE_KICKOFF_YELLOW, 10.3)


def test_a_report_reaches_the_controller_in_the_frame_in_which_it_is_seen(connect: Connect) -> None:
    played = Played(connect)
    played.kick_off()
    played.play(1.0)
    played.ball = BallState(1.0, 3.2)
    before = played.time
    played.play(PERIOD)
    events = [
        it.change.add_game_event_change.game_event
        for sent in played.fake.inputs
        for it in sent.api_inputs
        if it.change.HasField("add_game_event_change")
    ]
    (event,) = events
    assert list(event.origin) == [ORIGIN]
    assert event.created_timestamp / 1e6 - 1_700_000_000 == pytest.approx(before, abs=1e-3)
    assert event.ball_left_field_touch_line.by_bot == 1
    assert [it for it in played.events if it.kind is EventKind.BALL_LEFT_FIELD_TOUCH_LINE] == []
    played.until(RefereeCommand.STOP, 1.2)
    assert played.game.upcoming is RefereeCommand.DIRECT_FREE_YELLOW


def test_the_halves_follow_each_other_and_the_match_ends(connect: Connect) -> None:
    played = Played(connect, half_length=20.0)
    stages = []
    for side in (1.0, -1.0):
        played.kick_off() if side > 0 else played.until(RefereeCommand.NORMAL_START, 40.0)
        stages.append(played.game.stage)
        played.ball = BallState(0.3, 0.0)
        played.play(20.5)
        # Play goes on until the ball is out.
        assert played.game.in_play
        played.ball = BallState(1.0, 3.2 * side)
        played.play(1.5)
        stages.append(played.game.stage)
    assert stages == [
        Stage.NORMAL_FIRST_HALF,
        Stage.NORMAL_HALF_TIME,
        Stage.NORMAL_SECOND_HALF,
        Stage.POST_GAME,
    ]


def test_somebody_at_its_screen_may_change_the_match(connect: Connect) -> None:
    played = Played(connect)
    played.kick_off()
    played.referee.tell(command("HALT"))
    assert played.play(2 * PERIOD) is RefereeCommand.HALT


def test_robots_that_were_taken_off_are_not_shown_to_it(connect: Connect) -> None:
    played = Played(connect)
    played.fake.state.blue.max_allowed_bots = 1
    played.play(1.0)
    own = (RobotState(1, -2.0, 1.0), RobotState(4, 0.2, 3.15))
    for tick in range(5):
        played.referee.update(Frame(played.time + tick * PERIOD, DIVISION_B, played.ball, own))
    shown = [it for it in played.fake.inputs if it.HasField("tracker_packet")][-1]
    assert [robot.robot_id.id for robot in shown.tracker_packet.tracked_frame.robots] == [1]


def test_the_controller_ends_with_the_match(connect: Connect) -> None:
    played = Played(connect)
    played.play(PERIOD)
    played.referee.close()
    played.referee.close()
    assert played.started.closed == 1


def test_matches_are_played_recorded_and_repeated_under_it(program: Path, tmp_path: Path) -> None:
    scenario = scenario_from(data(referee=True, ends={"time_limit": 13.0}), "test.yaml")
    factory: OfficialRefereeFactory = pickle.loads(pickle.dumps(OfficialRefereeFactory(program)))
    record = {0: tmp_path / "match.robobt.arrows"}
    first = run_trials_in(scenario, PlainWorld, 1, record=record, referee=factory)
    again = run_trials_in(scenario, PlainWorld, 1, referee=factory)
    assert first.results[0].trace == again.results[0].trace
    assert [game.command for _, game in load_recording(record[0]).games][:3] == [
        RefereeCommand.STOP,
        RefereeCommand.PREPARE_KICKOFF_BLUE,
        RefereeCommand.NORMAL_START,
    ]


@pytest.mark.slow
@pytest.mark.skipif(not OFFICIAL, reason="ROBOBT_GAME_CONTROLLER does not name the official program")
def test_two_halves_are_played_to_the_end_under_the_official_one() -> None:
    scenario = load_scenario("six_v_six").lasting(1200.0)
    settings = (scenario.referee or RefereeSettings()).model_copy(update={"half_length": 60.0})
    scenario = scenario.model_copy(update={"referee": settings})
    factory = OfficialRefereeFactory(Path(OFFICIAL))
    traces = []
    for _ in range(2):
        result = MatchLoop(scenario, 1, sim_world, referee=factory).play()
        assert result.outcome == "full_time"
        traces.append(result.trace)
    assert traces[0] == traces[1]


class Scripted:
    """A stream whose other side answers each time with the next of these bytes, and changes as it should."""

    def __init__(self, answers: Any) -> None:
        self._answers, self._asked = answers, 0
        self._changed: list[bytes] = []
        self._state = FakeController().state

    def send(self, message: bytes) -> None:
        sent = CiInput.FromString(message)
        self._asked += sent.HasField("timestamp")
        for given in sent.api_inputs:
            self._state.status_message = given.change.set_status_message_change.status_message
            self._changed.append(CiOutput(referee_msg=self._state).SerializeToString())

    def receive(self, wait: float) -> bytes | None:
        if self._asked:
            self._asked -= 1
            data: bytes = next(self._answers)
            return data
        return self._changed.pop(0) if self._changed else None


def test_ten_thousand_mutated_messages_are_followed_or_one_clear_error() -> None:
    seeds: list[Message] = []
    fake = FakeController()
    for time in range(40):
        sent = CiInput(timestamp=time * 10**9 + 1)
        if time == 20:
            report = sent.api_inputs.add().change.add_game_event_change.game_event
            report.type = 39
            report.possible_goal.by_team = 2
        if time in (1, 30):
            sent.api_inputs.add().change.CopyFrom(command("STOP"))
        seeds += [CiOutput(referee_msg=answer) for answer in fake.handle(sent)]
    answers = islice(mutations(seeds, 0), 10_000)
    setup = MatchSetup(DIVISION_B, RefereeSettings(), SIX)
    robots = tuple(RobotState(number, number - 3.0, 1.0) for number in range(6))
    problems: list[str] = []
    followed = 0
    referee, time = None, 0.0
    while True:
        if referee is None:
            referee = OfficialReferee(setup, lambda _: Started(Scripted(answers)))  # type: ignore[arg-type, return-value]
            referee._set_up = lambda *_: []  # type: ignore[method-assign]
            referee._people.clicks = lambda *_: []  # type: ignore[method-assign]
            referee._automatic.watch = lambda *_: []  # type: ignore[method-assign]
        time += 0.3
        try:
            referee.update(Frame(time, DIVISION_B, BallState(1.0, 1.0), robots, robots))
            followed += 1
        except GameControllerError as error:
            problems.append(str(error))
            referee = None
        except StopIteration:
            break
    assert followed > 1000
    assert len(problems) > 1000
    assert all(problem.isprintable() and "game controller" in problem for problem in problems)
