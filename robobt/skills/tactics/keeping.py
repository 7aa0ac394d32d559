"""Rate passes and places of a team that only keeps the ball."""

from __future__ import annotations

from functools import lru_cache
from math import cos, hypot, pi, sin

import numpy as np

from robobt.skills.plan import TeamPlan
from robobt.skills.store import TeamStore
from robobt.skills.tactics.agree import pass_under_way
from robobt.skills.tactics.assignment import jobs_of
from robobt.skills.tactics.lanes import flight_time, kick_speed, lane_margin, sigmoid, time_to_pass
from robobt.skills.tactics_settings import TACTICS, AppliedTactics
from robobt.world.compiled import compiled
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import mover_records
from robobt.world.rules import in_own_defense_area, in_their_defense_area
from robobt.world.state import Frame

SHORTEST = 1.3
"""Shortest pass that is tried [m]; passes from 1 m count in the passing challenge."""

FREE_TIME = 0.8
"""Time that the receiver has for its own pass, at which its place is worth 0.73 [s]."""

_PLACE_RINGS = (1.3, 1.7, 2.2, 2.8, 3.5)
_RING_ANGLES = 20
"""Radii of the rings of places around the ball [m], and number of places on each."""

_PLACES_OFF_LINES = 0.35
"""Least distance of a place from the lines [m]."""

_PLACES_EVERY = 0.15
"""Time between two choices of places [s]."""

_PLACES_APART = 1.3
"""Places nearer to each other than this lose worth [m]."""

_LONG_WAY = 0.3
"""How much the square of a robot's time to its place counts [1/s]."""

_STAY_BONUS = 0.12
"""Worth added to the places chosen last."""

_PREFERRED_X, _PREFERENCE_WIDTH = -0.3, 0.5
"""Places behind this x are preferred, where few opponents are; and how gradually [m]."""


@compiled
def rate_receptions(
    points: FloatArray, ox: float, oy: float, delays: FloatArray, opponents_: FloatArray, numbers: FloatArray
) -> FloatArray:
    """Return (G, 3) for passes from (ox, oy) to points (G, 2): chance, kick speed [m/s], free time [s].

    ``delays`` (G,) are the times until the kicks [s]. The free time is by how much the receiver is ahead of
    the opponent that gets to the point first.
    """
    rated = np.zeros((len(points), 3))
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    opponents = mover_records(opponents_)
    for g in range(len(points)):
        x, y = points[g]
        delay = delays[g]
        length = hypot(x - ox, y - oy)
        speed = kick_speed(length, min(tactics.receive_speed, 1.2 + 0.3 * length), tactics)
        flight = flight_time(length, speed, tactics)
        margin = lane_margin(ox, oy, x, y, speed, delay, opponents, tactics)
        free = 10.0
        for opponent in opponents:
            free = min(free, time_to_pass(opponent, x, y, tactics) - delay - flight)
        rated[g, 0] = sigmoid(margin / tactics.margin)
        rated[g, 1], rated[g, 2] = speed, free
    return rated


def worth_of(rated: FloatArray) -> FloatArray:
    """Return how good passes are, 0 to 1, from the rows of :func:`rate_receptions`."""
    chance, _, free = rated.T
    worth: FloatArray = chance / (1.0 + np.exp(-(free - 0.5 * FREE_TIME) / (0.5 * FREE_TIME)))
    return worth


class KeepingPlaces:
    """The places of a team's robots without the ball, for one frame."""

    def __init__(self) -> None:
        self._frame: Frame | None = None
        self._time = -10.0
        self._chosen: FloatArray = np.zeros((0, 2))
        self.places: dict[int, Point] = {}

    def follow(self, frame: Frame, team: TeamStore, plan: TeamPlan) -> None:
        """Bring the places up to this frame."""
        if self._frame is frame:
            return
        self._frame = frame
        free = [(row, robot) for row, robot in enumerate(frame.own) if robot.id != team.attacker]
        if not free:
            return
        if len(self._chosen) != len(free) or not 0.0 <= frame.time - self._time < _PLACES_EVERY:
            self._time = frame.time
            self._chosen = self._choose(frame, team, plan, len(free))
        rows, kinds = np.array([row for row, _ in free]), np.zeros(len(free), dtype=np.int64)
        jobs = jobs_of(plan.own_movers, rows, kinds, self._chosen, kinds, 0.0, _LONG_WAY)
        self.places = {}
        for (_, robot), job in zip(free, jobs.tolist(), strict=True):
            x, y = self._chosen[job].tolist()
            self.places[robot.id] = (x, y)

    def _choose(self, frame: Frame, team: TeamStore, plan: TeamPlan, count: int) -> FloatArray:
        ox, oy = frame.ball.position
        if team.pass_target is not None and pass_under_way(frame, team):
            ox, oy = team.pass_target
        points = np.array((ox, oy)) + _ring_points()
        points = np.concatenate([points, self._chosen])
        inside = [
            _is_open(frame.field, x, y) and hypot(x - ox, y - oy) > SHORTEST for x, y in points.tolist()
        ]
        stays = np.arange(len(points)) >= len(points) - len(self._chosen)
        points, stays = points[inside], stays[inside]
        delays = np.full(len(points), 0.3)
        value = worth_of(rate_receptions(points, ox, oy, delays, plan.their_movers, plan.numbers)) + 0.01
        length = np.hypot(points[:, 0] - ox, points[:, 1] - oy)
        value *= np.clip(1.25 - 0.15 * length, 0.5, 1.0)
        value *= 1.0 / (1.0 + np.exp((points[:, 0] - _PREFERRED_X) / _PREFERENCE_WIDTH))
        value[stays] += _STAY_BONUS
        chosen = []
        for _ in range(count):
            best = int(value.argmax())
            chosen.append(points[best])
            gap = np.hypot(*(points - points[best]).T)
            value = value * np.clip(gap / _PLACES_APART, 0.0, 1.0) ** 2
        return np.array(chosen)


@lru_cache(maxsize=1)
def _ring_points() -> FloatArray:
    return np.array(
        [
            (radius * cos(2.0 * pi * k / _RING_ANGLES), radius * sin(2.0 * pi * k / _RING_ANGLES))
            for radius in _PLACE_RINGS
            for k in range(_RING_ANGLES)
        ]
    )


def _is_open(field: FieldGeometry, x: float, y: float) -> bool:
    return (
        field.contains(x, y, -_PLACES_OFF_LINES)
        and not in_own_defense_area(field, x, y, 0.3)
        and not in_their_defense_area(field, x, y, 0.3)
    )
