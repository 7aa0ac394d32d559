"""Count passes as the passing challenge of 2024 and 2025 defines them, from true frames alone.

The challenge's judge and the training task ask the same class, which counts on many fields at a time.
Source: RoboCup SSL team vs. team passing challenge, 2025. A pass leads from where a robot kicks the ball to
where the ball stops or is deflected. It counts if both ends lie inside the lines and at least 1 m apart, the
robots at both ends are team-mates, and the ball never exceeds 6.5 m/s. The rules do not say whether a robot
may pass to itself; here it may not.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robobt.world.field import FieldGeometry
from robobt.world.game import STARTED, GameState, Team
from robobt.world.geometry import FloatArray
from robobt.world.rules import touches
from robobt.world.state import BALL_RADIUS, Frame, RobotId

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

LEAST_LENGTH = 1.0
"""Least length of a pass [m]."""

MOST_SPEED = 6.5
"""Greatest speed of the ball in a pass [m/s]."""

_STOPPED_BELOW = 0.05
"""A ball slower than this has stopped [m/s]."""


_MOST_ROBOTS = 32
"""Robots of both teams that a match may have."""


class PassCounts:
    """Counts both teams' passes on many fields.

    Args:
        n: number of fields.
        field: their size.
    """

    def __init__(self, n: int, field: FieldGeometry) -> None:
        self._lines = np.array([field.half_length, field.half_width])
        # The ball on its way: whence, from which robot, its greatest speed, and where it stopped if it did.
        self._flying = np.zeros(n, dtype=np.bool_)
        self._source, self._stopped_at = np.zeros((n, 2)), np.zeros((n, 2))
        self._shooter = np.zeros(n, dtype=np.int64)
        self._speed, self._stopped = np.zeros(n), np.zeros(n, dtype=np.bool_)
        # The robot that touches the ball, and where.
        self._holder, self._held_at = np.full(n, -1), np.zeros((n, 2))
        self._before, self._last = np.full((n, 2), np.nan), np.full(n, -1)

    def restart(self, which: IntArray, ball: FloatArray, holder: IntArray) -> None:
        """Begin again on the fields ``which`` (m,).

        Args:
            which: indices of the fields.
            ball: place of the ball, (m, 2) [m].
            holder: index of the robot that touches it, -1 for none, (m,).
        """
        self._flying[which] = False
        self._holder[which] = self._last[which] = holder
        self._held_at[which] = self._before[which] = ball

    def see(
        self,
        places: FloatArray,
        touching: BoolArray,
        ball: FloatArray,
        speed: FloatArray,
        last: IntArray,
        blue: BoolArray,
        playing: BoolArray,
    ) -> BoolArray:
        """Take in the next true frame of each field.

        Args:
            places: places of all robots, (n, R, 2), NaN for one that is not there [m].
            touching: which robots touch the ball, (n, R).
            ball: place of the ball, (n, 2) [m].
            speed: its speed, (n,) [m/s].
            last: index of the robot that touched the ball last, -1 for none, (n,).
            blue: which robots are blue's, (R,).
            playing: whether the ball may be played, (n,).

        Returns:
            Whether blue, and whether yellow, has completed a pass, (n, 2).
        """
        on = playing & (np.abs(ball) <= self._lines + BALL_RADIUS).all(axis=1)
        self._flying[~on] = False
        self._holder[~on] = -1
        begins = on & ~self._flying & (self._holder >= 0)
        self._shooter[begins], self._source[begins] = self._holder[begins], self._held_at[begins]
        self._speed[begins], self._stopped[begins] = 0.0, False
        self._flying[begins] = True
        self._speed[on] = np.maximum(self._speed, speed)[on]
        stops = self._flying & ~self._stopped & (speed < _STOPPED_BELOW)
        self._stopped_at[stops] = ball[stops]
        self._stopped[stops] = True
        who, where = self._who_touches(places, touching, ball, last)
        there = on & (who >= 0)
        target = np.where(self._stopped[:, None], self._stopped_at, where)
        length = np.hypot(*(target - self._source).T)
        sent = blue[self._shooter] == blue[who]
        valid = (
            (there & self._flying)
            & sent
            & (who != self._shooter)
            & (length >= LEAST_LENGTH)
            & (self._speed <= MOST_SPEED)
            & self._inside(self._source)
            & self._inside(target)
        )
        self._flying[there] = False
        self._holder = np.where(there, who, -1)
        self._held_at[there] = where[there]
        self._before, self._last = ball.copy(), last.copy()
        passed: BoolArray = np.column_stack((valid & blue[who], valid & ~blue[who]))
        return passed

    def _inside(self, places: FloatArray) -> BoolArray:
        inside: BoolArray = np.asarray((np.abs(places) <= self._lines).all(axis=1))
        return inside

    def _who_touches(
        self, places: FloatArray, touching: BoolArray, ball: FloatArray, last: IntArray
    ) -> tuple[IntArray, FloatArray]:
        """Return who touches the ball, or touched it since the last frame, -1 for nobody, and where."""
        rows = np.arange(len(ball))
        gaps = np.hypot(*np.moveaxis(places - ball[:, None], -1, 0))
        now = touching.any(axis=1)
        nearest = np.where(touching, gaps, np.inf).argmin(axis=1)
        at = places[rows, last]
        # It met and left the robot between two frames.
        met = (
            ~now
            & (last >= 0)
            & (last != self._last)
            & np.isfinite(self._before[:, 0])
            & np.isfinite(at[:, 0])
        )
        nearer = np.hypot(*(self._before - at).T) <= np.hypot(*(ball - at).T)
        who = np.where(now, nearest, np.where(met, last, -1))
        return who, np.where((met & nearer)[:, None], self._before, ball)


class PassCounter:
    """Counts both teams' passes in a match; frames are seen from blue's side.

    Attributes:
        passes: the valid passes of each team so far.
    """

    def __init__(self) -> None:
        self.passes = {Team.BLUE: 0, Team.YELLOW: 0}
        self._counts: PassCounts | None = None
        self._index: dict[RobotId, int] = {}

    def see(self, frame: Frame, game: GameState) -> None:
        """Take in the next true frame."""
        if self._counts is None:
            self._counts = PassCounts(1, frame.field)
        places, touching = np.full((1, _MOST_ROBOTS, 2), np.nan), np.zeros((1, _MOST_ROBOTS), dtype=np.bool_)
        for robot, state in frame.robots().items():
            index = self._index.setdefault(robot, len(self._index))
            places[0, index], touching[0, index] = state.position, touches(state, frame.ball)
        blue = np.zeros(_MOST_ROBOTS, dtype=np.bool_)
        blue[[index for robot, index in self._index.items() if robot.team is Team.BLUE]] = True
        last = -1 if frame.last_touch is None else self._index.get(frame.last_touch, -1)
        passed = self._counts.see(
            places,
            touching,
            np.array([frame.ball.position]),
            np.array([frame.ball.speed]),
            np.array([last]),
            blue,
            np.array([game.command in STARTED]),
        )
        for team, valid in zip(Team, passed[0].tolist(), strict=True):
            self.passes[team] += valid
