"""Vision packets become detections in metres, and nothing impossible gets through."""

from __future__ import annotations

from math import inf, nan, pi

import pytest

from robobt.league.wire.messages import SSL_WrapperPacket
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.vision import (
    BallDetection,
    CameraFrame,
    RobotDetection,
    read_vision,
    write_frame,
    write_vision,
)
from robobt.world.game import Team
from robobt.world.state import RobotId

BLUE, YELLOW = RobotId(Team.BLUE, 3), RobotId(Team.YELLOW, 11)


def frame() -> CameraFrame:
    return CameraFrame(
        camera=2,
        number=77,
        captured=100.5,
        sent=100.535,
        balls=[BallDetection(0.25, -1.5, 0.75)],
        robots=[RobotDetection(BLUE, -1.0, 2.0, 1.5, 0.5), RobotDetection(YELLOW, 4.0, -0.5, None, 0.5)],
    )


def read(data: bytes) -> CameraFrame:
    packet = read_vision(data, PacketCounts())
    assert packet is not None
    assert packet.frame is not None
    return packet.frame


def test_a_frame_comes_back_as_it_was() -> None:
    assert read(write_vision(frame())) == frame()


def test_lengths_are_millimetres_in_the_packet() -> None:
    assert write_frame(frame()).balls[0].x == 250.0


@pytest.mark.parametrize("value", [nan, inf, -inf, 1e30, 40_000.0])
def test_detections_that_cannot_be_are_left_out(value: float) -> None:
    packet = SSL_WrapperPacket(detection=write_frame(frame()))
    packet.detection.balls[0].x = value
    packet.detection.robots_blue[0].y = value
    found = read(packet.SerializeToString())
    assert found.balls == []
    assert [robot.robot for robot in found.robots] == [YELLOW]


def test_a_robot_without_a_number_or_with_an_impossible_one_is_left_out() -> None:
    packet = SSL_WrapperPacket(detection=write_frame(frame()))
    packet.detection.robots_blue[0].ClearField("robot_id")
    packet.detection.robots_yellow[0].robot_id = 4_000_000_000
    assert read(packet.SerializeToString()).robots == []


def test_headings_are_wrapped() -> None:
    packet = SSL_WrapperPacket(detection=write_frame(frame()))
    packet.detection.robots_blue[0].orientation = 3 * pi / 2
    assert read(packet.SerializeToString()).robots[0].heading == pytest.approx(-pi / 2)


@pytest.mark.parametrize("time", [nan, inf])
def test_a_frame_of_no_time_is_dropped(time: float) -> None:
    packet = SSL_WrapperPacket(detection=write_frame(frame()))
    packet.detection.t_capture = time
    counts = PacketCounts()
    assert read_vision(packet.SerializeToString(), counts) is None
    assert counts.implausible == 1


def test_a_crowd_is_dropped() -> None:
    crowded = frame()
    crowded.balls = [BallDetection(0.0, 0.0)] * 65
    counts = PacketCounts()
    assert read_vision(write_vision(crowded), counts) is None
    assert counts.implausible == 1


def test_an_empty_packet_is_counted_not_used() -> None:
    counts = PacketCounts()
    assert read_vision(b"", counts) is None
    assert counts.implausible == 1
    assert counts.accepted == 0


@pytest.mark.parametrize("confidence", [1.5, 1e30])
def test_no_detection_is_surer_than_certain(confidence: float) -> None:
    packet = SSL_WrapperPacket(detection=write_frame(frame()))
    packet.detection.balls[0].confidence = packet.detection.robots_blue[0].confidence = confidence
    found = read(packet.SerializeToString())
    assert found.balls[0].confidence == 1.0
    assert found.robots[0].confidence == 1.0
