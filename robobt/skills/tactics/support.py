"""Places for supporters: where a pass arrives and is worth most, apart from each other."""

from __future__ import annotations

from functools import lru_cache
from math import inf

import numpy as np

from robobt.skills.plan import TeamPlan
from robobt.skills.store import TeamStore
from robobt.skills.tactics.chances import rate_points
from robobt.skills.tactics_settings import TacticsSettings
from robobt.world.field import FieldGeometry
from robobt.world.game import Restart
from robobt.world.geometry import FloatArray, Point, distance
from robobt.world.records import movers_of
from robobt.world.rules import in_own_defense_area, in_their_defense_area
from robobt.world.state import Frame

_SHORT_ANGLES = 16
_ALL_ROOM = 10.0


def support_places(frame: Frame, team: TeamStore, plan: TeamPlan, count: int) -> list[Point]:
    """Return ``count`` places for supporters, the best first."""
    tactics = plan.tactics
    if len(plan.support) >= count and 0.0 <= frame.time - plan.support_time < tactics.support_every:
        return plan.support[:count]
    plan.support_time = frame.time
    grid = support_grid(frame.field, tactics.spacing, tactics.edge)
    old = list(plan.support)
    points = np.concatenate([grid, np.array(old).reshape(-1, 2)])
    origin = _origin(frame, team)
    arrives, worth = rate_points(points, *origin, 0.4, plan.their_movers, plan.numbers).T
    value = arrives * worth
    # A place that no pass reaches now may be reached in a moment.
    value += 0.15 * worth
    value[len(grid) :] *= tactics.stay
    apart = tactics.apart
    gap = _gaps(points, origin)
    value *= np.clip(gap / apart, 0.0, 1.0) ** 2 * np.clip(1.0 - (gap - 4.0) / 5.0, 0.3, 1.0)
    intended = plan.next_pass
    taken: list[Point] = [] if intended is None else [intended.target]
    for place in taken:
        _spread(value, points, place, apart)
    chosen: list[Point] = []
    for _ in range(count):
        best = int(value.argmax())
        x, y = points[best].tolist()
        place = (x, y)
        chosen.append(place)
        _spread(value, points, place, apart)
    plan.support = chosen
    return chosen


def short_place(frame: Frame, last: Point | None, tactics: TacticsSettings) -> Point | None:
    """Return the place beside the ball of an own restart that is farthest from opponents.

    ``last`` is the last such place. None without such a restart, and if no place is in the field and outside
    the defence areas.
    """
    field, game = frame.field, frame.game
    if game.restart not in (Restart.FREE_KICK, Restart.KICKOFF) or game.restart_team is not frame.team:
        return None
    x, y = game.placement or frame.ball.position
    best, most = None, -inf
    places = np.array((x, y)) + _beside(tactics.short)
    theirs = movers_of(frame)[len(frame.own) :, :2]
    rooms = np.hypot(*(places[:, None] - theirs).T).min(axis=0, initial=_ALL_ROOM).tolist()
    most_x, most_y = field.half_length - tactics.short_line, field.half_width - tactics.short_line
    for (px, py), room in zip(places.tolist(), rooms, strict=True):
        if not (abs(px) < most_x and abs(py) < most_y):
            continue
        # Only places near a goal line can be in a defence area.
        near = abs(px) >= field.half_length - field.defense_depth - tactics.short_area
        if near and (
            in_own_defense_area(field, px, py, tactics.short_area)
            or in_their_defense_area(field, px, py, tactics.short_area)
        ):
            continue
        place = (px, py)
        if last is not None and distance(place, last) < 0.1:
            room += tactics.short_gain
        if room > most:
            best, most = place, room
    return best


@lru_cache(maxsize=1)
def _beside(gap: float) -> FloatArray:
    angles = 2.0 * np.pi * np.arange(_SHORT_ANGLES) / _SHORT_ANGLES
    return gap * np.stack((np.cos(angles), np.sin(angles)), axis=1)


def _spread(value: FloatArray, points: FloatArray, place: Point, apart: float) -> None:
    value *= np.clip(_gaps(points, place) / apart, 0.0, 1.0) ** 2


def _gaps(points: FloatArray, place: Point) -> FloatArray:
    x, y = points.T
    gaps: FloatArray = np.hypot(x - place[0], y - place[1])
    return gaps


def _origin(frame: Frame, team: TeamStore) -> Point:
    """Return the origin of the next pass: the target of the current pass, else the ball."""
    target = team.pass_target
    if (
        target is not None
        and team.attacker == team.receiver
        and frame.ball.speed > team.plan.tactics.origin_from
    ):
        return target
    if not frame.game.in_play and frame.game.placement is not None:
        return frame.game.placement
    return frame.ball.position


@lru_cache(maxsize=8)
def support_grid(field: FieldGeometry, spacing: float, edge: float) -> FloatArray:
    """Return the points where a supporter may stand, (G, 2) [m]."""
    rows = int((field.half_length - edge) / spacing)
    columns = int((field.half_width - edge) / spacing)
    points = [
        (x * spacing, y * spacing) for x in range(-rows // 2, rows + 1) for y in range(-columns, columns + 1)
    ]
    kept = [
        point
        for point in points
        if not in_their_defense_area(field, *point, 0.25) and not in_own_defense_area(field, *point, 0.4)
    ]
    return np.array(kept)
