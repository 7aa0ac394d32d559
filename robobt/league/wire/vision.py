"""SSL-Vision packets, converted to and from detections and a field in SI units.

Source of the fields: ssl-vision's detection and geometry messages (millimetres there).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite, pi

from pydantic import ValidationError

from robobt.league.wire.messages import (
    SSL_DetectionFrame,
    SSL_GeometryData,
    SSL_GeometryFieldSize,
    SSL_WrapperPacket,
)
from robobt.league.wire.packets import MAX_OBJECTS, MAX_ROBOT_NUMBER, MAX_TIME, PacketCounts, on_field, read
from robobt.world.field import DIVISION_A, DIVISION_B, FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, RobotId

_MM = 1000.0

_MAX_CAMERAS = 64

_MAX_LATENCY = 1.0
"""Longest plausible time from capture to sending [s]; beyond it the frame counts as sent when captured."""

_LINE_THICKNESS = 0.01
"""Width of the field's lines [m]. Source: RoboCup SSL rules."""

_BALL_AREA = 80
"""Typical size of a ball in a camera's image [pixels]."""

_PATTERN_HEIGHT = 0.15
"""Height of a robot's pattern above the ground [m]."""


@dataclass(slots=True)
class BallDetection:
    """A detected ball [m]."""

    x: float
    y: float
    confidence: float = 1.0


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

    Attributes:
        camera: number of the camera.
        number: number of the frame.
        captured: timestamp of the capture, on the sender's clock [s].
        sent: timestamp of sending, on the sender's clock [s].
        balls, robots: the detections.
    """

    camera: int
    number: int
    captured: float
    sent: float
    balls: list[BallDetection] = field(default_factory=list)
    robots: list[RobotDetection] = field(default_factory=list)


@dataclass(slots=True)
class VisionPacket:
    """The contents of a vision packet; either part may be missing."""

    frame: CameraFrame | None
    field: FieldGeometry | None


def read_vision(data: bytes, counts: PacketCounts) -> VisionPacket | None:
    """Return the contents of a packet, or None (counted) when it is malformed or implausible."""
    return read(SSL_WrapperPacket, data, counts, _read_packet)


def _read_packet(message: SSL_WrapperPacket) -> VisionPacket | None:
    frame = _read_frame(message.detection) if message.HasField("detection") else None
    geometry = read_field(message.geometry.field) if message.HasField("geometry") else None
    return None if frame is None and geometry is None else VisionPacket(frame, geometry)


def _read_frame(message: SSL_DetectionFrame) -> CameraFrame | None:
    """Return the plausible detections of a frame; None when the frame itself is implausible.

    Detections that are not finite, lie far outside any field or have an
    impossible number are left out.
    """
    captured, sent = message.t_capture, message.t_sent
    # NaN compares as false.
    if not (abs(captured) <= MAX_TIME and abs(sent) <= MAX_TIME and message.camera_id < _MAX_CAMERAS):
        return None
    if max(len(message.balls), len(message.robots_blue), len(message.robots_yellow)) > MAX_OBJECTS:
        return None
    if not 0.0 <= sent - captured <= _MAX_LATENCY:
        sent = captured
    frame = CameraFrame(message.camera_id, message.frame_number, captured, sent)
    for ball in message.balls:
        x, y, confidence = ball.x / _MM, ball.y / _MM, ball.confidence
        if on_field(x, y) and isfinite(confidence):
            frame.balls.append(BallDetection(x, y, confidence))
    for team, robots in ((Team.BLUE, message.robots_blue), (Team.YELLOW, message.robots_yellow)):
        for robot in robots:
            x, y, confidence = robot.x / _MM, robot.y / _MM, robot.confidence
            if not robot.HasField("robot_id") or robot.robot_id > MAX_ROBOT_NUMBER:
                continue
            if not (on_field(x, y) and isfinite(confidence)):
                continue
            heading = None
            if robot.HasField("orientation") and abs(robot.orientation) <= 4 * pi:
                heading = wrap_angle(robot.orientation)
            frame.robots.append(RobotDetection(RobotId(team, robot.robot_id), x, y, heading, confidence))
    return frame


def read_field(message: SSL_GeometryFieldSize) -> FieldGeometry | None:
    """Return the field of a geometry packet; None when no such field can exist.

    Sizes that the packet leaves out are taken from the field's lines and arcs, or
    else from the division whose length is nearest.
    """
    length, width = message.field_length / _MM, message.field_width / _MM
    division = min((DIVISION_A, DIVISION_B), key=lambda division: abs(division.length - length))
    depth, across = message.penalty_area_depth / _MM, message.penalty_area_width / _MM
    front = next((line for line in message.field_lines if line.name == "LeftPenaltyStretch"), None)
    if not message.HasField("penalty_area_depth"):
        depth = division.defense_depth if front is None else length / 2 - abs(front.p1.x) / _MM
    if not message.HasField("penalty_area_width"):
        across = division.defense_width if front is None else abs(front.p1.y - front.p2.y) / _MM
    radius = message.center_circle_radius / _MM
    if not message.HasField("center_circle_radius"):
        circles = [arc.radius / _MM for arc in message.field_arcs if arc.name == "CenterCircle"]
        radius = circles[0] if circles else division.center_radius
    goal_depth = message.goal_depth / _MM or division.goal_depth
    try:
        return FieldGeometry(
            length=length,
            width=width,
            goal_width=message.goal_width / _MM,
            goal_depth=goal_depth,
            defense_width=across,
            defense_depth=depth,
            center_radius=radius,
            margin=max(message.boundary_width / _MM, goal_depth, 0.2),
        )
    except ValidationError:
        return None


def write_frame(frame: CameraFrame) -> SSL_DetectionFrame:
    """Return the message of a camera's frame, with every field that strict readers require."""
    message = SSL_DetectionFrame(
        frame_number=frame.number % 2**32, t_capture=frame.captured, t_sent=frame.sent, camera_id=frame.camera
    )
    for ball in frame.balls:
        message.balls.add(
            confidence=ball.confidence,
            area=_BALL_AREA,
            x=ball.x * _MM,
            y=ball.y * _MM,
            z=0.0,
            pixel_x=0.0,
            pixel_y=0.0,
        )
    for robot in frame.robots:
        robots = message.robots_blue if robot.robot.team is Team.BLUE else message.robots_yellow
        added = robots.add(
            confidence=robot.confidence,
            robot_id=robot.robot.number,
            x=robot.x * _MM,
            y=robot.y * _MM,
            pixel_x=0.0,
            pixel_y=0.0,
            height=_PATTERN_HEIGHT * _MM,
        )
        if robot.heading is not None:
            added.orientation = robot.heading
    return message


