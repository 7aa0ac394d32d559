"""The messages are those of the league's interface tables, byte for byte."""

from __future__ import annotations

import random
from typing import Any

import pytest

from robobt.league.wire import messages
from robobt.league.wire.messages import SSL_WrapperPacket
from robobt.league.wire.packets import PacketCounts, decode
from tests.league.plain_protobuf import ENUM_VALUES, FIELDS, encode, full_type, random_values

PUBLISHED = sorted(name for name in FIELDS if not name.startswith("google.") and name != "GameEvent")
LABELS = {"req": "required", "opt": "optional", "rep": "repeated", "one": "optional"}


def class_of(name: str) -> Any:
    cls = messages
    for part in name.split("."):
        cls = getattr(cls, part)
    return cls


def fill(message: Any, name: str, values: dict[str, Any]) -> Any:
    for field in FIELDS[name]:
        if field.name not in values:
            continue
        value, type_ = values[field.name], full_type(name, field.type)
        if type_ in FIELDS and field.label == "rep":
            for one in value:
                fill(getattr(message, field.name).add(), type_, one)
        elif type_ in FIELDS:
            getattr(message, field.name).SetInParent()
            fill(getattr(message, field.name), type_, value)
        elif field.label == "rep":
            getattr(message, field.name).extend(value)
        else:
            setattr(message, field.name, value)
    return message


@pytest.mark.integration
@pytest.mark.parametrize("name", PUBLISHED)
def test_encodes_to_the_bytes_of_an_independent_implementation(name: str) -> None:
    rng = random.Random(name)
    for trial in range(30):
        values = random_values(name, rng, full=trial == 0)
        expected = encode(name, values)
        assert fill(class_of(name)(), name, values).SerializeToString(deterministic=True) == expected
        assert class_of(name).FromString(expected) == fill(class_of(name)(), name, values)


@pytest.mark.parametrize("name", PUBLISHED)
def test_has_the_fields_of_the_table_and_no_others(name: str) -> None:
    descriptor = class_of(name).DESCRIPTOR
    found = {}
    for field in descriptor.fields:
        label = "rep" if field.is_repeated else "req" if field.is_required else "opt"
        if field.containing_oneof is not None:
            label = "one"
        found[field.name] = (LABELS[label], field.number)
    assert found == {field.name: (LABELS[field.label], field.number) for field in FIELDS[name]}


@pytest.mark.parametrize("name", sorted(name for name, fields in FIELDS.items() if fields))
def test_a_message_without_a_required_field_cannot_be_sent(name: str) -> None:
    required = [field.name for field in FIELDS[name] if field.label == "req"]
    for missing in required:
        values = random_values(name, random.Random(1), full=True)
        del values[missing]
        message = fill(class_of(name)(), name, values)
        assert not message.IsInitialized()
        with pytest.raises(messages.EncodeError):
            message.SerializeToString()


@pytest.mark.parametrize("name", sorted(ENUM_VALUES))
def test_enums_have_the_published_values(name: str) -> None:
    outer, _, inner = name.rpartition(".")
    pool = messages.SSL_WrapperPacket.DESCRIPTOR.file.pool
    enum = class_of(outer).DESCRIPTOR.enum_types_by_name[inner] if outer else pool.FindEnumTypeByName(name)
    assert {value.name: value.number for value in enum.values} == ENUM_VALUES[name]


def test_another_package_may_define_messages_of_the_same_names() -> None:
    from google.protobuf import descriptor_pb2, descriptor_pool

    other = descriptor_pb2.FileDescriptorProto(name="tests/other_league.proto", syntax="proto2")
    other.message_type.add(name="SSL_WrapperPacket")
    descriptor_pool.Default().Add(other)
    assert messages.SSL_WrapperPacket().DESCRIPTOR.fields_by_name["detection"].number == 1


def test_an_event_of_a_type_not_known_yet_is_carried_on() -> None:
    # Field 99 holds a message {1: 1}, type (40) is 99.
    event = bytes.fromhex("c002639a06020801")
    assert messages.GameEvent.FromString(event).SerializeToString() == event


def test_an_event_that_lacks_what_the_league_requires_does_not_cost_the_packet() -> None:
    message = messages.GameEvent(type=6)
    message.ball_left_field_touch_line.by_bot = 3
    assert messages.GameEvent.FromString(message.SerializeToString()).IsInitialized()


def test_what_is_no_message_is_counted() -> None:
    counts = PacketCounts()
    assert decode(SSL_WrapperPacket, b"\xff\xff\xff", counts) is None
    assert decode(SSL_WrapperPacket, b"\x0a\x01", counts) is None
    assert counts.unreadable == 2


def test_a_message_without_a_required_field_is_counted() -> None:
    counts = PacketCounts()
    assert decode(SSL_WrapperPacket, b"\x0a\x00", counts) is None
    assert counts.incomplete == 1
    assert counts.dropped == 1
