"""Messages over TCP arrive whole and in order, however they are cut into packets."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from robobt.league.wire.stream import MAX_MESSAGE, MessageStream, StreamError, encode_varint
from tests.waiting import LIMIT


@pytest.fixture
def ends() -> Iterator[tuple[MessageStream, socket.socket]]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        client = socket.create_connection(server.getsockname())
        other, _ = server.accept()
        with MessageStream(client, "the other side") as stream, other:
            yield stream, other


Ends = tuple[MessageStream, socket.socket]


@pytest.mark.parametrize("size", [0, 1, 127, 128, 300, 70_000])
def test_a_message_of_any_size_arrives(ends: Ends, size: int) -> None:
    stream, other = ends
    message = bytes(i % 251 for i in range(size))
    other.sendall(encode_varint(size) + message)
    assert stream.receive(LIMIT) == message


def test_messages_that_come_together_are_taken_one_by_one(ends: Ends) -> None:
    stream, other = ends
    other.sendall(b"\x01a\x02bc\x00")
    assert [stream.receive(LIMIT) for _ in range(3)] == [b"a", b"bc", b""]
    assert stream.receive(0.0) is None


def test_a_message_in_pieces_is_waited_for(ends: Ends) -> None:
    stream, other = ends
    for piece in (b"\x80", b"\x01", b"x" * 100):
        other.sendall(piece)
        assert stream.receive(0.02) is None
    other.sendall(b"x" * 28)
    assert stream.receive(LIMIT) == b"x" * 128


def test_what_is_sent_has_its_length_before_it(ends: Ends) -> None:
    stream, other = ends
    stream.send(b"x" * 200)
    assert other.recv(1000) == b"\xc8\x01" + b"x" * 200


def test_a_closed_connection_is_an_error_that_names_the_other_side(ends: Ends) -> None:
    stream, other = ends
    other.close()
    with pytest.raises(StreamError, match="the other side closed the connection"):
        stream.receive(LIMIT)


@pytest.mark.parametrize("start", [encode_varint(MAX_MESSAGE + 1), b"\x80" * 5, b"\xff" * 10])
def test_a_length_that_cannot_be_is_an_error(ends: Ends, start: bytes) -> None:
    stream, other = ends
    other.sendall(start)
    with pytest.raises(StreamError, match="the other side"):
        stream.receive(LIMIT)


def test_the_longest_message_is_still_accepted(ends: Ends) -> None:
    stream, other = ends
    other.sendall(encode_varint(MAX_MESSAGE))
    assert stream.receive(0.0) is None


def test_who_never_reads_is_not_waited_for_without_end(ends: Ends, monkeypatch: pytest.MonkeyPatch) -> None:
    stream, _ = ends
    monkeypatch.setattr("robobt.league.wire.stream._SEND_TIMEOUT", 0.05)
    with pytest.raises(StreamError, match=r"^the other side has read nothing for 0.05 s$"):
        stream.send(bytes(100_000_000))
