"""The numbers of a second of play as one text: every column of every tick."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Iterable, Sequence
from math import pi

import numpy as np
from numpy.typing import NDArray

from robobt.match.recording.header import RobotFlag
from robobt.world.geometry import FloatArray
from robobt.world.state import RobotId

BALL = 4
"""Columns of the ball: x, y, vx, vy."""

POSE = 7
"""Columns of a robot: x, y, heading, vx, vy, omega, whether the ball lies in its mouth."""

SENT = 5
"""Columns of a robot's command: vx, vy, omega, kick speed, flags."""

UNKNOWN = -(2**31)
"""The integer where there is no number."""

_TURN = 2**16
_LENGTH, _ANGLE, _SPEED, _FAST = 1e-5, 2.0 * pi / _TURN, 1e-4, 1e-3
_BALL_UNITS = (_LENGTH, _LENGTH, _FAST, _FAST)
_POSE_UNITS = (_LENGTH, _LENGTH, _ANGLE, _SPEED, _SPEED, _FAST, 1.0)
_SENT_UNITS = (_FAST, _FAST, _FAST, _FAST, 1.0)


class Columns:
    """The columns of a table of ticks: the ball's, each robot's, then each robot's command.

    Integers count 10 micrometres, 2^-16 of a turn, 0.1 mm/s of a robot's velocity and
    1e-3 m/s or rad/s of everything else: so fine that the differences from tick to tick
    of nearly all play fit 16 bits.
    """

    def __init__(self, robots: int) -> None:
        self.poses = BALL + POSE * robots
        self.count = self.poses + SENT * robots
        self.units = np.array([*_BALL_UNITS, *_POSE_UNITS * robots, *_SENT_UNITS * robots])
        self._scale = 1.0 / self.units
        self._headings = slice(BALL + 2, self.poses, POSE)

    def pack(self, table: FloatArray) -> str:
        """The table (ticks, columns) in SI units as text; NaN and what is too large become unknown.

        It holds the first row as 32-bit integers, then by column the differences
        from row to row as 16-bit integers, or as 32-bit ones where they do not fit;
        of either all lowest bytes come before the next ones. All in base64.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            scaled = np.rint(table * self._scale)
            known = np.abs(scaled) < 2.0**31
        if not known.all():
            scaled[~known] = UNKNOWN
        rows = scaled.T.astype(np.int32)
        # Differences wrap around, and so do the sums that undo them.
        steps = np.diff(rows)
        turns = steps[self._headings]
        turned = (turns + _TURN // 2) % _TURN - _TURN // 2
        short = steps.copy()
        short[self._headings] = turned
        fits = known.all() and (not short.size or (short.min() >= -(2**15) and short.max() < 2**15))
        body = _shuffled(short.astype("<i2")) if fits else _shuffled(steps.astype("<i4"))
        return base64.b64encode(_shuffled(rows[:, 0].astype("<i4")) + body).decode("ascii")

    def unpack(self, text: str, ticks: int) -> NDArray[np.int32]:
        """The integers (ticks, columns) of :meth:`pack`.

        Raises:
            ValueError: the text is not that of so many ticks.
        """
        try:
            data = base64.b64decode(text, validate=True)
        except (binascii.Error, ValueError) as error:
            raise ValueError(f"cannot be decoded ({error})") from None
        head, steps = 4 * self.count, self.count * (ticks - 1)
        width = 2 if len(data) == head + 2 * steps else 4
        if len(data) != head + width * steps:
            raise ValueError(f"must hold {ticks} x {self.count} numbers")
        rows = np.empty((self.count, ticks), np.int32)
        rows[:, 0] = _unshuffled(data[:head], 4)
        rows[:, 1:] = _unshuffled(data[head:], width).reshape(self.count, ticks - 1)
        rows = np.cumsum(rows, axis=1, dtype=np.int32)
        if width == 2:
            headings = rows[self._headings]
            rows[self._headings] = (headings + _TURN // 2) % _TURN - _TURN // 2
        return rows.T


class Snapshot:
    """Where the numbers that a world takes down itself belong among the columns.

    Args:
        world: in the order of the world's numbers its robots.
        robots: the robots of the columns.
    """

    def __init__(self, world: Sequence[RobotId], robots: Sequence[RobotId]) -> None:
        self._count, self._size = len(robots), len(world)
        self._slots: list[int] | slice = [slot for slot, robot in enumerate(robots) if robot in world]
        self._rows: list[int] | slice = [world.index(robot) for robot in robots if robot in world]
        if tuple(world) == tuple(robots):
            self._slots = self._rows = slice(None)

    def poses(self, taken: Iterable[bytes]) -> FloatArray:
        """The columns of ball and robots of what :meth:`Snapshots.snapshot` gave."""
        contact = 8 * (BALL + (POSE - 1) * self._size)
        rows = np.frombuffer(b"".join(taken), np.uint8).reshape(-1, contact + self._size)
        numbers = rows[:, :contact].copy().view(np.float64)
        table = np.full((len(rows), BALL + POSE * self._count), np.nan)
        table[:, :BALL] = numbers[:, :BALL]
        robots = table[:, BALL:].reshape(len(rows), self._count, POSE)
        poses = numbers[:, BALL:].reshape(len(rows), self._size, POSE - 1)
        robots[:, self._slots, :-1] = poses[:, self._rows]
        robots[:, self._slots, -1] = rows[:, contact:][:, self._rows]
        table[:, BALL:] = robots.reshape(len(rows), -1)
        return table

    def sent(self, taken: Iterable[bytes]) -> FloatArray:
        """The columns of commands of what :meth:`Snapshots.sent` gave."""
        sent: FloatArray = np.frombuffer(b"".join(taken)).reshape(-1, self._size, 6)[:, self._rows]
        table = np.zeros((len(sent), self._count, SENT))
        kick = np.where(
            sent[:, :, 4] > 0.0, RobotFlag.KICK.value, (RobotFlag.KICK | RobotFlag.KICK_NOW).value
        )
        dribbler = RobotFlag.DRIBBLER.value * sent[:, :, 5]
        flags = RobotFlag.COMMANDED.value + dribbler + kick * (sent[:, :, 3] != 0.0)
        table[:, self._slots, :-1] = sent[:, :, : SENT - 1]
        table[:, self._slots, -1] = flags
        return table.reshape(len(sent), -1)


def _shuffled(values: NDArray[np.signedinteger]) -> bytes:
    return values.reshape(-1, 1).view(np.uint8).T.tobytes()


def _unshuffled(data: bytes, width: int) -> NDArray[np.signedinteger]:
    planes = np.frombuffer(data, np.uint8).reshape(width, -1)
    return np.ascontiguousarray(planes.T).view(f"<i{width}")[:, 0]
