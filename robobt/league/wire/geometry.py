"""SSL-Vision's geometry of a field, converted to and from SI units.

Source of the fields: ssl-vision's geometry messages (millimetres there). What is written
has the lines, arcs and models that grSim sends, and the sizes that it leaves out.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import nan, pi
from typing import NamedTuple

from pydantic import ValidationError

from robobt.league.wire.messages import (
    SSL_GeometryCameraCalibration,
    SSL_GeometryData,
    SSL_GeometryFieldSize,
)
from robobt.league.wire.packets import MM_PER_M, on_field
from robobt.sim.settings import BallSettings
from robobt.sim.sight import CAMERA_HEIGHT
from robobt.world.field import DIVISION_A, DIVISION_B, FieldGeometry
from robobt.world.geometry import Point
from robobt.world.presence import GOAL_SUBSTITUTION_WIDTH
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_LINE_THICKNESS = 0.01
"""Width of the field's lines [m]. Source: RoboCup SSL rules."""

_GOAL_HEIGHT = 0.16
"""Height of the goals [m]. Source: RoboCup SSL rules."""

_CEILING = (1.0, 50.0)
"""Least and greatest height at which a camera can be [m]."""

_FOCAL_LENGTH, _IMAGE = 390.0, (780, 580)
"""Of a camera that sees a quarter of a division B field from there [pixels]."""


class CameraPlace(NamedTuple):
    """Where a camera is; z counts from the ground [m]."""

    x: float
    y: float
    z: float = CAMERA_HEIGHT


def read_cameras(message: SSL_GeometryData) -> dict[int, CameraPlace]:
    """Return where the cameras of a geometry packet are, by number, but for those that can be nowhere."""
    found = {}
    for camera in message.calib:
        if camera.HasField("derived_camera_world_tz"):
            place = (
                camera.derived_camera_world_tx,
                camera.derived_camera_world_ty,
                camera.derived_camera_world_tz,
            )
        else:
            place = _origin(camera)
        x, y, z = (value / MM_PER_M for value in place)
        # NaN compares as false.
        if on_field(x, y) and _CEILING[0] <= z <= _CEILING[1]:
            found[camera.camera_id] = CameraPlace(x, y, z)
    return found


def _origin(camera: SSL_GeometryCameraCalibration) -> tuple[float, float, float]:
    """Return where a camera is from how it turns (x, y, z, w) and shifts the field's coordinates [mm]."""
    x, y, z, w = camera.q0, camera.q1, camera.q2, camera.q3
    square = x * x + y * y + z * z + w * w
    if not square > 0.0:
        return (nan, nan, nan)
    # The shift turned back: t + 2 w (t x q) + 2 (t x q) x q, of a quaternion that need not be of length 1.
    t = camera.tx, camera.ty, camera.tz
    q = x, y, z
    once = _cross(t, q)
    twice = _cross(once, q)
    back = [a + 2.0 * (w * b + c) / square for a, b, c in zip(t, once, twice, strict=True)]
    return (-back[0], -back[1], -back[2])


_Vector = tuple[float, float, float]


def _cross(a: _Vector, b: _Vector) -> _Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def read_field(message: SSL_GeometryFieldSize) -> FieldGeometry | None:
    """Return the field of a geometry packet; None when no such field can exist.

    Sizes that the packet leaves out are taken from the field's lines and arcs, or
    else from the division whose length is nearest.
    """
    length, width = message.field_length / MM_PER_M, message.field_width / MM_PER_M
    division = min((DIVISION_A, DIVISION_B), key=lambda division: abs(division.length - length))
    depth, across = message.penalty_area_depth / MM_PER_M, message.penalty_area_width / MM_PER_M
    lines = {line.name: line for line in message.field_lines}
    # As the game controller does; grSim's front line lies half its thickness off.
    side, front = lines.get("LeftFieldLeftPenaltyStretch"), lines.get("LeftPenaltyStretch")
    if not message.HasField("penalty_area_depth"):
        depth = division.defense_depth if side is None else abs(side.p1.x - side.p2.x) / MM_PER_M
    if not message.HasField("penalty_area_width"):
        across = division.defense_width if front is None else abs(front.p1.y - front.p2.y) / MM_PER_M
    radius = message.center_circle_radius / MM_PER_M
    if not message.HasField("center_circle_radius"):
        circles = [arc for arc in message.field_arcs if arc.name == "CenterCircle"]
        # An arc is the middle of its line.
        radius = (
            (circles[0].radius + circles[0].thickness / 2) / MM_PER_M if circles else division.center_radius
        )
    goal_depth = message.goal_depth / MM_PER_M or division.goal_depth
    least, margin = max(goal_depth, 0.2), message.boundary_width / MM_PER_M
    behind = margin
    if message.HasField("boundary_width_goal_line"):
        behind = message.boundary_width_goal_line / MM_PER_M
    try:
        return FieldGeometry(
            length=length,
            width=width,
            goal_width=message.goal_width / MM_PER_M,
            goal_depth=goal_depth,
            defense_width=across,
            defense_depth=depth,
            center_radius=radius,
            margin=max(margin, least),
            goal_line_margin=max(behind, least),
        )
    except ValidationError:
        return None


