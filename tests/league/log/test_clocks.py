"""A log of several vision computers shows the whole field, however their clocks differ."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.league.log.files import LogKind, LogWriter, read_log
from robobt.league.log.world import LogWorld
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection, write_vision
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

PERIOD = 1 / 60
SECONDS = 5.0
SPEED = 0.5


def detections(camera: int, now: float) -> CameraFrame:
    """What a camera sees of its robot, which drives up from the line y = -2 m at 0.5 m/s."""
    robot = RobotDetection(RobotId(Team.BLUE, camera), 2.0 * camera - 3.0, SPEED * now - 2.0, 0.0)
    return CameraFrame(camera, round(now / PERIOD), now, now + 0.005, [BallDetection(0.0, 0.0)], [robot])


def write_log(path: Path, apart: list[float], jump: float = 0.0) -> Path:
    """A log of cameras whose clocks are so far ahead, the last one's by ``jump`` more from halfway on [s]."""
    start = 1_700_000_000_000_000_000
    with LogWriter(path) as log:
        for i in range(round(SECONDS / PERIOD)):
            for camera, ahead in enumerate(apart):
                now = i * PERIOD + camera * 0.003
                frame = detections(camera, now)
                frame.captured += 1000.0 + ahead
                if camera == len(apart) - 1 and now > SECONDS / 2:
                    frame.captured += jump
                frame.sent = frame.captured + 0.005
                received = start + round((now + 0.006) * 1e9)
                log.write(received, LogKind.VISION, write_vision(frame))
    return path


def largest_error(path: Path, cameras: int) -> float:
    """Play a log; return how far robots are from where they were, at most; infinity if one is missing [m]."""
    world = LogWorld(path)
    world.reset(Placement(), 0)
    for _ in range(30):
        world.act({})
    worst = 0.0
    while not world.ended:
        world.act({})
        robots = world.observe().own
        if len(robots) < cameras:
            return float("inf")
        now = (world._clock - world._began) * 1e-9
        worst = max(worst, *(abs(robot.y + 2.0 - SPEED * now) for robot in robots))
    return worst


@pytest.mark.parametrize(
    "apart",
    [[0.0, 2.0], [0.0, -2.0], [0.0, 0.3], [1.7e9, 0.0], [0.0, -1e6, 2.0, 0.04]],
    ids=["ahead", "behind", "a little", "another epoch", "four"],
)
def test_the_whole_field_is_seen_under_clocks_that_differ(tmp_path: Path, apart: list[float]) -> None:
    error = largest_error(write_log(tmp_path / "game.log", apart), len(apart))
    print(f"clocks {apart} s ahead: at most {error * 1000:.1f} mm off")
    assert error < 0.04


@pytest.mark.parametrize("jump", [2.0, -2.0, 0.4, -0.4, -60.0])
def test_a_clock_that_is_set_within_the_log_costs_no_robot(tmp_path: Path, jump: float) -> None:
    error = largest_error(write_log(tmp_path / "game.log", [0.0, 2.0], jump), 2)
    print(f"a clock set by {jump:g} s: at most {error * 1000:.1f} mm off")
    assert error < 0.2


def test_a_pause_in_which_the_cameras_clocks_stood_still_costs_no_camera(tmp_path: Path) -> None:
    path, hour = tmp_path / "paused.log", 3_600_000_000_000
    records = list(read_log(write_log(tmp_path / "game.log", [0.0, 2.0])))
    with LogWriter(path) as log:
        for i, (time, _, data) in enumerate(records):
            log.write(time + (hour if i > len(records) / 2 else 0), LogKind.VISION, data)
    world = LogWorld(path)
    world.reset(Placement(), 0)
    while not world.ended:
        world.act({})
    last = SPEED * SECONDS - 2.0
    assert [robot.y for robot in world.observe().own] == pytest.approx([last, last], abs=0.03)
