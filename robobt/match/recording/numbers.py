"""Frames and commands as columns of numbers, and back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain
from math import nan

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from robobt.match.recording.header import RobotFlag
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.game import Team
from robobt.world.state import Frame, RobotId

BALL = 4
"""Numbers of the ball: x, y, vx, vy."""

POSE = 7
"""Numbers of a robot: x, y, heading, vx, vy, omega, whether the ball lies in its mouth."""

COMMAND = 5
"""Numbers of a command: vx, vy, omega, kick speed, flags."""

# Powers of two, for the bits of a number that are zero cost no space in the file.
_BALL_STEPS = (2**-16, 2**-16, 2**-10, 2**-10)
_POSE_STEPS = (2**-16, 2**-16, 2**-14, 2**-13, 2**-13, 2**-10, 1.0)
_COMMAND_STEPS = (2**-10, 2**-10, 2**-10, 2**-10, 1.0)
_FARTHEST = 1e4

_NOWHERE = (nan,) * POSE
_NO_COMMAND = (0.0,) * COMMAND
# Plain integers: operators on flags are calls of Python.
_COMMANDED = RobotFlag.COMMANDED.value
_DRIBBLING = (RobotFlag.COMMANDED | RobotFlag.DRIBBLER).value
_KICK = RobotFlag.KICK.value
_KICK_NOW = (RobotFlag.KICK | RobotFlag.KICK_NOW).value


class TickNumbers:
    """Makes the columns of a recording.

    Args:
        robots: in the order of the columns; all others are left out.
    """

    def __init__(self, robots: Sequence[RobotId]) -> None:
        self._slots = {robot: slot for slot, robot in enumerate(robots)}
        self._sides = [(robot.team is Team.YELLOW, robot.number) for robot in robots]

    def poses(self, frames: Sequence[Frame]) -> pa.Array:
        """Return the column ``truth`` or ``observed``."""
        rows: list[tuple[float, ...]] = []
        for frame in frames:
            blue = frame.seen_by(Team.BLUE)
            ball = blue.ball
            rows.append((ball.x, ball.y, ball.vx, ball.vy))
            sides = {it.id: it for it in blue.own}, {it.id: it for it in blue.opponents}
            for side, number in self._sides:
                it = sides[side].get(number)
                rows.append(
                    (it.x, it.y, it.heading, it.vx, it.vy, it.omega, it.ball_contact) if it else _NOWHERE
                )
        return _column(rows, len(frames), (*_BALL_STEPS, *_POSE_STEPS * len(self._slots)))

    def commands(self, sent: Sequence[Mapping[RobotId, RobotCommand]]) -> pa.Array:
        """Return the column ``commands``."""
        rows: list[tuple[float, ...]] = []
        robots: list[RobotId] = []
        slots: list[int | None] = []
        for commands in sent:
            if list(commands) != robots:
                # A team's hash is a call of Python, too slow to look up every robot at every tick.
                robots = list(commands)
                slots = [self._slots.get(robot) for robot in robots]
            cells = [_NO_COMMAND] * len(self._slots)
            for slot, it in zip(slots, commands.values(), strict=True):
                if slot is None:
                    continue
                flags = _DRIBBLING if it.dribbler else _COMMANDED
                if it.kick_speed:
                    flags += _KICK_NOW if it.kick_trigger is KickTrigger.NOW else _KICK
                cells[slot] = it.vx, it.vy, it.omega, it.kick_speed, flags
            rows += cells
        return _column(rows, len(sent), _COMMAND_STEPS * len(self._slots))


def numbers_of(column: pa.FixedSizeListArray) -> NDArray[np.float32]:
    """Return the table (ticks, numbers) of such a column; what no column of ours holds is unknown."""
    table = column.flatten().to_numpy(zero_copy_only=False).reshape(len(column), column.type.list_size)
    return np.where(np.abs(table) < _FARTHEST, table, np.float32(np.nan))


def _column(rows: list[tuple[float, ...]], ticks: int, steps: tuple[float, ...]) -> pa.Array:
    """Return the column of numbers that stand one after the other, rounded to what is kept of them."""
    table = np.fromiter(chain.from_iterable(rows), np.float64, ticks * len(steps)).reshape(ticks, len(steps))
    kept = np.where(np.abs(table) < _FARTHEST, table, nan)
    rounded = (np.rint(kept / steps) * steps).astype(np.float32)
    kind = pa.list_(pa.float32(), len(steps))
    return pa.Array.from_buffers(kind, ticks, [None], children=[pa.array(rounded.reshape(-1))])
