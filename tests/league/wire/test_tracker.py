"""Tracked frames keep positions and velocities, and nothing impossible gets through."""

from __future__ import annotations

from math import nan

import pytest

from robobt.league.wire.messages import TrackerWrapperPacket
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.tracker import read_tracked, write_tracked
from robobt.world.field import DIVISION_B
from robobt.world.state import BallState, Frame, RobotState

FRAME = Frame(
    12.5,
    DIVISION_B,
    BallState(0.5, -0.25, 2.0, -1.0, 0.75, -1.5),
    (RobotState(1, -1.0, 0.5, 1.5, 0.25, -0.5, 3.0), RobotState(4, -2.0, 0.0)),
    (RobotState(0, 1.0, 0.5, -1.5),),
)


def packet() -> bytes:
    return write_tracked(FRAME, 7, 12.5, "an id")


def test_a_frame_comes_back_as_it_was() -> None:
    counts = PacketCounts()
    found = read_tracked(packet(), DIVISION_B, counts)
    assert found is not None
    source, frame = found
    assert source == "robobt"
    assert counts.accepted == 1
    assert (frame.time, frame.ball, frame.own, frame.opponents) == (
        12.5,
        FRAME.ball,
        FRAME.own,
        FRAME.opponents,
    )


def test_robots_that_cannot_be_are_left_out() -> None:
    message = TrackerWrapperPacket.FromString(packet())
    message.tracked_frame.robots[0].pos.x = nan
    message.tracked_frame.robots[1].robot_id.id = 99
    message.tracked_frame.robots[2].vel.y = 1e9
    found = read_tracked(message.SerializeToString(), DIVISION_B, PacketCounts())
    assert found is not None
    assert found[1].own == found[1].opponents == ()


@pytest.mark.parametrize(("z", "vz"), [(nan, 0.0), (11.0, 0.0), (-0.1, 0.0), (0.5, 1e9), (0.5, nan)])
def test_a_ball_where_none_can_fly_is_left_out(z: float, vz: float) -> None:
    message = TrackerWrapperPacket.FromString(packet())
    message.tracked_frame.balls[0].pos.z = z
    message.tracked_frame.balls[0].vel.z = vz
    found = read_tracked(message.SerializeToString(), DIVISION_B, PacketCounts())
    assert found is not None
    assert found[1].ball == BallState(0.0, 0.0)


@pytest.mark.parametrize("data", [b"", b"\xff", TrackerWrapperPacket(uuid="only").SerializeToString()])
def test_what_holds_no_frame_is_counted(data: bytes) -> None:
    counts = PacketCounts()
    assert read_tracked(data, DIVISION_B, counts) is None
    assert counts.dropped == 1