def write_geometry(
    field: FieldGeometry, cameras: Sequence[Point | CameraPlace] = (), ball: BallSettings | None = None
) -> SSL_GeometryData:
    """Return the geometry message of a field.

    ``cameras`` are the places of those over it, by number [m]; without ``ball`` it leaves out how that moves.
    """
    message = SSL_GeometryData()
    _write_size(message.field, field)
    for number, place in enumerate(cameras):
        _write_camera(message, number, CameraPlace(*place))
    if ball is not None:
        straight = message.models.straight_two_phase
        straight.acc_slide, straight.acc_roll = -ball.slide_deceleration, -ball.roll_deceleration
        straight.k_switch = ball.switch_share
        chip = message.models.chip_fixed_loss
        chip.damping_xy_first_hop, chip.damping_xy_other_hops = ball.first_hop, ball.other_hops
        chip.damping_z = ball.rebound
    return message


def _write_size(size: SSL_GeometryFieldSize, field: FieldGeometry) -> None:
    size.field_length = _mm(field.length)
    size.field_width = _mm(field.width)
    size.goal_width = _mm(field.goal_width)
    size.goal_depth = _mm(field.goal_depth)
    size.goal_height = _mm(_GOAL_HEIGHT)
    size.boundary_width = _mm(field.margin)
    size.boundary_width_goal_line = _mm(field.goal_line_margin)
    # The rules have it in division A only, the game controller's default geometry in both.
    size.goal_substitution_area_width = _mm(min(GOAL_SUBSTITUTION_WIDTH, field.goal_line_margin))
    size.penalty_area_depth = _mm(field.defense_depth)
    size.penalty_area_width = _mm(field.defense_width)
    size.goal_center_to_penalty_mark = _mm(field.penalty_distance)
    size.center_circle_radius = _mm(field.center_radius)
    size.line_thickness = _mm(_LINE_THICKNESS)
    size.ball_radius = BALL_RADIUS * MM_PER_M
    size.max_robot_radius = ROBOT_RADIUS * MM_PER_M
    for kind, (name, x1, y1, x2, y2) in _lines(field):
        line = size.field_lines.add(
            name=name,
            p1={"x": x1 * MM_PER_M, "y": y1 * MM_PER_M},
            p2={"x": x2 * MM_PER_M, "y": y2 * MM_PER_M},
            thickness=_LINE_THICKNESS * MM_PER_M,
        )
        if kind is not None:
            line.type = kind
    size.field_arcs.add(
        name="CenterCircle",
        center={"x": 0.0, "y": 0.0},
        radius=(field.center_radius - _LINE_THICKNESS / 2) * MM_PER_M,
        a1=0.0,
        a2=2 * pi,
        thickness=_LINE_THICKNESS * MM_PER_M,
        type=1,
    )


def _write_camera(message: SSL_GeometryData, number: int, place: CameraPlace) -> None:
    """Add a camera that looks straight down, its picture's x axis along the field's."""
    message.calib.add(
        camera_id=number,
        focal_length=_FOCAL_LENGTH,
        principal_point_x=_IMAGE[0] / 2,
        principal_point_y=_IMAGE[1] / 2,
        distortion=0.0,
        # x, y, z, w: half a turn about x; and the field's centre as the camera sees it.
        q0=1.0,
        q1=0.0,
        q2=0.0,
        q3=0.0,
        tx=-place.x * MM_PER_M,
        ty=place.y * MM_PER_M,
        tz=place.z * MM_PER_M,
        derived_camera_world_tx=place.x * MM_PER_M,
        derived_camera_world_ty=place.y * MM_PER_M,
        derived_camera_world_tz=place.z * MM_PER_M,
        pixel_image_width=_IMAGE[0],
        pixel_image_height=_IMAGE[1],
    )


def _mm(metres: float) -> int:
    return round(metres * MM_PER_M)


_Line = tuple[str, float, float, float, float]


def _lines(f: FieldGeometry) -> list[tuple[int | None, _Line]]:
    """Return type, name and ends of every line; outer lines run in their middle, as grSim's do."""
    x, y, half = f.half_length, f.half_width, f.defense_width / 2
    edge, post, back = f.half_length - f.defense_depth, f.goal_width / 2, f.half_length + f.goal_depth
    in_x, in_y = x - _LINE_THICKNESS / 2, y - _LINE_THICKNESS / 2
    named = [
        ("TopTouchLine", -in_x, in_y, in_x, in_y),
        ("BottomTouchLine", -in_x, -in_y, in_x, -in_y),
        ("LeftGoalLine", -in_x, -in_y, -in_x, in_y),
        ("RightGoalLine", in_x, -in_y, in_x, in_y),
        ("HalfwayLine", 0.0, -in_y, 0.0, in_y),
        ("CenterLine", -in_x, 0.0, in_x, 0.0),
        ("LeftPenaltyStretch", -edge, -half, -edge, half),
        ("RightPenaltyStretch", edge, -half, edge, half),
        ("LeftFieldLeftPenaltyStretch", -x, half, -edge, half),
        ("LeftFieldRightPenaltyStretch", -x, -half, -edge, -half),
        ("RightFieldLeftPenaltyStretch", x, -half, edge, -half),
        ("RightFieldRightPenaltyStretch", x, half, edge, half),
    ]
    goals = [
        ("RightGoalTopLine", x, post, back, post),
        ("RightGoalBottomLine", x, -post, back, -post),
        ("RightGoalDepthLine", back, -post, back, post),
        ("LeftGoalTopLine", -x, post, -back, post),
        ("LeftGoalBottomLine", -x, -post, -back, -post),
        ("LeftGoalDepthLine", -back, -post, -back, post),
    ]
    # The league's types of the named lines go from 2 on; those of the goals have none.
    kinds = [*range(2, 2 + len(named)), *[None] * len(goals)]
    return list(zip(kinds, [*named, *goals], strict=True))
