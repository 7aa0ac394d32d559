"""A protobuf encoder of a few lines, working from a table of fields and sharing no code with the library."""

from __future__ import annotations

import random
import struct
from typing import Any, NamedTuple

from tests.league.field_table import ENUMS, MESSAGES


class PlainField(NamedTuple):
    label: str
    type: str
    name: str
    number: int
    packed: bool


def _blocks(text: str) -> dict[str, list[list[str]]]:
    blocks: dict[str, list[list[str]]] = {}
    name = ""
    for line in text.strip().splitlines():
        if line.startswith(" "):
            blocks[name].append(line.split())
        else:
            name = line
            blocks[name] = []
    return blocks


FIELDS = {
    message: [PlainField(w[0], w[1], w[2], int(w[4]), w[-1] == "packed") for w in rows]
    for message, rows in _blocks(MESSAGES).items()
}
FIELDS["google.protobuf.Any"] = [
    PlainField("opt", "string", "type_url", 1, False),
    PlainField("opt", "bytes", "value", 2, False),
]
FIELDS["GameEvent"] = []
ENUM_VALUES = {enum: {w[0]: int(w[1]) for w in rows} for enum, rows in _blocks(ENUMS).items()}


def full_type(message: str, type_: str) -> str:
    """A type as the table calls it: nested in the message, in its parent, or of its own."""
    for scope in (message, message.rpartition(".")[0]):
        if f"{scope}.{type_}" in FIELDS or f"{scope}.{type_}" in ENUM_VALUES:
            return f"{scope}.{type_}"
    return type_


def random_values(message: str, rng: random.Random, full: bool = False) -> dict[str, Any]:
    """Values of a message: required fields always, others by chance or, with ``full``, all of them."""
    values: dict[str, Any] = {}
    chosen = [field for field in FIELDS[message] if field.label == "one"]
    only = rng.choice(chosen) if chosen else None
    for field in FIELDS[message]:
        if field.label == "one" and field is not only:
            continue
        if field.label == "rep":
            count = rng.randint(1, 3) if full else rng.randint(0, 3)
            if count:
                values[field.name] = [_random_value(message, field, rng, full) for _ in range(count)]
        elif full or field.label in ("req", "one") or rng.random() < 0.6:
            values[field.name] = _random_value(message, field, rng, full)
    return values


def _random_value(message: str, field: PlainField, rng: random.Random, full: bool) -> Any:
    type_ = full_type(message, field.type)
    if type_ in FIELDS:
        return random_values(type_, rng, full)
    if type_ in ENUM_VALUES:
        return rng.choice(list(ENUM_VALUES[type_].values()))
    if type_ == "bool":
        return rng.random() < 0.5
    if type_ == "string":
        return "".join(rng.choices("abc µ°ß", k=rng.randint(0, 200)))
    if type_ == "bytes":
        return rng.randbytes(rng.randint(0, 20))
    if type_ == "float":
        return struct.unpack("<f", struct.pack("<f", rng.choice([0.0, -1.5, rng.uniform(-1e4, 1e4)])))[0]
    if type_ == "double":
        return rng.choice([0.0, 1e300, rng.uniform(-1e9, 1e9)])
    bits = int(type_[-2:])
    if type_.startswith("u"):
        return rng.choice([0, 1, 2**bits - 1, rng.randrange(2**bits)])
    return rng.choice([0, -1, 2 ** (bits - 1) - 1, -(2 ** (bits - 1)), rng.randrange(1000)])


def encode(message: str, values: dict[str, Any]) -> bytes:
    """The bytes of a message, fields in the order of their numbers."""
    out = b""
    for field in sorted(FIELDS[message], key=lambda field: field.number):
        if field.name not in values:
            continue
        type_ = full_type(message, field.type)
        if message == "google.protobuf.Any" and not values[field.name]:
            # The one message of proto3, which has no words for "set, but empty".
            continue
        many = values[field.name] if field.label == "rep" else [values[field.name]]
        if field.packed:
            packed = b"".join(_scalar(type_, value)[1] for value in many)
            out += _varint(field.number << 3 | 2) + _varint(len(packed)) + packed
            continue
        for value in many:
            kind, data = _scalar(type_, value)
            out += _varint(field.number << 3 | kind) + data
    return out


def _scalar(type_: str, value: Any) -> tuple[int, bytes]:
    if type_ in FIELDS:
        data = encode(type_, value)
        return 2, _varint(len(data)) + data
    if type_ in ("string", "bytes"):
        data = value.encode() if isinstance(value, str) else value
        return 2, _varint(len(data)) + data
    if type_ == "float":
        return 5, struct.pack("<f", value)
    if type_ == "double":
        return 1, struct.pack("<d", value)
    if type_.startswith("sint"):
        value = value * 2 if value >= 0 else -value * 2 - 1
    return 0, _varint(int(value) & (2**64 - 1))


def _varint(value: int) -> bytes:
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)
