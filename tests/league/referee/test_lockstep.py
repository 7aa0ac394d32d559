"""The controller is stepped: one answer to each time, all else is done before the next."""

from __future__ import annotations

import pytest

from robobt.league.referee import lockstep
from robobt.league.referee.lockstep import EPOCH
from robobt.league.referee.process import GameControllerError
from robobt.league.referee.setup import command, stage
from robobt.league.wire.messages import Change, CiInput, Config, Referee
from robobt.league.wire.stream import StreamError
from robobt.world.field import DIVISION_B
from robobt.world.game import Stage
from robobt.world.state import BallState, Frame, RobotState
from tests.league.referee.conftest import Connect
from tests.league.referee.fake_controller import FakeController


def names(messages: list[Referee]) -> list[str]:
    return [Referee.Command.Name(message.command) for message in messages]


def test_a_time_is_answered_by_the_state_before_what_follows_from_it(connect: Connect) -> None:
    controller = connect(FakeController().handle)
    controller.ask(0.0)
    controller.answer()
    controller.change([command("STOP")])
    controller.ask(11.0)
    assert controller.asked
    assert names(controller.answer()) == ["STOP"]
    assert not controller.asked
    # The kick-off that follows by itself is known before the next time is told.
    assert set(names(controller.rest())) == {"PREPARE_KICKOFF_BLUE"}
    # One more answer tells that nothing else followed.
    assert names(controller.rest()) == ["PREPARE_KICKOFF_BLUE"]


def test_changes_are_done_in_their_order_and_waited_for(connect: Connect) -> None:
    fake = FakeController()
    controller = connect(fake.handle)
    controller.ask(0.0)
    controller.answer()
    said = controller.change([command("STOP"), stage(Stage.NORMAL_FIRST_HALF), command("FORCE_START")])
    assert names(said) == ["STOP", "STOP", "HALT", "HALT", "FORCE_START", "FORCE_START", "FORCE_START"]
    assert said[-1].stage == Referee.Stage.Value("NORMAL_FIRST_HALF")
    # No time passes with them.
    assert [message.HasField("timestamp") for message in fake.inputs] == [True, False, False, False, False]


def test_what_follows_from_what_follows_is_waited_for_too(connect: Connect) -> None:
    """As the official one does it: a change that is done queues what it leads to behind all that waits."""
    queue: list[tuple[str, int]] = []
    state = FakeController().state

    def handle(message: CiInput) -> list[Referee]:
        said = []
        for given in message.api_inputs:
            if given.change.HasField("new_command_change"):
                queue.append(("leads on", 3))
            else:
                queue.append((given.change.set_status_message_change.status_message, 0))
        for text, further in list(queue):
            queue.pop(0)
            answer = Referee()
            answer.CopyFrom(state)
            answer.status_message = text
            said.append(answer)
            if further:
                queue.append((text, further - 1))
        return said

    controller = connect(handle)
    said = controller.change([command("STOP")])
    assert not queue
    assert [message.status_message for message in said].count("leads on") == 4


def test_a_controller_that_never_comes_to_rest_is_an_error(connect: Connect) -> None:
    fake, restless = FakeController(), FakeController().state
    controller = connect(lambda message: [restless, *fake.handle(message)])
    with pytest.raises(GameControllerError, match="does not come to rest"):
        controller.rest()


def test_how_the_controller_works_is_told_before_the_changes(connect: Connect) -> None:
    fake = FakeController()
    controller = connect(fake.handle)
    controller.change([Change(), Change()], Config(auto_continue=True))
    first, second, _ = fake.inputs
    assert first.api_inputs[0].config_delta.auto_continue
    assert not any(given.HasField("config_delta") for given in second.api_inputs)


def test_the_field_is_shown_with_the_time(connect: Connect) -> None:
    fake = FakeController()
    controller = connect(fake.handle)
    robots = (RobotState(3, 1.0, 2.0),)
    controller.ask(2.5, Frame(2.5, DIVISION_B, BallState(0.5, -0.5, 1.0, 0.0), robots, robots))
    controller.answer()
    sent = fake.inputs[-1]
    assert sent.timestamp == EPOCH * 10**9 + 2_500_000_000
    packet, shown = sent.tracker_packet, sent.tracker_packet.tracked_frame
    # The official one crashes without a name, and on robots of no team.
    assert packet.uuid
    assert packet.source_name
    assert [(robot.robot_id.team, robot.robot_id.id) for robot in shown.robots] == [
        (2, 3),
        (1, 3),
    ]
    ball = shown.balls[0]
    assert (ball.pos.x, ball.pos.y, ball.vel.x) == (0.5, -0.5, 1.0)


def test_a_silent_controller_is_an_error(connect: Connect, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lockstep, "_SILENCE", 0.05)
    controller = connect(lambda _: [])
    controller.ask(0.0)
    with pytest.raises(GameControllerError, match="has not answered"):
        controller.answer()


def test_a_controller_that_breaks_off_is_an_error(connect: Connect) -> None:
    def crash(_: CiInput) -> list[Referee]:
        raise StreamError("gone")

    controller = connect(crash)
    controller.ask(0.0)
    with pytest.raises(GameControllerError, match="closed the connection"):
        controller.answer()


def test_a_message_without_the_match_is_an_error(connect: Connect) -> None:
    controller = connect(lambda _: [Referee()])
    controller.ask(0.0)
    with pytest.raises(GameControllerError, match="without the state"):
        controller.answer()