def write_field(geometry: FieldGeometry) -> SSL_GeometryData:
    """Return the geometry message of a field, with its lines and arcs named as the league does."""
    message = SSL_GeometryData()
    size = message.field
    size.field_length = _mm(geometry.length)
    size.field_width = _mm(geometry.width)
    size.goal_width = _mm(geometry.goal_width)
    size.goal_depth = _mm(geometry.goal_depth)
    size.boundary_width = _mm(geometry.margin)
    size.penalty_area_depth = _mm(geometry.defense_depth)
    size.penalty_area_width = _mm(geometry.defense_width)
    size.center_circle_radius = _mm(geometry.center_radius)
    size.line_thickness = _mm(_LINE_THICKNESS)
    size.ball_radius = BALL_RADIUS * _MM
    size.max_robot_radius = ROBOT_RADIUS * _MM
    for number, (name, x1, y1, x2, y2) in enumerate(_lines(geometry), start=2):
        size.field_lines.add(
            name=name,
            p1={"x": x1 * _MM, "y": y1 * _MM},
            p2={"x": x2 * _MM, "y": y2 * _MM},
            thickness=_LINE_THICKNESS * _MM,
            type=number,
        )
    size.field_arcs.add(
        name="CenterCircle",
        center={"x": 0.0, "y": 0.0},
        radius=geometry.center_radius * _MM,
        a1=0.0,
        a2=2 * pi,
        thickness=_LINE_THICKNESS * _MM,
        type=1,
    )
    return message


def write_vision(frame: CameraFrame | None, geometry: SSL_GeometryData | None = None) -> bytes:
    """Return a packet with a frame, a geometry, or both."""
    message = SSL_WrapperPacket(source="SSL_SOURCE_OTHER")
    if frame is not None:
        message.detection.CopyFrom(write_frame(frame))
    if geometry is not None:
        message.geometry.CopyFrom(geometry)
    return bytes(message.SerializeToString())


def _mm(metres: float) -> int:
    return round(metres * _MM)


def _lines(f: FieldGeometry) -> tuple[tuple[str, float, float, float, float], ...]:
    """Return name and ends of every line, in the order of the league's line types from 2 on."""
    x, y, edge, half = f.half_length, f.half_width, f.half_length - f.defense_depth, f.defense_width / 2
    return (
        ("TopTouchLine", -x, y, x, y),
        ("BottomTouchLine", -x, -y, x, -y),
        ("LeftGoalLine", -x, -y, -x, y),
        ("RightGoalLine", x, -y, x, y),
        ("HalfwayLine", 0.0, -y, 0.0, y),
        ("CenterLine", -x, 0.0, x, 0.0),
        ("LeftPenaltyStretch", -edge, -half, -edge, half),
        ("RightPenaltyStretch", edge, -half, edge, half),
        ("LeftFieldLeftPenaltyStretch", -x, half, -edge, half),
        ("LeftFieldRightPenaltyStretch", -x, -half, -edge, -half),
        ("RightFieldLeftPenaltyStretch", x, -half, edge, -half),
        ("RightFieldRightPenaltyStretch", x, half, edge, half),
    )
