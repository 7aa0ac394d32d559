"""Packets as they must not be: real ones with bits flipped, cut, padded, and filled with absurd values."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from typing import Any

from google.protobuf.descriptor import FieldDescriptor

from robobt.league.wire.messages import Message

_FLOATS = (
    math.nan,
    math.inf,
    -math.inf,
    1e38,
    -1e38,
    3e-45,
    -0.0,
    0.0,
    1e9,
    -1e9,
    0.3,
    1e4,
    math.pi,
)
_DOUBLES = (*_FLOATS, 1e300, -1e300, 1e16, 1e16 + 2.0, 1e16 + 4.0, 1e17, 2.0**53, 1e-300)
_UNSIGNED = (0, 1, 5, 15, 31, 32, 2**31, 2**32 - 1)
_SIGNED = (-1, 0, 1, 300, 9000, -(2**31), 2**31 - 1)
_WIDE = (0, 1, 2**53, 2**63 - 1)

_LONG = 65_000
"""Nearly the longest datagram there is [bytes]."""


def mutations(seeds: list[Message], seed: int) -> Iterator[bytes]:
    """Packets without end that resemble the messages ``seeds``; the same ones for the same seed."""
    rng = random.Random(seed)
    while True:
        message = rng.choice(seeds)
        if rng.random() < 0.5:
            yield _bytes_changed(bytearray(message.SerializeToString()), rng)
            continue
        copy = type(message)()
        copy.CopyFrom(message)
        for _ in range(rng.choice((1, 1, 2, 4, 12))):
            _absurd(copy, rng)
        data = copy.SerializePartialToString()[:_LONG]
        yield _bytes_changed(bytearray(data), rng) if rng.random() < 0.1 else data


def around(message: Message, keep: tuple[str, str], seed: int) -> Iterator[bytes]:
    """Packets without end in which two adjacent fields of a message are intact, and all others are spoilt.

    Half of them have other fields that are absurd, the others bytes that were changed before or behind.
    """
    rng = random.Random(seed)
    kept = type(message)(**{name: getattr(message, name) for name in keep}).SerializePartialToString()
    while True:
        copy = type(message)()
        copy.CopyFrom(message)
        for _ in range(rng.choice((0, 1, 2, 4, 12))):
            _absurd(copy, rng)
        for name in keep:
            setattr(copy, name, getattr(message, name))
        before, _, behind = copy.SerializePartialToString().partition(kept)
        if rng.random() < 0.5:
            before = _bytes_changed(bytearray(before), rng)[-1000:] if rng.random() < 0.5 else before
            behind = _bytes_changed(bytearray(behind), rng)
        yield (before + kept + behind)[:_LONG]


def _bytes_changed(data: bytearray, rng: random.Random) -> bytes:
    kind = rng.randrange(100)
    if kind < 40:
        for _ in range(rng.choice((1, 1, 2, 8))):
            if data:
                data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    elif kind < 60:
        del data[rng.randrange(len(data) + 1) :]
    elif kind < 70:
        at = rng.randrange(len(data) + 1)
        data[at:at] = rng.randbytes(rng.randrange(1, 30))
    elif kind < 78:
        # A length far beyond the packet.
        at = rng.randrange(len(data) + 1)
        data[at:at] = b"\x0a" + rng.choice((b"\xff\xff\xff\xff\x07", b"\xff" * 9 + b"\x01", b"\xff\x7f"))
    elif kind < 84:
        # Groups and messages in one another.
        data = bytearray(rng.choice((b"\x0b", b"\x0a\x7f")) * rng.randrange(1, 2000)) + data
    elif kind < 90:
        at, to = sorted((rng.randrange(len(data) + 1), rng.randrange(len(data) + 1)))
        data += data[at:to] * rng.randrange(1, 5)
    elif kind < 94:
        data = data * rng.randrange(2, 8)
    elif kind < 97:
        data = bytearray(rng.randbytes(rng.randrange(200)))
    elif kind < 99:
        data = bytearray()
    else:
        data += bytes(rng.choice((16_384, 16_385, 40_000, _LONG)))
    return bytes(data[:_LONG])


def _absurd(message: Message, rng: random.Random) -> None:
    """One field of the message, or of one in it, set, cleared or repeated."""
    fields = message.DESCRIPTOR.fields
    if not fields:
        return
    field = rng.choice(fields)
    kind = field.cpp_type
    if field.is_repeated:
        items = getattr(message, field.name)
        if kind == FieldDescriptor.CPPTYPE_MESSAGE:
            if not len(items) or rng.random() < 0.2:
                items.add()
            if rng.random() < 0.03:
                items.extend([items[0]] * rng.choice((3, 70)))
            elif rng.random() < 0.05:
                del items[:]
            else:
                _absurd(items[rng.randrange(len(items))], rng)
        else:
            items.extend([_value(field, rng)] * rng.choice((1, 50)))
    elif rng.random() < 0.08:
        message.ClearField(field.name)
    elif kind == FieldDescriptor.CPPTYPE_MESSAGE:
        _absurd(getattr(message, field.name), rng)
    else:
        setattr(message, field.name, _value(field, rng))


def _value(field: FieldDescriptor, rng: random.Random) -> Any:
    kind = field.cpp_type
    if kind == FieldDescriptor.CPPTYPE_FLOAT:
        return rng.choice(_FLOATS)
    if kind == FieldDescriptor.CPPTYPE_DOUBLE:
        return rng.choice(_DOUBLES)
    if kind == FieldDescriptor.CPPTYPE_UINT32:
        return rng.choice((*_UNSIGNED, rng.randrange(2**32)))
    if kind == FieldDescriptor.CPPTYPE_INT32:
        return rng.choice((*_SIGNED, rng.randrange(2**31)))
    if kind in (FieldDescriptor.CPPTYPE_UINT64, FieldDescriptor.CPPTYPE_INT64):
        return rng.choice(_WIDE)
    if kind == FieldDescriptor.CPPTYPE_BOOL:
        return rng.random() < 0.5
    if kind == FieldDescriptor.CPPTYPE_ENUM:
        return rng.choice(field.enum_type.values).number
    return rng.randbytes(rng.randrange(40)) if field.type == FieldDescriptor.TYPE_BYTES else "x" * 300
