"""The messages are those of the league, field by field, and what is none of them is counted."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from importlib.resources import files

from google.protobuf.descriptor_pb2 import DescriptorProto, FileDescriptorProto, FileDescriptorSet

from robobt.league.wire import messages
from robobt.league.wire.messages import SSL_WrapperPacket
from robobt.league.wire.packets import PacketCounts, decode


def declared(scope: FileDescriptorProto | DescriptorProto) -> Iterator[str]:
    """What goes over the wire: every field's name, number, label and type, and every enum's values."""
    for enum in scope.enum_type:
        yield f"{enum.name}: {sorted((value.number, value.name) for value in enum.value)}"
    for message in scope.message_type if isinstance(scope, FileDescriptorProto) else scope.nested_type:
        for field in message.field:
            how = (
                field.label,
                field.type,
                field.type_name,
                field.options.packed,
                field.HasField("oneof_index"),
            )
            yield f"{message.name}.{field.name} = {field.number}: {how}"
        yield from declared(message)


def test_names_numbers_and_types_are_those_published() -> None:
    # Who changes a .proto file compares it with the league's and writes the new sum here.
    compiled = FileDescriptorSet.FromString(
        (files("robobt.league.wire") / "proto" / "messages.desc").read_bytes()
    )
    lines = sorted(line for file in compiled.file for line in declared(file))
    assert hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16] == "eae4c7f84d70dba6"


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
