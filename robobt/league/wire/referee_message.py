"""Reads the valid part of a game controller's message, so that no HALT is lost in a damaged one."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from google.protobuf.unknown_fields import UnknownFieldSet

from robobt.league.wire.messages import DecodeError, Message
from robobt.league.wire.messages import Referee as RefereeMessage
from robobt.league.wire.packets import (
    MAX_OBJECTS,
    MAX_PACKET,
    MAX_ROBOT_NUMBER,
    MAX_TIME,
    MICROSECONDS_PER_S,
    MM_PER_M,
    PacketCounts,
    on_field,
)
from robobt.world.game import RefereeCommand

LONGEST = 65_535
"""Longest packet that is read [bytes]: there is no longer one, and a HALT may be in it."""

_LONGEST_TIME = 86_400.0
"""No stage or action takes longer [s]."""

_MOST_GOALS_OR_CARDS = 99
"""No team has more goals or cards."""

_TEAM_LIMITS = {
    "score": _MOST_GOALS_OR_CARDS,
    "red_cards": _MOST_GOALS_OR_CARDS,
    "goalkeeper": MAX_ROBOT_NUMBER,
    "max_allowed_bots": MAX_ROBOT_NUMBER + 1,
}
"""Largest values of a team's fields."""

_MOST_BROKEN_FIELDS = 256
"""Number of fields read of a broken message: messages have about 15, and one for each game event."""

# No longer sent, but found in old logs.
_OUTDATED = {
    10: RefereeCommand.DIRECT_FREE_YELLOW,
    11: RefereeCommand.DIRECT_FREE_BLUE,
    14: RefereeCommand.STOP,
    15: RefereeCommand.STOP,
}

_STOPPING = {
    int(command): command
    for command in (
        RefereeCommand.HALT,
        RefereeCommand.STOP,
        RefereeCommand.TIMEOUT_BLUE,
        RefereeCommand.TIMEOUT_YELLOW,
    )
}
"""Commands that are obeyed in whatever message they come, by their numbers."""

_ENUMS = {
    field.number: field.name
    for field in RefereeMessage.DESCRIPTOR.fields
    if field.enum_type is not None and not field.is_repeated
}
_COMMAND = RefereeMessage.DESCRIPTOR.fields_by_name["command"].number

_VARINT, _EIGHT, _LENGTH, _FOUR = 0, 1, 2, 5
"""Types of fields on the wire: a number, 8 bytes, a length with this many bytes, 4 bytes."""

_TYPICAL = re.compile(rb"\x20([\x00\x01\x0c\x0d])\x28")
"""A command that stops the robots and the beginning of its counter, which every controller writes next."""


class ReadMessage(NamedTuple):
    """The valid part of a message.

    Attributes:
        message: the valid fields.
        command: the command, None without a new one.
        odd: names of the fields that are missing or made no sense.
    """

    message: RefereeMessage
    command: RefereeCommand | None
    odd: list[str]


def read_message(data: bytes, counts: PacketCounts) -> ReadMessage | None:
    """Return the valid part of a packet, or None if nothing is usable.

    A command to stop is found in whatever is around it. Any other counts only in a message that can be
    decoded and has the number by which a command is known to be new.
    The packet is counted by what is wrong with it.
    """
    whole = True
    try:
        message = RefereeMessage.FromString(data)
    except (DecodeError, ValueError):
        whole, message = False, _decodable(data)
    missing = [path.partition("[")[0] for path in message.FindInitializationErrors()]
    odd = clear_nonsense(message)
    if len(data) > MAX_PACKET:
        counts.oversized += 1
    elif not whole:
        counts.unreadable += 1
    elif missing:
        counts.incomplete += 1
    elif odd:
        counts.implausible += 1
    else:
        counts.accepted += 1
    command = _stop_in(data)
    if command is None and (missing or not whole):
        # A field that was spoilt may hide where the command begins.
        typical = _TYPICAL.search(data)
        command = None if typical is None else _STOPPING[typical.group(1)[0]]
    if command is None and whole:
        told = command_in(message)
        if told is None:
            return None
        if told in _STOPPING or message.HasField("command_counter"):
            command = told
    elif command is None:
        return None
    return ReadMessage(message, command, sorted({*odd, *missing}))


