"""SSL-Vision packets, converted to and from detections in SI units.

Source of the fields: ssl-vision's detection messages (millimetres there).
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from math import isfinite, pi

from robobt.league.wire.geometry import CameraPlace, read_cameras, read_field
from robobt.league.wire.messages import SSL_DetectionFrame, SSL_GeometryData, SSL_WrapperPacket
from robobt.league.wire.packets import (
    MAX_OBJECTS,
    MAX_ROBOT_NUMBER,
    MAX_TIME,
    MM_PER_M,
    PacketCounts,
    on_field,
    read,
)
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.state import BallState, RobotId

_CAMERA_ID_LIMIT = 64

_MAX_LATENCY = 1.0
"""Longest plausible time from capture to sending [s]; beyond it the frame counts as sent when captured."""

_BALL_AREA = 80
"""Typical size of a ball in a camera's image [pixels]."""

_PATTERN_HEIGHT = 0.15
"""Height of a robot's pattern above the ground [m]."""


@dataclass(slots=True)
class BallDetection:
    """A detected ball [m]; ``tracked`` is its whole state where that is known, as from a tracked frame."""

    x: float
    y: float
    confidence: float = 1.0
    tracked: BallState | None = None


@dataclass(slots=True)
class RobotDetection:
    """A detected robot [m, rad]; ``heading`` is None for a pattern without orientation."""

    robot: RobotId
    x: float
    y: float
    heading: float | None
    confidence: float = 1.0


@dataclass(slots=True)
class CameraFrame:
    """The detections of one camera at one instant.

    ``captured`` and ``sent`` are times on the sender's clock [s].
    """

    camera: int
    number: int
    captured: float
    sent: float
    balls: list[BallDetection] = dataclasses.field(default_factory=list)
    robots: list[RobotDetection] = dataclasses.field(default_factory=list)

    def turned(self) -> CameraFrame:
        """Return the same frame in coordinates turned by 180 degrees."""
        balls = []
        for ball in self.balls:
            known = ball.tracked
            if known is not None:
                known = BallState(-known.x, -known.y, -known.vx, -known.vy, known.z, known.vz)
            balls.append(BallDetection(-ball.x, -ball.y, ball.confidence, known))
        robots = []
        for robot in self.robots:
            heading = None if robot.heading is None else wrap_angle(robot.heading + pi)
            robots.append(RobotDetection(robot.robot, -robot.x, -robot.y, heading, robot.confidence))
        return CameraFrame(self.camera, self.number, self.captured, self.sent, balls, robots)


@dataclass(slots=True)
class VisionPacket:
    """The contents of a vision packet; each part may be missing."""

    frame: CameraFrame | None
    field: FieldGeometry | None
    cameras: dict[int, CameraPlace] = dataclasses.field(default_factory=dict)


def read_vision(data: bytes, counts: PacketCounts) -> VisionPacket | None:
    """Return the contents of a packet, or None (counted) when it is malformed or implausible."""
    return read(SSL_WrapperPacket, data, counts, _read_packet)


def _read_packet(message: SSL_WrapperPacket) -> VisionPacket | None:
    frame = read_frame(message.detection) if message.HasField("detection") else None
    if not message.HasField("geometry"):
        return None if frame is None else VisionPacket(frame, None)
    seen = read_field(message.geometry.field)
    cameras = read_cameras(message.geometry)
    return None if frame is None and seen is None else VisionPacket(frame, seen, cameras)


def read_frame(message: SSL_DetectionFrame) -> CameraFrame | None:
    """Return the plausible detections of a frame; None when the frame itself is implausible.

    Detections that are not finite, lie far outside any field or have an
    impossible number are left out. Confidences above 1 count as 1.
    """
    captured, sent = message.t_capture, message.t_sent
    # NaN compares as false.
    if not (abs(captured) <= MAX_TIME and abs(sent) <= MAX_TIME and message.camera_id < _CAMERA_ID_LIMIT):
        return None
    if max(len(message.balls), len(message.robots_blue), len(message.robots_yellow)) > MAX_OBJECTS:
        return None
    if not 0.0 <= sent - captured <= _MAX_LATENCY:
        sent = captured
    frame = CameraFrame(message.camera_id, message.frame_number, captured, sent)
    for ball in message.balls:
        x, y, confidence = ball.x / MM_PER_M, ball.y / MM_PER_M, ball.confidence
        if on_field(x, y) and isfinite(confidence):
            frame.balls.append(BallDetection(x, y, min(confidence, 1.0)))
    for team, robots in ((Team.BLUE, message.robots_blue), (Team.YELLOW, message.robots_yellow)):
        for robot in robots:
            x, y, confidence = robot.x / MM_PER_M, robot.y / MM_PER_M, robot.confidence
            if not robot.HasField("robot_id") or robot.robot_id > MAX_ROBOT_NUMBER:
                continue
            if not (on_field(x, y) and isfinite(confidence)):
                continue
            heading = None
            if robot.HasField("orientation") and abs(robot.orientation) <= 4 * pi:
                heading = wrap_angle(robot.orientation)
            number = RobotId(team, robot.robot_id)
            frame.robots.append(RobotDetection(number, x, y, heading, min(confidence, 1.0)))
    return frame


def write_frame(frame: CameraFrame) -> SSL_DetectionFrame:
    """Return the message of a camera's frame, with every field that strict readers require."""
    message = SSL_DetectionFrame(
        frame_number=frame.number % 2**32, t_capture=frame.captured, t_sent=frame.sent, camera_id=frame.camera
    )
    for ball in frame.balls:
        message.balls.add(
            confidence=ball.confidence,
            area=_BALL_AREA,
            x=ball.x * MM_PER_M,
            y=ball.y * MM_PER_M,
            z=0.0,
            pixel_x=0.0,
            pixel_y=0.0,
        )
    for robot in frame.robots:
        robots = message.robots_blue if robot.robot.team is Team.BLUE else message.robots_yellow
        added = robots.add(
            confidence=robot.confidence,
            robot_id=robot.robot.number,
            x=robot.x * MM_PER_M,
            y=robot.y * MM_PER_M,
            pixel_x=0.0,
            pixel_y=0.0,
            height=_PATTERN_HEIGHT * MM_PER_M,
        )
        if robot.heading is not None:
            added.orientation = robot.heading
    return message


def write_vision(frame: CameraFrame | None, geometry: SSL_GeometryData | None = None) -> bytes:
    """Return a packet with a frame, a geometry, or both."""
    message = SSL_WrapperPacket(source="SSL_SOURCE_OTHER")
    if frame is not None:
        message.detection.CopyFrom(write_frame(frame))
    if geometry is not None:
        message.geometry.CopyFrom(geometry)
    return bytes(message.SerializeToString())
