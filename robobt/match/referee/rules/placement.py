"""Ball placement by a team's robots."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

import numpy as np
from numpy.typing import NDArray

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import Rule, event, team_event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.geometry import FloatArray, Point, distance, segment_distance
from robobt.world.rules import PLACED_DISTANCE, STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS, RobotId

_SOONEST = 2.0
"""Least duration of a placement [s]. Source: SSL rules."""

CLEAR_DISTANCE = ROBOT_RADIUS + 0.05
"""Least distance of robots' centres from the ball when their free kick follows [m]. Source: SSL rules."""

_AVERAGE_SMOOTHING, _STILL_DISTANCE = 0.97, 0.005
"""Weight of the past in the ball's moving average, and largest distance of a resting ball from it [m].

Source: AutoReferee.
"""

_LEARNT_AT = 0.01
"""Frame length of the moving average [s]."""

_PLACEMENT_WAY_DISTANCE = STOP_DISTANCE + ROBOT_RADIUS
"""Least distance of opponents' centres from the ball's way [m]. Source: SSL rules."""

_INTERFERING = 2.0
"""Time for opponents to leave the ball's way [s]. Source: SSL rules."""


class PlacedBalls:
    """Sees, on many fields at a time, whether balls rest at their spots with all robots clear of them.

    Source: RoboCup SSL rules, chapter "Ball Placement", and AutoReferee.

    Args:
        n: number of fields.
        period: time between two frames [s].
    """

    def __init__(self, n: int, period: float) -> None:
        self._share = _AVERAGE_SMOOTHING ** (period / _LEARNT_AT)
        self._mean = np.zeros((n, 2))

    def restart(self, which: NDArray[np.int64], balls: FloatArray) -> None:
        """Begin a placement on the fields ``which`` (m,), with the ``balls`` at (m, 2) [m]."""
        self._mean[which] = balls

    def see(
        self,
        robots: FloatArray,
        balls: FloatArray,
        spots: FloatArray,
        elapsed: FloatArray,
        clear: float = CLEAR_DISTANCE,
    ) -> NDArray[np.bool_]:
        """Take in the next frame of each field; return where the ball is placed, (n,).

        Args:
            robots: places of all robots, (n, R, 2) [m].
            balls: places of the balls, (n, 2) [m].
            spots: where they are to be placed, (n, 2) [m].
            elapsed: time since the placements began, (n,) [s].
            clear: least distance of robots' centres from the ball [m].
        """
        self._mean = self._share * self._mean + (1.0 - self._share) * balls
        placed: NDArray[np.bool_] = (
            (elapsed >= _SOONEST)
            & (np.hypot(*(balls - spots).T) <= PLACED_DISTANCE)
            & (np.hypot(*(balls - self._mean).T) <= _STILL_DISTANCE)
            & (np.linalg.norm(robots - balls[:, None], axis=2) >= clear).all(axis=1)
        )
        return placed


class PlacementSucceeded(Rule):
    """A placement succeeds with the ball at rest within 0.15 m of its spot and robots clear of it.

    Clear means 0.05 m if the placing team's free kick follows, else 0.5 m.
    """

    phases = frozenset({PlayPhase.PLACEMENT})

    def __init__(self) -> None:
        self._balls = PlacedBalls(1, 0.0)
        self._start: Point = (0.0, 0.0)
        self._told = False

    def enter(self, scene: RefereeScene) -> None:
        """Begin a placement."""
        self._start, self._told = scene.frame.ball.position, False
        self._balls = PlacedBalls(1, scene.frame.period)
        self._balls.restart(np.array([0]), np.array([self._start]))

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report success once."""
        frame, spot, team = scene.frame, scene.game.placement, scene.game.restart_team
        at, clear = frame.ball.position, ROBOT_RADIUS + STOP_DISTANCE
        if scene.game.next_team is team:
            clear = CLEAR_DISTANCE
        robots = np.array([robot.position for robot in (*frame.own, *frame.opponents)]).reshape(1, -1, 2)
        elapsed = np.array([scene.elapsed])
        (placed,) = self._balls.see(robots, np.array([at]), np.array([spot or at]), elapsed, clear)
        if not placed or self._told or spot is None or team is None:
            return
        self._told = True
        yield team_event(
            scene,
            EventKind.PLACEMENT_SUCCEEDED,
            team,
            time_taken=scene.elapsed,
            precision=distance(at, spot),
            distance=distance(self._start, spot),
        )


class PlacementInterference(Rule):
    """Opponents of the placing team must stay 0.5 m away from the line from the ball to its spot."""

    phases = frozenset({PlayPhase.PLACEMENT})

    def __init__(self) -> None:
        self._since: dict[int, float] = {}

    def enter(self, _: RefereeScene) -> None:
        """Begin a placement."""
        self._since.clear()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a robot once while it stays."""
        placing, spot, ball = scene.game.restart_team, scene.game.placement, scene.frame.ball.position
        if placing is None or spot is None:
            return
        other = placing.other
        # Most robots are outside the rectangle around ball and spot, which is quicker to check.
        low_x, high_x = (
            min(ball[0], spot[0]) - _PLACEMENT_WAY_DISTANCE,
            max(ball[0], spot[0]) + _PLACEMENT_WAY_DISTANCE,
        )
        low_y, high_y = (
            min(ball[1], spot[1]) - _PLACEMENT_WAY_DISTANCE,
            max(ball[1], spot[1]) + _PLACEMENT_WAY_DISTANCE,
        )
        for robot in scene.team(other):
            number, x, y = robot.id, robot.x, robot.y
            if (
                not (low_x < x < high_x and low_y < y < high_y)
                or segment_distance((x, y), ball, spot) > _PLACEMENT_WAY_DISTANCE
            ):
                if self._since:
                    self._since.pop(number, None)
                continue
            since = self._since.setdefault(number, scene.time)
            if scene.time - since > _INTERFERING:
                self._since[number] = inf
                identity = RobotId(other, number)
                yield event(scene, EventKind.BOT_INTERFERED_PLACEMENT, identity, robot.position)