def clear_nonsense(message: RefereeMessage) -> list[str]:
    """Clear the fields whose values cannot be, and return their names; unknown values of enums are named."""
    odd = [_ENUMS[field.field_number] for field in UnknownFieldSet(message) if field.field_number in _ENUMS]
    if message.packet_timestamp / MICROSECONDS_PER_S > MAX_TIME:
        _clear(message, "packet_timestamp", odd)
    for time in ("stage_time_left", "current_action_time_remaining"):
        if abs(getattr(message, time)) / MICROSECONDS_PER_S > _LONGEST_TIME:
            _clear(message, time, odd)
    if message.HasField("designated_position"):
        spot = message.designated_position
        named = spot.HasField("x") and spot.HasField("y")
        if not (named and on_field(spot.x / MM_PER_M, spot.y / MM_PER_M)):
            _clear(message, "designated_position", odd)
    for team in ("blue", "yellow"):
        info = getattr(message, team)
        for field, most in _TEAM_LIMITS.items():
            if getattr(info, field) > most:
                _clear(info, field, odd, f"{team}.")
        if len(info.yellow_card_times) > _MOST_GOALS_OR_CARDS:
            _clear(info, "yellow_card_times", odd, f"{team}.")
    events = [event for event in message.game_events[:MAX_OBJECTS] if event.HasField("type")]
    if len(events) < len(message.game_events):
        odd.append("game_events")
        del message.game_events[:]
        message.game_events.extend(events)
    return odd


def command_in(message: RefereeMessage) -> RefereeCommand | None:
    """Return a message's command, HALT for one that is not known, and None where there is none."""
    # A value that the enum lacks is kept apart, and the field seems to be missing.
    if any(field.field_number == _COMMAND and field.wire_type == 0 for field in UnknownFieldSet(message)):
        return RefereeCommand.HALT
    return command_of(message.command) if message.HasField("command") else None


def command_of(number: int) -> RefereeCommand:
    """Return the command with a number of the protocol, an outdated one included."""
    return _OUTDATED.get(int(number)) or RefereeCommand(int(number))


def _clear(message: Message, name: str, odd: list[str], prefix: str = "") -> None:
    message.ClearField(name)
    odd.append(prefix + name)


def _decodable(data: bytes) -> RefereeMessage:
    """Return the fields of a broken message that can be decoded."""
    message = RefereeMessage()
    for start, _, end in _fields(data):
        try:
            message.MergeFromString(data[start:end])
        except (DecodeError, ValueError):
            continue
    return message


def _stop_in(data: bytes) -> RefereeCommand | None:
    """Return the first command in a packet that stops the robots, although a later one may contradict it."""
    for start, value, _ in _fields(data):
        if data[start] == _COMMAND << 3 | _VARINT and data[value] in _STOPPING:
            return _STOPPING[data[value]]
    return None


def _fields(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield where each outer field of a message starts, has its value and ends, until one makes no sense."""
    start = 0
    for _ in range(_MOST_BROKEN_FIELDS):
        value = _past_varint(data, start)
        if value is None or data[start] < 1 << 3:
            return
        kind, end = data[start] & 7, None
        if kind == _VARINT:
            end = _past_varint(data, value)
        elif kind == _LENGTH:
            begin = _past_varint(data, value)
            if begin is not None:
                end = begin + _varint(data[value:begin])
        elif kind in (_EIGHT, _FOUR):
            end = value + (8 if kind == _EIGHT else 4)
        if end is None or end > len(data):
            return
        yield start, value, end
        start = end


def _past_varint(data: bytes, start: int) -> int | None:
    """Return where a number of variable length ends."""
    for end in range(start + 1, min(start + 10, len(data)) + 1):
        if data[end - 1] < 0x80:
            return end
    return None


def _varint(data: bytes) -> int:
    return sum((byte & 0x7F) << 7 * i for i, byte in enumerate(data))
