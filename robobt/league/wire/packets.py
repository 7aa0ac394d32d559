"""Decode untrusted packets and count what happens to them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from robobt.league.wire.messages import DecodeError, Message

MAX_PACKET = 16384
"""Longest packet that is accepted [bytes]; the league's own are a tenth of that."""

MAX_OBJECTS = 64
"""Most objects of one kind in a packet; a packet with more is rejected."""

MAX_DISTANCE = 30.0
"""Furthest any object may be from the field's centre [m]."""

MAX_ROBOT_NUMBER = 31
"""Largest robot number."""

MAX_TIME = 1e10
"""Largest timestamp [s]: beyond it a double no longer separates two frames."""

MM_PER_M = 1000.0
"""Millimetres in a metre."""

MICROSECONDS_PER_S = 1e6
"""Microseconds in a second."""


_M = TypeVar("_M", bound=Message)
_T = TypeVar("_T")


@dataclass(slots=True)
class PacketCounts:
    """Counts of the packets of one port.

    Valid parts of a game controller's packets are used even if a packet is not accepted.

    Attributes:
        accepted: used.
        unreadable: not a message of the port's type, or truncated.
        incomplete: lacking a required field.
        implausible: holding impossible values (not finite, far outside any field), or nothing of use.
        oversized: longer than :data:`MAX_PACKET`.
        foreign: from an interface, machine or sender other than those that are followed.
    """

    accepted: int = 0
    unreadable: int = 0
    incomplete: int = 0
    implausible: int = 0
    oversized: int = 0
    foreign: int = 0

    def refuse(self) -> None:
        """Count the packet that was accepted last as one of a sender that is not followed."""
        self.accepted -= 1
        self.foreign += 1

    @property
    def dropped(self) -> int:
        """Number of packets that were not used, or not in full."""
        return self.unreadable + self.incomplete + self.implausible + self.oversized + self.foreign


def decode(kind: type[_M], data: bytes, counts: PacketCounts) -> _M | None:
    """Return the message in ``data``, or None (counted) when it is malformed."""
    try:
        message: _M = kind.FromString(data)
    except (DecodeError, ValueError):
        counts.unreadable += 1
        return None
    if not message.IsInitialized():
        counts.incomplete += 1
        return None
    return message


def read(kind: type[_M], data: bytes, counts: PacketCounts, convert: Callable[[_M], _T | None]) -> _T | None:
    """Decode a packet, convert its message and count the outcome, which is None when it was dropped.

    ``convert`` turns the message into a result, or into None when it is implausible.
    """
    message = decode(kind, data, counts)
    if message is None:
        return None
    result = convert(message)
    if result is None:
        counts.implausible += 1
    else:
        counts.accepted += 1
    return result


def on_field(x: float, y: float) -> bool:
    """Return whether a position is finite and near enough to a field to be real."""
    # NaN compares as false.
    return abs(x) <= MAX_DISTANCE and abs(y) <= MAX_DISTANCE
