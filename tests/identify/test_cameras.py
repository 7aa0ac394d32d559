"""By how much cameras see things shifted is found where two of them see the same thing."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from robobt.identify.cameras import CameraEstimate, CameraOffset, identify_cameras
from robobt.identify.estimate import Estimate, unseen
from robobt.identify.observations import CameraViews, Observations
from robobt.identify.sources import load_observations
from robobt.identify.views import together, without_offsets
from robobt.sim import SimSettings, SimWorld
from robobt.sim.realism import RealismSettings
from robobt.sim.sight import camera_places, offset_of
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.protocol import Placement
from tests.identify.made import PERIOD, ROBOT, logged

OFFSET = 0.02


def crossing(world: SimWorld) -> Iterator[dict[object, RobotCommand]]:
    """Yield commands with which blue 0 drives round the field's centre, where all cameras see it."""
    world.reset(Placement(robots={ROBOT: (0.5, 0.0, 1.57)}, ball=(-1.0, 2.0, 0.0, 0.0)), 0)
    for _ in range(round(12.0 / PERIOD)):
        yield {ROBOT: RobotCommand(0.8, 0.0, 1.6)}


def identified(folder: Path, cameras: int, overlap: float) -> CameraEstimate:
    realism = RealismSettings(
        ball_noise=0.001, robot_noise=0.001, object_offset=OFFSET, camera_overlap=overlap, missing_ball=0.05
    )
    world = SimWorld(DIVISION_B, {ROBOT: None}, SimSettings(realism=realism), PERIOD)
    logged(folder / "field.log", world, crossing(world), cameras)  # type: ignore[arg-type]
    return identify_cameras(load_observations(folder / "field.log").views)


@pytest.mark.parametrize("cameras", [2, 4])
def test_each_camera_is_known_from_what_others_saw_at_once(cameras: int, tmp_path: Path) -> None:
    found = identified(tmp_path, cameras, overlap=0.7)
    assert found.size.seen
    assert found.size.value == pytest.approx(OFFSET, abs=0.001)
    assert found.size.low < OFFSET < found.size.high
    for camera, place in enumerate(camera_places(DIVISION_B, cameras)):
        for figure, truth in zip(found.offsets[camera], offset_of(place, OFFSET), strict=True):
            assert figure.seen
            assert figure.value == pytest.approx(truth, abs=0.001)


def test_cameras_that_see_nothing_together_cannot_be_compared(tmp_path: Path) -> None:
    found = identified(tmp_path, 4, overlap=0.0)
    assert sorted(found.offsets) == [0, 1, 2, 3]
    assert not any(figure.seen for offset in found.offsets.values() for figure in offset)
    assert not found.size.seen


def test_one_camera_has_nothing_to_be_compared_with(tmp_path: Path) -> None:
    assert identified(tmp_path, 1, overlap=0.5).offsets == {}


def test_cameras_that_take_turns_are_compared_by_what_moves_on_between() -> None:
    """Real cameras take their pictures at different moments, meanwhile robots drive on."""
    rng = np.random.default_rng(3)
    times = np.arange(0.0, 10.0, 1 / 140)
    cameras = np.arange(len(times)) % 2
    poses = np.zeros((len(times), 1, 3))
    poses[:, 0, 0] = 1.5 * np.sin(times) + np.where(cameras == 0, 0.012, -0.012)
    poses[:, 0, :2] += rng.normal(0.0, 0.001, (len(times), 2))
    nothing = np.full((len(times), 2), np.nan)
    found = identify_cameras(CameraViews(times, cameras, nothing, poses, {}))
    assert found.offsets[0].x.value == pytest.approx(0.012, abs=0.0005)
    assert found.offsets[1].x.low < -0.012 < found.offsets[1].x.high
    assert found.offsets[0].y.value == pytest.approx(0.0, abs=0.0005)


def test_a_part_that_ends_between_two_views_of_a_picture_stays_whole() -> None:
    times = (np.arange(120)[:, None] / 60 + [0.0, 0.001]).ravel()
    cameras = np.tile([0, 1], 120)
    poses = np.zeros((len(times), 1, 3))
    poses[:, 0, 0] = np.sin(times)
    views = CameraViews(times, cameras, poses[:, 0, :2], poses, {})
    seen = together(views)
    whole = Observations(
        DIVISION_B,
        (ROBOT,),
        seen.times,
        seen.ball,
        seen.poses,
        np.zeros(0),
        np.zeros((0, 1, 6)),
        cameras=seen.cameras,
        views=views,
    )
    known = CameraOffset(Estimate(0.01, 0.0, 0.02, 9, True), Estimate(0.0, -0.01, 0.01, 9, True))
    part = without_offsets(whole.between(0.0, 1.0), CameraEstimate({0: known}, unseen()))
    assert part.cameras is not None
    assert len(part.times) == len(part.ball) == len(part.poses) == len(part.cameras)
