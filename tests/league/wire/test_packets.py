"""Malformed packets are dropped and counted."""

from __future__ import annotations

from robobt.league.wire.messages import SSL_WrapperPacket
from robobt.league.wire.packets import PacketCounts, decode


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
