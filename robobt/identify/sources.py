"""Observations from files: recordings of robobt, and the league's logs."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np

from robobt.config.errors import RobobtError
from robobt.identify.observations import CameraViews, Observations
from robobt.identify.views import in_order, together
from robobt.league.log.files import LogKind, read_log
from robobt.league.log.names import is_log
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.vision import CameraFrame, read_vision
from robobt.match.recording import Recording, load_recording
from robobt.match.recording.header import RobotFlag
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.geometry import FloatArray
from robobt.world.state import RobotId

_LONGEST_AGE = 1.0
"""Ages of pictures beyond this come from clocks that differ [s]."""


class NothingToIdentifyError(RobobtError, ValueError):
    """A file does not show what cameras saw; the message is one line that names the file."""


def load_observations(path: Path) -> Observations:
    """Return what the cameras saw, and what robots were sent, from a file.

    Args:
        path: a recording (``*.robobt.arrows``), or a league log (``*.log``, ``*.log.gz``), which holds no
            commands.

    Returns:
        the observations.

    Raises:
        RecordingError: the file cannot be read as a recording.
        LogError: it is no league log.
        NothingToIdentifyError: it shows no robots, or does not show what cameras saw.
    """
    if is_log(path):
        return observations_of_log(path)
    return observations_of(load_recording(path))


def observations_of(recording: Recording) -> Observations:
    """Return what a recording holds of what cameras saw and robots were sent.

    Raises:
        NothingToIdentifyError: what cameras saw is unknown: the recording holds no detections, and the trees
            were shown predicted or filtered positions.
    """
    header, times = recording.header, recording.times
    robots = tuple(robot.id for robot in header.robots)
    sent = (recording.flags & RobotFlag.COMMANDED) > 0
    commands = np.zeros((*sent.shape, 6))
    commands[..., :5] = np.where(sent[..., None], recording.commands, 0.0)
    commands[..., 5] = sent & ((recording.flags & RobotFlag.DRIBBLER) > 0)
    commands[:, ~sent.any(axis=0)] = np.nan
    if recording.pictures is not None:
        seen = recording.pictures
        views = in_order(
            seen.times,
            seen.cameras,
            seen.ball.astype(np.float64),
            seen.robots.astype(np.float64),
            recording.cameras,
        )
        return _observations(header.field, robots, views, times, commands, seen.ages)
    if recording.observed is not None and not header.cameras_show_truth:
        raise NothingToIdentifyError(
            f"{recording.path}: does not say what cameras saw, only what trees were shown; record the match "
            "again with this version of robobt"
        )
    ball, poses = recording.truth.ball[:, :2], recording.truth.robots[:, :, :3]
    return Observations(
        header.field, robots, times, ball.astype(np.float64), poses.astype(np.float64), times, commands
    )


def _observations(
    field: FieldGeometry,
    robots: tuple[RobotId, ...],
    views: CameraViews,
    sent: FloatArray,
    commands: FloatArray,
    ages: FloatArray,
) -> Observations:
    pictures = together(views)
    good = np.all((ages >= -1e-6) & (ages < _LONGEST_AGE))
    several = len(set(views.cameras.tolist())) > 1
    return Observations(
        field,
        robots,
        pictures.times,
        pictures.ball,
        pictures.poses,
        sent,
        commands,
        float(np.median(ages)) if good else 0.0,
        pictures.cameras if several else None,
        views if several or views.places else None,
        pictures.alone,
    )


def observations_of_log(path: Path) -> Observations:
    """Return what the cameras of a league log saw.

    Raises:
        LogError: the file is no league log.
        NothingToIdentifyError: it holds no vision, or no robot.
    """
    counts, field = PacketCounts(), DIVISION_B
    frames: list[CameraFrame] = []
    places: dict[int, tuple[float, float, float]] = {}
    for record in read_log(path):
        if record.kind in (LogKind.VISION, LogKind.VISION_2010):
            packet = read_vision(record.data, counts)
            if packet is not None:
                field = packet.field or field
                places |= packet.cameras
                if packet.frame is not None:
                    frames.append(packet.frame)
    sights = Counter(robot.robot for frame in frames for robot in frame.robots)
    # A number that is misread now and then is no robot.
    robots = tuple(sorted(robot for robot, count in sights.items() if count > len(frames) / 100))
    if not robots:
        raise NothingToIdentifyError(f"{path}: shows no robots; a log with vision is needed")
    place = {robot: i for i, robot in enumerate(robots)}
    ball = np.full((len(frames), 2), np.nan)
    poses = np.full((len(frames), len(robots), 3), np.nan)
    for row, frame in enumerate(frames):
        best = max(frame.balls, key=lambda it: it.confidence, default=None)
        if best is not None:
            ball[row] = best.x, best.y
        for it in frame.robots:
            if it.robot in place and it.heading is not None:
                poses[row, place[it.robot]] = it.x, it.y, it.heading
    views = in_order(
        np.array([frame.captured for frame in frames]),
        np.array([frame.camera for frame in frames]),
        ball,
        poses,
        places,
    )
    ages = np.array([frame.sent - frame.captured for frame in frames])
    return _observations(field, robots, views, np.zeros(0), np.zeros((0, len(robots), 6)), ages)
