"""The game controller's commands become game states, and ours become its messages."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf, nan

import pytest

from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.messages import Referee
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team, TeamStatus
from robobt.world.state import BallState, Frame, RobotId


class Controller:
    """A game controller in miniature."""

    def __init__(self) -> None:
        self.follower = RefereeFollower()
        self.message = Referee(
            packet_timestamp=1, stage="NORMAL_FIRST_HALF", command="HALT", command_counter=0
        )
        self.message.command_timestamp = 0
        for info in (self.message.yellow, self.message.blue):
            info.name = "team"
            info.score = info.red_cards = info.yellow_cards = info.timeouts = info.timeout_time = 0
            info.goalkeeper = 0

    def say(
        self, command: str, upcoming: str | None = None, at: tuple[float, float] | None = None
    ) -> GameState:
        self.message.command = Referee.Command.Value(command)
        self.message.command_counter += 1
        self.message.ClearField("next_command")
        self.message.ClearField("designated_position")
        if upcoming is not None:
            self.message.next_command = Referee.Command.Value(upcoming)
        if at is not None:
            self.message.designated_position.x, self.message.designated_position.y = at
        return self.repeat()

    def repeat(self) -> GameState:
        assert self.follower.read(self.message.SerializeToString())
        return self.follower.game

    def ball(self, x: float, y: float, time: float) -> GameState:
        return self.follower.watch(Frame(time, DIVISION_B, BallState(x, y)))


@pytest.fixture
def controller() -> Controller:
    return Controller()


def test_nothing_moves_before_the_first_packet() -> None:
    assert RefereeFollower().game.halted


def test_halt_and_timeouts_stop_everybody(controller: Controller) -> None:
    for command in ("HALT", "TIMEOUT_BLUE", "TIMEOUT_YELLOW"):
        assert controller.say(command).halted


def test_a_stop_tells_what_comes_next_and_where(controller: Controller) -> None:
    game = controller.say("STOP", "DIRECT_FREE_YELLOW", (1500.0, -2000.0))
    assert game.stopped
    assert not game.may_touch
    assert (game.restart, game.restart_team) == (Restart.FREE_KICK, Team.YELLOW)
    assert game.placement == (1.5, -2.0)


def test_a_kickoff_is_prepared_then_allowed_then_over_when_the_ball_has_moved(controller: Controller) -> None:
    controller.say("STOP", "PREPARE_KICKOFF_BLUE")
    prepared = controller.say("PREPARE_KICKOFF_BLUE")
    assert (prepared.restart, prepared.restart_team, prepared.may_touch) == (
        Restart.KICKOFF,
        Team.BLUE,
        False,
    )
    assert prepared.placement == (0.0, 0.0)
    controller.say("NORMAL_START")
    assert controller.ball(0.0, 0.0, 1.0).may_touch
    assert not controller.ball(0.04, 0.0, 1.5).in_play
    assert controller.ball(0.06, 0.0, 2.0).in_play


def test_a_restart_that_nobody_takes_is_over_after_ten_seconds(controller: Controller) -> None:
    controller.say("DIRECT_FREE_BLUE")
    game = controller.ball(1.0, 1.0, 5.0)
    assert (game.restart, game.may_touch, game.placement) == (Restart.FREE_KICK, True, (1.0, 1.0))
    assert not controller.ball(1.0, 1.0, 14.9).in_play
    assert controller.ball(1.0, 1.0, 15.1).in_play


def test_a_penalty_kick_waits_for_its_normal_start(controller: Controller) -> None:
    assert not controller.say("PREPARE_PENALTY_YELLOW").may_touch
    game = controller.say("NORMAL_START")
    assert (game.restart, game.restart_team, game.may_touch) == (Restart.PENALTY, Team.YELLOW, True)


def test_ball_placement_names_the_team_and_the_place(controller: Controller) -> None:
    game = controller.say("BALL_PLACEMENT_BLUE", "DIRECT_FREE_BLUE", (-3000.0, 250.0))
    assert (game.restart, game.restart_team, game.placement) == (
        Restart.BALL_PLACEMENT,
        Team.BLUE,
        (-3.0, 0.25),
    )


def test_force_start_frees_the_ball(controller: Controller) -> None:
    controller.say("STOP", "PREPARE_KICKOFF_BLUE")
    game = controller.say("FORCE_START")
    assert game.in_play
    assert game.placement is None


def test_repeated_packets_change_nothing_about_a_restart(controller: Controller) -> None:
    controller.say("DIRECT_FREE_BLUE")
    controller.ball(1.0, 1.0, 5.0)
    assert controller.ball(1.2, 1.0, 6.0).in_play
    assert controller.repeat().in_play


def test_score_and_stage_are_followed(controller: Controller) -> None:
    controller.message.blue.score = 3
    controller.message.stage = Referee.Stage.Value("PENALTY_SHOOTOUT")
    game = controller.repeat()
    assert (game.blue_score, game.yellow_score, game.stage) == (3, 0, Stage.PENALTY_SHOOTOUT)


def test_outdated_commands_of_old_logs_are_understood(controller: Controller) -> None:
    assert controller.say("INDIRECT_FREE_YELLOW").command is RefereeCommand.DIRECT_FREE_YELLOW
    assert controller.say("GOAL_BLUE").stopped


def test_a_goal_is_told_once_and_the_halt_goes_on(controller: Controller) -> None:
    controller.say("HALT")
    controller.say("GOAL_BLUE")
    # The next message has the command in force again, and the goal's number.
    controller.message.command = Referee.Command.Value("HALT")
    assert controller.repeat().halted


def test_what_happens_in_a_stop_may_change_what_follows(controller: Controller) -> None:
    controller.say("STOP", "DIRECT_FREE_YELLOW", (1500.0, -2000.0))
    controller.message.next_command = Referee.Command.Value("PREPARE_PENALTY_BLUE")
    game = controller.repeat()
    assert (game.restart, game.restart_team) == (Restart.PENALTY, Team.BLUE)
    assert game.upcoming is RefereeCommand.PREPARE_PENALTY_BLUE


def test_a_penalty_lasts_from_its_preparation_to_the_next_command(controller: Controller) -> None:
    assert controller.say("STOP", "PREPARE_PENALTY_BLUE").penalty is None
    assert controller.say("PREPARE_PENALTY_BLUE").penalty is Team.BLUE
    controller.say("NORMAL_START")
    controller.ball(1.5, 0.0, 1.0)
    game = controller.ball(1.6, 0.0, 1.1)
    assert (game.restart, game.penalty) == (None, Team.BLUE)
    assert controller.say("STOP").penalty is None


def test_a_restart_is_over_when_the_controllers_time_for_it_is(controller: Controller) -> None:
    controller.say("DIRECT_FREE_BLUE")
    controller.message.current_action_time_remaining = 100_000
    controller.repeat()
    # Division A gives five seconds, and an opponent too near starts them anew.
    assert not controller.ball(1.0, 1.0, 5.0).in_play
    assert not controller.ball(1.0, 1.0, 15.1).in_play
    controller.message.current_action_time_remaining = -1
    controller.repeat()
    assert controller.ball(1.0, 1.0, 15.2).in_play


@pytest.mark.parametrize("place", [(nan, 0.0), (0.0, inf), (50_000.0, 0.0), (1e38, -1e38)])
@pytest.mark.parametrize("command", ["HALT", "FORCE_START"])
def test_a_place_on_no_field_is_left_out_and_told_once(
    controller: Controller, caplog: pytest.LogCaptureFixture, command: str, place: tuple[float, float]
) -> None:
    controller.say("BALL_PLACEMENT_BLUE", at=(1000.0, 0.0))
    controller.message.blue.score = 3
    game = controller.say(command, at=place)
    for _ in range(50):
        controller.repeat()
    assert (game.command, game.placement, game.blue_score) == (RefereeCommand[command], None, 3)
    assert controller.follower.counts.implausible == 51
    assert caplog.messages == [
        "the game controller's field designated_position is missing or invalid; it is ignored and "
        "the rest of the message is obeyed"
    ]


def test_what_a_message_lacks_keeps_its_last_value(
    controller: Controller, caplog: pytest.LogCaptureFixture
) -> None:
    message = controller.message
    message.blue.score, message.blue.goalkeeper = 2, 5
    controller.say("FORCE_START")
    for name in ("stage", "packet_timestamp", "command_timestamp", "blue"):
        message.ClearField(name)
    message.yellow.ClearField("score")
    message.yellow.goalkeeper, message.yellow.red_cards = 4_000_000_000, 2**32 - 1
    message.yellow.max_allowed_bots = 77
    message.stage_time_left, message.current_action_time_remaining = 2**62, -(2**62)
    message.command_counter += 1
    message.command = Referee.HALT
    for _ in range(3):
        assert controller.follower.read(message.SerializePartialToString())
    game = controller.follower.game
    assert game.halted
    assert (game.stage, game.blue_score, game.yellow_score) == (Stage.NORMAL_FIRST_HALF, 2, 0)
    assert (game.blue.keeper, game.yellow.keeper, game.yellow.red_cards) == (5, 0, 0)
    assert (game.yellow.max_robots, game.stage_time, game.action_time) == (None, None, None)
    assert len(caplog.messages) == len(set(caplog.messages)) == 10


def test_a_command_that_nobody_knows_halts(controller: Controller, caplog: pytest.LogCaptureFixture) -> None:
    controller.say("FORCE_START")
    controller.message.ClearField("command")
    unknown = controller.message.SerializePartialToString() + b"\x20\x4d"
    assert controller.follower.read(unknown)
    assert controller.follower.game.halted
    (told,) = caplog.messages
    assert "command" in told


@pytest.mark.parametrize("command", ["HALT", "STOP", "TIMEOUT_BLUE"])
@pytest.mark.parametrize(
    "broken",
    [
        lambda data: data[:-9],
        lambda data: data + b"\xff\xff",
        # The team's length reaches beyond the packet.
        lambda data: data.replace(b"\x3a\x12", b"\x3a\x7f"),
        # The stage swallows what follows: its number goes on.
        lambda data: data.replace(b"\x10\x01", b"\x10\x81", 1),
        lambda data: b"\x0b" * 20 + data,
        # A later command, as of a field whose number was spoilt.
        lambda data: data + b"\x20\x02",
        lambda data: data.replace(b"team", b"\xff\xfe\xc0\x80"),
        # Fields in another order, with an event of an unknown kind that lacks what it has to hold.
        lambda data: b"\x82\x01\x03\xc0\x02\x63" * 300 + data,
        lambda data: data + b"\xa2\x01\xc0\xb8\x02" + b"x" * 40_000,
    ],
    ids=["cut", "longer", "length", "number", "groups", "contradiction", "no text", "events", "long"],
)
def test_a_message_that_is_broken_around_it_still_stops_the_robots(
    controller: Controller, command: str, broken: Callable[[bytes], bytes]
) -> None:
    controller.say("FORCE_START")
    controller.message.command = Referee.Command.Value(command)
    controller.message.command_counter += 1
    assert controller.follower.read(broken(controller.message.SerializeToString()))
    assert controller.follower.game.command is RefereeCommand[command]


def test_a_message_that_cannot_be_decoded_starts_nothing(controller: Controller) -> None:
    controller.say("HALT")
    controller.message.command = Referee.FORCE_START
    controller.message.command_counter += 1
    assert not controller.follower.read(controller.message.SerializeToString() + b"\xff\xff")
    assert controller.follower.game.halted


def test_noise_is_counted(controller: Controller) -> None:
    assert not controller.follower.read(b"\xff\xff")
    assert not controller.follower.read(b"")
    assert controller.follower.counts.dropped == 2


STOPPED = GameState(
    RefereeCommand.STOP,
    Stage.NORMAL_FIRST_HALF,
    blue_score=2,
    yellow_score=1,
    restart=Restart.FREE_KICK,
    restart_team=Team.BLUE,
    may_touch=False,
    placement=(1.0, -2.0),
    upcoming=RefereeCommand.DIRECT_FREE_BLUE,
    blue=TeamStatus(keeper=5, max_robots=4, yellow_cards=1, red_cards=1, can_place_ball=False),
    yellow=TeamStatus(keeper=2, max_robots=6, substituting=True),
    events=("ball_left_field_touch_line", "multiple_fouls"),
    action_time=2.5,
    stage_time=-1.25,
)


def test_what_is_published_is_followed_to_the_same_state() -> None:
    publisher, follower = RefereePublisher(), RefereeFollower()
    assert follower.read(publisher.write(STOPPED, 1.0))
    assert follower.game == STOPPED
    assert (follower.game.action_time, follower.game.stage_time) == (2.5, -1.25)
    kick = replace(STOPPED, command=RefereeCommand.DIRECT_FREE_BLUE, may_touch=True, upcoming=None)
    assert follower.read(publisher.write(kick, 2.0))
    assert follower.game == kick


def test_the_counter_grows_with_each_command_and_only_then() -> None:
    publisher = RefereePublisher()
    first = Referee.FromString(publisher.write(STOPPED, 1.0))
    again = Referee.FromString(publisher.write(STOPPED, 1.5))
    halt = Referee.FromString(publisher.write(replace(STOPPED, command=RefereeCommand.HALT), 2.0))
    assert [m.command_counter for m in (first, again, halt)] == [0, 0, 1]
    assert [m.command_timestamp for m in (first, again, halt)] == [1_000_000, 1_000_000, 2_000_000]
    assert (first.blue.goalkeeper, first.yellow.score) == (5, 1)
    assert Referee.Command.Name(first.next_command) == "DIRECT_FREE_BLUE"


def test_cards_keeper_times_and_events_are_known(controller: Controller) -> None:
    message = controller.message
    message.yellow.goalkeeper, message.yellow.max_allowed_bots = 4, 5
    message.yellow.red_cards, message.yellow.yellow_cards = 0, 3
    message.yellow.yellow_card_times.append(80_000_000)
    message.yellow.can_place_ball = False
    message.stage_time_left, message.current_action_time_remaining = -1_500_000, 7_250_000
    message.game_events.add().type = 6
    game = controller.say("STOP")
    assert game.status(Team.YELLOW) == TeamStatus(4, 5, 1, 0, can_place_ball=False)
    assert game.status(Team.BLUE) == TeamStatus(0, None, 0, 0, can_place_ball=True)
    assert (game.stage_time, game.action_time) == (-1.5, 7.25)
    assert game.events == ("ball_left_field_touch_line",)


def test_the_clock_alone_makes_no_new_state(controller: Controller) -> None:
    game = controller.say("STOP")
    controller.message.stage_time_left = 1_000_000
    assert controller.repeat() == game


def test_of_two_controllers_the_first_is_followed_and_the_other_reported_once(
    controller: Controller, caplog: pytest.LogCaptureFixture
) -> None:
    first, second = ("127.0.0.1", 1000), ("127.0.0.1", 2000)
    follower, message = controller.follower, controller.message
    for time in range(5):
        message.command = Referee.Command.HALT
        assert follower.read(message.SerializeToString(), first, time / 10)
        message.command = Referee.Command.FORCE_START
        message.command_counter = 7
        assert not follower.read(message.SerializeToString(), second, time / 10)
        message.command_counter = 0
    assert follower.game.halted
    assert follower.counts.foreign == 5
    assert len([record for record in caplog.records if "two game controllers" in record.message]) == 1


def test_a_controller_that_was_started_again_is_followed(controller: Controller) -> None:
    follower, data = controller.follower, controller.message.SerializeToString()
    assert follower.read(data, ("127.0.0.1", 1000), 0.0)
    assert not follower.read(data, ("127.0.0.1", 2000), 1.0)
    assert follower.read(data, ("127.0.0.1", 2000), 2.5)


def test_a_penalty_is_taken_where_the_ball_lies_not_at_the_last_designated_position(
    controller: Controller,
) -> None:
    controller.say("STOP", "DIRECT_FREE_BLUE", (0.0, 0.0))
    controller.say("PREPARE_PENALTY_BLUE", at=(0.0, 0.0))
    assert controller.ball(-1.5, 0.0, 1.0).placement is None
    controller.say("NORMAL_START", at=(0.0, 0.0))
    game = controller.ball(-1.5, 0.0, 1.1)
    assert (game.restart, game.may_touch, game.placement) == (Restart.PENALTY, True, (-1.5, 0.0))


CRASH = RefereeEvent(3.0, EventKind.BOT_CRASH_UNIQUE, Team.YELLOW, RobotId(Team.YELLOW, 4), 1.0, -2.0)
FAST = RefereeEvent(4.0, EventKind.BOT_TOO_FAST_IN_STOP, Team.BLUE, RobotId(Team.BLUE, 2), 0.5, 0.25)


def test_events_are_published_with_who_did_what_and_reported_once() -> None:
    publisher, follower = RefereePublisher(), RefereeFollower()
    events = [write_event(event, 100.0, "robobt") for event in (CRASH, FAST)]
    stopped = replace(STOPPED, events=("bot_crash_unique", "bot_too_fast_in_stop"))
    follower.read(publisher.write(replace(stopped, events=stopped.events[:1]), 104.0, events[:1]))
    follower.read(publisher.write(stopped, 105.0, events))
    assert follower.game == stopped
    heard = follower.reported(5.0, 100.0)
    assert [(e.kind, e.team, e.robot, e.time, e.x, e.y) for e in heard] == [
        (e.kind, e.team, e.robot, e.time, e.x, e.y) for e in (CRASH, FAST)
    ]
    follower.read(publisher.write(stopped, 106.0, events))
    assert follower.reported(6.0) == []


def test_events_on_a_clock_of_their_own_are_of_now() -> None:
    follower = RefereeFollower()
    follower.read(RefereePublisher().write(STOPPED, 1.0, [write_event(CRASH, 1e9, "robobt")]))
    (heard,) = follower.reported(7.0)
    assert heard.time == 7.0
