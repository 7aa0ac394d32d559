"""Packets come in from where they may, are of bounded size, and are counted when dropped."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from robobt.league.wire.endpoints import parse_endpoint
from robobt.league.wire.packets import MAX_PACKET
from robobt.league.wire.sockets import Packet, Receiver, Sender, SocketError
from tests.waiting import soon

GROUP = "224.5.23.2"


def received(receiver: Receiver, expected: int = 1) -> list[Packet]:
    packets: list[Packet] = []

    def all_came() -> bool:
        packets.extend(receiver.receive())
        return len(packets) >= expected

    soon(all_came)
    return packets


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    with Receiver("127.0.0.1", 0) as receiver:
        yield receiver


def test_a_group_is_heard_over_the_loopback() -> None:
    with Receiver(GROUP, 0) as receiver, Sender(GROUP, receiver.port) as sender:
        sender.send(b"a frame")
        assert [packet.data for packet in received(receiver)] == [b"a frame"]


def test_a_group_is_heard_on_a_named_interface() -> None:
    with Receiver(GROUP, 0, "127.0.0.1") as receiver, Sender(GROUP, receiver.port) as sender:
        sender.send(b"a frame")
        assert [packet.data for packet in received(receiver)] == [b"a frame"]


def test_two_programs_hear_the_same_group() -> None:
    with Receiver(GROUP, 0) as one, Receiver(GROUP, one.port) as other, Sender(GROUP, one.port) as sender:
        sender.send(b"a frame")
        assert received(one) == received(other) != []


def test_an_empty_packet_arrives(receiver: Receiver) -> None:
    with Sender("127.0.0.1", receiver.port) as sender:
        sender.send(b"")
        assert [packet.data for packet in received(receiver)] == [b""]


def test_an_oversized_packet_is_dropped_and_counted(receiver: Receiver) -> None:
    with Sender("127.0.0.1", receiver.port) as sender:
        sender.send(bytes(MAX_PACKET + 1))
        sender.send(bytes(MAX_PACKET))
        assert [len(packet.data) for packet in received(receiver)] == [MAX_PACKET]
    assert receiver.counts.oversized == 1


def test_a_packet_of_another_machine_is_dropped_and_counted(
    receiver: Receiver, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robobt.league.wire.sockets._can_bind", lambda _: False)
    with Sender("127.0.0.1", receiver.port) as sender:
        sender.send(b"hello")
        soon(lambda: list(receiver.receive()) or receiver.counts.foreign)
    assert receiver.counts.foreign == 1


def test_a_flood_does_not_keep_the_reader_for_ever(receiver: Receiver) -> None:
    with Sender("127.0.0.1", receiver.port) as sender:
        for _ in range(600):
            sender.send(b"flood")
        assert len(list(receiver.receive())) <= 256


def test_answers_of_anybody_else_are_left_out(receiver: Receiver) -> None:
    with Sender("127.0.0.1", receiver.port) as sender:
        sender.send(b"question")
        (question,) = received(receiver)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.sendto(b"not asked", question.sender)
        receiver.answer(b"answer", question.sender)
        assert soon(lambda: list(sender.answers())) == [b"answer"]


def test_an_unknown_interface_is_one_plain_error() -> None:
    with pytest.raises(SocketError, match=r"no interface of this machine has the address 203\.0\.113\.7"):
        Receiver(GROUP, 0, "203.0.113.7")


def test_a_taken_port_is_one_plain_error(receiver: Receiver) -> None:
    with pytest.raises(SocketError, match=rf"cannot receive at 127\.0\.0\.1:{receiver.port}: "):
        Receiver("127.0.0.1", receiver.port)


@pytest.mark.parametrize("text", ["here", "224.5.23.2", "224.5.23.2:", "224.5.23.2:70000", "localhost:1"])
def test_an_endpoint_that_is_none_is_one_plain_error(text: str) -> None:
    with pytest.raises(ValueError, match=r"is not an address like 224\.5\.23\.2:10006"):
        parse_endpoint(text)
