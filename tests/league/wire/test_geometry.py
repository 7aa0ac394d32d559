"""The geometry packet holds all that clients need, and a field comes back from it as it was."""

from __future__ import annotations

from math import inf, nan, pi

import numpy as np
import pytest

from robobt.league.wire.geometry import CAMERA_HEIGHT, read_cameras, read_field, write_geometry
from robobt.league.wire.messages import SSL_GeometryCameraCalibration, SSL_GeometryFieldSize
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.vision import read_vision, write_vision
from robobt.sim.settings import preset
from robobt.world.field import DIVISION_A, DIVISION_B, FIELDS, FieldGeometry


@pytest.mark.parametrize("field", FIELDS.values(), ids=list(FIELDS))
def test_a_field_comes_back_as_it_was(field: FieldGeometry) -> None:
    packet = read_vision(write_vision(None, write_geometry(field)), PacketCounts())
    assert packet is not None
    assert packet.field == field


def test_defence_area_and_circle_are_read_from_the_lines_where_the_sizes_are_left_out() -> None:
    size = write_geometry(DIVISION_A).field
    for name in ("penalty_area_depth", "penalty_area_width", "center_circle_radius"):
        size.ClearField(name)
    found = read_field(size)
    assert found is not None
    assert found.defense_depth == pytest.approx(1.8)
    assert found.defense_width == pytest.approx(3.6)
    assert found.center_radius == 0.5


def test_without_lines_the_nearest_divisions_sizes_are_taken() -> None:
    bare = SSL_GeometryFieldSize(
        field_length=9050, field_width=6020, goal_width=1000, goal_depth=180, boundary_width=300
    )
    found = read_field(bare)
    assert found is not None
    assert (found.length, found.width) == (9.05, 6.02)
    assert found.defense_depth == DIVISION_B.defense_depth


@pytest.mark.parametrize("length", [0, -9000, 10**9])
def test_a_field_that_cannot_be_is_dropped(length: int) -> None:
    geometry = write_geometry(DIVISION_B)
    geometry.field.field_length = length
    counts = PacketCounts()
    assert read_vision(write_vision(None, geometry), counts) is None
    assert counts.implausible == 1


def test_the_field_of_grsims_packet_is_the_divisions() -> None:
    """It leaves sizes out, and its lines are drawn in their middle or beside the area."""
    size = SSL_GeometryFieldSize(
        field_length=9000,
        field_width=6000,
        goal_width=1000,
        goal_depth=180,
        boundary_width=300,
        boundary_width_goal_line=300,
        goal_substitution_area_width=0,
    )
    for name, x1, y1, x2, y2 in (
        ("LeftPenaltyStretch", -3495, -1000, -3495, 1000),
        ("LeftFieldLeftPenaltyStretch", -4490, 1000, -3490, 1000),
    ):
        size.field_lines.add(name=name, p1={"x": x1, "y": y1}, p2={"x": x2, "y": y2}, thickness=10)
    size.field_arcs.add(
        name="CenterCircle", center={"x": 0, "y": 0}, radius=495, a1=0, a2=2 * pi, thickness=10
    )
    assert read_field(size) == DIVISION_B


@pytest.mark.parametrize(
    ("field", "mark", "behind"), [(DIVISION_A, 8000, 600), (DIVISION_B, 6000, 300)], ids=["a", "b"]
)
def test_penalty_mark_and_margins_are_those_of_the_rules(
    field: FieldGeometry, mark: int, behind: int
) -> None:
    size = write_geometry(field).field
    assert size.goal_center_to_penalty_mark == mark
    assert (size.boundary_width, size.boundary_width_goal_line) == (300, behind)


def test_every_size_is_told() -> None:
    size = write_geometry(DIVISION_A).field
    told = {descriptor.name for descriptor, _ in size.ListFields()}
    assert told == {descriptor.name for descriptor in size.DESCRIPTOR.fields}


def test_the_lines_are_those_that_grsim_sends() -> None:
    lines = {line.name: line for line in write_geometry(DIVISION_B).field.field_lines}
    assert len(lines) == 18
    touch, goal = lines["TopTouchLine"], lines["RightGoalDepthLine"]
    assert (touch.p1.x, touch.p1.y, touch.p2.x, touch.p2.y) == (-4495, 2995, 4495, 2995)
    assert (touch.type, touch.thickness) == (2, 10)
    assert (goal.p1.x, goal.p1.y, goal.p2.y) == (4680, -500, 500)


def test_the_balls_model_is_that_of_the_simulator() -> None:
    ball = preset("grsim").ball
    model = write_geometry(DIVISION_B, ball=ball).models.straight_two_phase
    assert (model.acc_slide, model.acc_roll) == (-ball.slide_deceleration, -ball.roll_deceleration)
    assert model.k_switch == ball.switch_share


def seen_at(camera: SSL_GeometryCameraCalibration, x: float, y: float) -> tuple[float, float]:
    """Where a camera sees a point of the ground, by ssl-vision's model without distortion [mm, pixels]."""
    ax, ay, az, w = camera.q0, camera.q1, camera.q2, camera.q3
    axis = np.array([ax, ay, az])
    point = np.array([x, y, 0.0])
    turned = point + 2 * np.cross(axis, np.cross(axis, point) + w * point)
    seen = turned + np.array([camera.tx, camera.ty, camera.tz])
    assert seen[2] > 0.0
    u, v = camera.focal_length * seen[:2] / seen[2]
    return float(u + camera.principal_point_x), float(v + camera.principal_point_y)


def test_every_camera_sees_what_is_below_it_in_the_middle_of_its_picture() -> None:
    places = [(2.25, 1.5), (2.25, -1.5), (-2.25, -1.5), (-2.25, 1.5)]
    calibrations = write_geometry(DIVISION_B, places).calib
    assert [camera.camera_id for camera in calibrations] == [0, 1, 2, 3]
    for camera, (x, y) in zip(calibrations, places, strict=True):
        told = camera.derived_camera_world_tx, camera.derived_camera_world_ty
        assert told == (1000 * x, 1000 * y)
        middle = camera.principal_point_x, camera.principal_point_y
        assert seen_at(camera, *told) == pytest.approx(middle)
        # A metre farther along x, to the right in the picture.
        assert seen_at(camera, told[0] + 1000, told[1])[0] > middle[0]


@pytest.mark.parametrize("derived", [True, False])
def test_cameras_hang_where_their_calibration_has_them(derived: bool) -> None:
    message = write_geometry(DIVISION_B, [(2.25, 1.5), (-2.25, -1.5)])
    for camera in message.calib:
        if not derived:
            for name in ("tx", "ty", "tz"):
                camera.ClearField(f"derived_camera_world_{name}")
    found = read_cameras(message)
    assert found[0] == pytest.approx((2.25, 1.5, CAMERA_HEIGHT))
    assert found[1] == pytest.approx((-2.25, -1.5, CAMERA_HEIGHT))


@pytest.mark.parametrize("value", [nan, inf, 1e9, -4000.0, 0.0])
def test_a_camera_where_none_can_hang_is_left_out(value: float) -> None:
    message = write_geometry(DIVISION_B, [(0.0, 0.0)])
    message.calib[0].derived_camera_world_tz = value
    assert read_cameras(message) == {}


def test_a_calibration_without_a_direction_is_left_out() -> None:
    message = write_geometry(DIVISION_B, [(0.0, 0.0)])
    camera = message.calib[0]
    camera.ClearField("derived_camera_world_tz")
    camera.q0 = camera.q1 = camera.q2 = camera.q3 = 0.0
    assert read_cameras(message) == {}
