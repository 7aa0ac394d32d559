"""From a HALT on the wire to the last command that moves a robot, whatever else its message holds.

``pytest -s -m "slow or not slow" tests/league/faults/test_halt.py`` prints the longest time.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

import pytest

from robobt.league.serve.served_field import ServedField, line_up
from robobt.league.serve.server import SimServer
from robobt.league.wire.messages import GameEvent, Referee
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.sockets import Sender
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.state import RobotId
from tests.league.lockstep import LockstepWorld
from tests.league.mutations import around
from tests.league.served import free_endpoints

pytestmark = pytest.mark.integration

ME, HER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)
BAR = 0.05
"""Longest time from HALT to the last command that moves a robot [s]."""

KEPT = ("command", "command_counter")


class Halted(LockstepWorld):
    """A world to which a packet is sent within its control period, and that notes when it moves robots."""

    def __init__(self, server: SimServer, **arguments: Any) -> None:
        super().__init__(server, follow_referee=True, place=False, **arguments)
        self.referee = Sender(*self.connection.endpoints.referee)
        self.due: tuple[float, bytes] | None = None
        self.halted_at = self.moved_at = 0.0
        send = self._link.send

        def sent(commands: Mapping[RobotId, RobotCommand], time: float) -> None:
            if any(command != RobotCommand() for command in commands.values()):
                self.moved_at = self.machine_time
            send(commands, time)

        self._link.send = sent  # type: ignore[method-assign]

    def _receive(self, wait: float) -> None:
        if self.due is not None and self.machine_time + wait >= self.due[0]:
            self.machine_time = max(self.machine_time, self.due[0])
            self.halted_at = self.machine_time
            self.referee.send(self.due[1])
            self.due = None
        super()._receive(wait)


@pytest.fixture(scope="module")
def world() -> Iterator[Halted]:
    endpoints = free_endpoints()
    with (
        SimServer(ServedField(DIVISION_B, line_up(DIVISION_B, 1)), endpoints) as server,
        Halted(server, robots=dict.fromkeys((ME, HER)), endpoints=endpoints) as world,
    ):
        world.reset(line_up(DIVISION_B, 1), 0)
        yield world
        world.referee.close()


def halt() -> Any:
    """A HALT with all that a message can hold."""
    placing = GameState(
        RefereeCommand.HALT,
        restart=Restart.BALL_PLACEMENT,
        placement=(1.0, -2.0),
        upcoming=RefereeCommand.DIRECT_FREE_BLUE,
        events=("ball_left_field_touch_line", "bot_crash_unique"),
        action_time=2.5,
        stage_time=100.0,
    )
    message = Referee.FromString(RefereePublisher().write(placing, 50.0))
    message.command_counter, message.command_timestamp = 300, 1_700_000_000_000_000
    message.status_message, message.match_type = "waiting", 3
    message.game_event_proposals.add(id="one").game_events.add(type=GameEvent.GOAL)
    return message


def seconds_to_stop(world: Halted, packet: bytes, phase: float) -> float:
    """Play, send the packet at a phase of a control period, and return when the last robot was moved [s].

    Whoever decides goes on moving them.
    """
    drive = {ME: RobotCommand(0.5), HER: RobotCommand(0.0, 0.5, 1.0)}
    playing = Referee.FromString(packet[:0])
    playing.CopyFrom(halt())
    playing.command, playing.command_counter = Referee.FORCE_START, 299
    world.referee.send(playing.SerializeToString())
    world.act(drive)
    world.act(drive)
    assert world.machine_time - world.moved_at < 0.03
    world.due = world.machine_time + phase * world.period, packet
    for _ in range(5):
        world.act(drive)
    assert world.due is None
    assert world.machine_time - world.halted_at > BAR
    return max(0.0, world.moved_at - world.halted_at)


@pytest.mark.parametrize("amount", [50, pytest.param(1000, marks=pytest.mark.slow)])
def test_a_halt_whose_message_is_spoilt_stops_the_robots(world: Halted, amount: int) -> None:
    rng, longest = random.Random(1), 0.0
    for packet in islice(around(halt(), KEPT, seed=1), amount):
        took = seconds_to_stop(world, packet, rng.random())
        assert took <= BAR, packet
        longest = max(longest, took)
    print(f"\n{amount} spoilt messages: {longest:.3f} s from HALT to the last command that moves a robot")


def every_value() -> Iterator[bytes]:
    """A HALT with every value of every enum that its message can hold, and one that the enum lacks."""
    message = halt()
    for field in Referee.DESCRIPTOR.fields:
        if field.enum_type is not None and field.name != "command":
            for value in field.enum_type.values:
                copy = halt()
                setattr(copy, field.name, value.number)
                yield copy.SerializeToString()
            tag = field.number << 3
            unknown = bytes([tag & 0x7F | 0x80, tag >> 7, 99]) if tag > 0x7F else bytes([tag, 99])
            yield message.SerializeToString() + unknown
    for kind in GameEvent.Type.DESCRIPTOR.values:
        copy = halt()
        copy.game_events.add().type = kind.number
        yield copy.SerializeToString()
    for number in (*Referee.TeamInfo.DESCRIPTOR.fields_by_name["hull_color"].enum_type.values_by_number, 99):
        copy = halt()
        copy.yellow.MergeFromString(bytes([19 << 3 & 0x7F | 0x80, 19 << 3 >> 7, number]))
        yield copy.SerializeToString()


def test_a_halt_stops_the_robots_with_every_value_of_every_enum(world: Halted) -> None:
    packets = list(every_value())
    assert len(packets) > 80
    longest = max(seconds_to_stop(world, packet, 0.1 + 0.8 * (i % 5) / 5) for i, packet in enumerate(packets))
    print(
        f"\n{len(packets)} values of enums: {longest:.3f} s from HALT to the last command that moves a robot"
    )
    assert longest <= BAR


@pytest.mark.parametrize("number", [*Referee.Command.values(), 18, 99, 2**31 - 1])
def test_robots_stand_under_the_commands_that_say_so_and_those_that_nobody_knows(
    world: Halted, number: int
) -> None:
    message = halt()
    message.ClearField("command")
    value = b""
    while number > 0x7F:
        value += bytes([number & 0x7F | 0x80])
        number >>= 7
    packet = message.SerializePartialToString() + b"\x20" + value + bytes([number])
    known = message.FromString(packet).HasField("command")
    stands = not known or number in (Referee.HALT, Referee.TIMEOUT_BLUE, Referee.TIMEOUT_YELLOW)
    assert (seconds_to_stop(world, packet, 0.5) <= BAR) is stands


def test_a_halt_is_heard_while_trees_decide_and_behind_a_queue_of_junk(world: Halted) -> None:
    drive = {ME: RobotCommand(0.5)}
    message = halt()
    for number, junk in enumerate((0, 300)):
        message.command, message.command_counter = Referee.FORCE_START, 1000 + 2 * number
        world.referee.send(message.SerializeToString())
        world.act(drive)
        world.act(drive)
        for _ in range(junk):
            world.referee.send(b"\xff\xff")
        message.command, message.command_counter = Referee.HALT, 1001 + 2 * number
        world.referee.send(message.SerializeToString())
        halted_at = world.machine_time
        # What the trees had decided before it is not sent any more.
        for _ in range(5):
            world.act(drive)
        assert world.moved_at - halted_at <= BAR * (junk > 0)
