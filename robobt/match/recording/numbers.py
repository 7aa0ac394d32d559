"""Frames and commands as columns of numbers, and back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import nan
from struct import pack

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from robobt.match.recording.header import RobotFlag
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.detections import Detections
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.state import RobotId

BALL_NUMBERS = 6
"""Values per ball: x, y, vx, vy, z, vz."""

POSE = 7
"""Values per robot: x, y, heading, vx, vy, omega, whether the ball is in its mouth."""

COMMAND_NUMBERS = 6
"""Values per command: vx, vy, omega, kick speed, kick angle, flags."""

DETECTION_HEAD, DETECTED_POSE = 4, 3
"""Values of a picture (camera, age, ball x, y) and, behind them, of each robot in it (x, y, heading)."""

DETECTIONS_TYPE = pa.list_(pa.float32())
"""Type of the column ``detections``: the pictures of a tick, one behind the other."""

# Powers of two, because zero bits of a number take no space in the file.
_BALL_STEPS = (2**-16, 2**-16, 2**-10, 2**-10, 2**-16, 2**-10)
_POSE_STEPS = (2**-16, 2**-16, 2**-14, 2**-13, 2**-13, 2**-10, 1.0)
_COMMAND_STEPS = (2**-10, 2**-10, 2**-10, 2**-10, 2**-14, 1.0)
_FARTHEST_NUMBER = 1e4

_NO_COMMAND = RobotCommand()


class TickNumbers:
    """Makes the columns of a recording for these robots in this order."""

    def __init__(self, robots: Sequence[RobotId]) -> None:
        self._slots = {robot: slot for slot, robot in enumerate(robots)}
        # In the order in which a match lists its commands, so that none has to be looked up.
        self._usual = sorted(robots, key=lambda robot: (robot.team is Team.YELLOW, robot.number))

    def poses(self, frames: Sequence[bytes]) -> pa.Array:
        """Return the column ``truth`` or ``observed`` of frames from blue's side, packed."""
        table = np.full((len(frames), BALL_NUMBERS + POSE * len(self._slots)), nan)
        alike: dict[int, list[int]] = {}
        for tick, frame in enumerate(frames):
            alike.setdefault(len(frame), []).append(tick)
        for ticks in alike.values():
            packed = np.frombuffer(b"".join([frames[tick] for tick in ticks]), "<f8")
            self._fill(table, ticks, packed.reshape(len(ticks), -1))
        return _column(table, (*_BALL_STEPS, *_POSE_STEPS * len(self._slots)))

    def commands(self, sent: Sequence[Mapping[RobotId, RobotCommand]]) -> pa.Array:
        """Return the column ``commands``."""
        usual, now = self._usual, KickTrigger.NOW
        numbers: list[float] = []
        for commands in sent:
            each = list(commands.values())
            if list(commands) != usual:
                each = [commands.get(robot, _NO_COMMAND) for robot in usual]
            for it in each:
                at_once, commanded = it.kick_trigger is now, it is not _NO_COMMAND
                numbers += (it.vx, it.vy, it.omega, it.kick_speed, it.kick_angle)
                numbers += (it.dribbler, at_once, commanded)
        # This is several times as fast as making an array of a list with numpy.
        packed = np.frombuffer(pack(f"={len(numbers)}d", *numbers)).reshape(len(sent), len(usual), 8)
        cells = packed[:, [usual.index(robot) for robot in self._slots]]
        dribbling, at_once, commanded = [cells[:, :, i] != 0.0 for i in (5, 6, 7)]
        kicking = cells[:, :, 3] != 0.0
        table = cells[:, :, :COMMAND_NUMBERS].copy()
        table[:, :, -1] = (
            RobotFlag.COMMANDED.value * commanded
            + RobotFlag.DRIBBLER.value * dribbling
            + RobotFlag.KICK.value * kicking
            + RobotFlag.KICK_NOW.value * (kicking & at_once)
        )
        return _column(table.reshape(len(sent), -1), _COMMAND_STEPS * len(usual))

    def detections(self, seen: Sequence[tuple[float, Sequence[Detections]]]) -> pa.Array | None:
        """Return the column ``detections`` from ticks' times and what cameras saw; None for nothing."""
        if not any(pictures for _, pictures in seen):
            return None
        width = DETECTION_HEAD + DETECTED_POSE * len(self._slots)
        rows: list[list[float] | None] = []
        for time, pictures in seen:
            table = np.full((len(pictures), width), nan)
            for row, picture in zip(table, pictures, strict=True):
                row[:2] = picture.camera, time - picture.captured
                if picture.ball is not None:
                    row[2:DETECTION_HEAD] = picture.ball
                for robot, pose in picture.robots.items():
                    if robot in self._slots:
                        at = DETECTION_HEAD + DETECTED_POSE * self._slots[robot]
                        row[at : at + DETECTED_POSE] = pose
            steps = np.array((1.0, 2**-16, 2**-16, 2**-16, *(2**-16, 2**-16, 2**-14) * len(self._slots)))
            rows.append((np.rint(table / steps) * steps).reshape(-1).tolist() if len(pictures) else None)
        return pa.array(rows, DETECTIONS_TYPE)

    def _fill(self, table: FloatArray, ticks: list[int], packed: FloatArray) -> None:
        """Enter packed frames (frames, numbers) with this many robots into the rows of their ticks."""
        own = int(packed[0, 5])
        robots = (packed.shape[1] - 7) // 8
        places = [6 + 8 * i + (i >= own) for i in range(robots)]
        numbers = packed[:, [5, *places]]
        if (numbers != numbers[0]).any():
            # The same number of robots, but different robots.
            for i, tick in enumerate(ticks):
                self._fill(table, [tick], packed[i : i + 1])
            return
        # Frames with the ball on the ground have no height.
        flying = packed.shape[1] - 7 > 8 * robots
        columns, taken = [*range(BALL_NUMBERS if flying else 4)], [*range(1, 5)]
        if flying:
            taken += packed.shape[1] - 2, packed.shape[1] - 1
        else:
            table[ticks, 4:BALL_NUMBERS] = 0.0
        for i, place in enumerate(places):
            robot = RobotId(Team.BLUE if i < own else Team.YELLOW, int(packed[0, place]))
            if robot in self._slots:
                at = BALL_NUMBERS + POSE * self._slots[robot]
                columns += range(at, at + POSE)
                taken += range(place + 1, place + 8)
        table[np.ix_(ticks, columns)] = packed[:, taken]


def numbers_of(column: pa.FixedSizeListArray) -> NDArray[np.float32]:
    """Return the table (ticks, numbers) of such a column; values that robobt never writes become unknown."""
    table = column.flatten().to_numpy(zero_copy_only=False).reshape(len(column), column.type.list_size)
    return np.where(np.abs(table) < _FARTHEST_NUMBER, table, np.float32(np.nan))


def _column(table: FloatArray, steps: tuple[float, ...]) -> pa.Array:
    """Return the column of a table (ticks, numbers), rounded to the precision of a recording."""
    kept = np.where(np.abs(table) < _FARTHEST_NUMBER, table, nan)
    rounded = (np.rint(kept / steps) * steps).astype(np.float32)
    kind = pa.list_(pa.float32(), len(steps))
    return pa.Array.from_buffers(kind, len(table), [None], children=[pa.array(rounded.reshape(-1))])
