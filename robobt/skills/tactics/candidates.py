"""The passes that a robot can play, rated."""

from __future__ import annotations

from functools import lru_cache
from math import cos, hypot, pi, sin
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.motion.arrival import time_to
from robobt.motion.dribbling import carrying_share
from robobt.skills.store import Pass, TeamStore
from robobt.skills.tactics.chances import point_worth, redirect_angle
from robobt.skills.tactics.lanes import (
    arrive_chance,
    chip_chance,
    chip_speed,
    chip_time,
    flight_time,
    kick_speed,
)
from robobt.skills.tactics_settings import TACTICS, AppliedTactics
from robobt.world.compiled import compiled, compiled_merged, record_dtype
from robobt.world.geometry import FloatArray, Point, distance
from robobt.world.records import mover_records
from robobt.world.state import Frame, RobotState


class _Allowed(NamedTuple):
    """The conditions for passes in a search.

    Attributes:
        least: least chance that the pass arrives.
        chips: whether passes may be chipped.
        shortest: least length of a pass along the ground [m].
        area_gap: least distance from the pass's target to the defence areas [m].
        widest: largest angle by which a pass is redirected with one touch [rad].
        taken: speed at which every receiver takes a pass, however short; 0 where dribblers are strong, whose
            robots take a slower ball more surely, for they can back off with it [m/s].
    """

    least: float
    chips: bool
    shortest: float
    area_gap: float
    widest: float
    taken: float


class _Rated(Protocol):
    """A pass: its score, 0 where there is none, kick speed [m/s], wait [s], and whether it is chipped."""

    score: float
    speed: float
    wait: float
    chip: float


_RATED = record_dtype(_Rated)
_RATED_SIZE = len(_RATED.names or ())

_TAKEN_PASS, _SENT_ON_PASS, _CHIPPED_PASS = 0, 1, 2
"""Kinds of passes: along the ground, by what the receiver does with it, or chipped."""

_RINGS = ((0.0, 1), (0.35, 6), (0.8, 8))


def passes(
    frame: Frame,
    team: TeamStore,
    me: RobotState,
    last: Pass | None,
    keep: float,
    *,
    least: float = 0.15,
    most: int = 8,
    chips: bool = True,
) -> list[Pass]:
    """Return up to ``most`` passes from the ball's position, the best first.

    The targets are points around every team-mate that it can reach before the ball. A pass scores its chance
    to arrive, which is at least ``least``, times the ball's value at the target; the score of ``last`` is
    multiplied by ``keep``. ``chips`` says whether passes may fly over opponents.
    """
    plan, ball, tactics = team.plan, frame.ball, team.plan.tactics
    own, opponents = plan.own_movers, plan.their_movers
    keeper = frame.game.status(frame.team).keeper
    rows = [
        (index, mate)
        for index, mate in enumerate(frame.own)
        if mate.id != me.id and mate.id != keeper and mate.id in plan.players
    ]
    points: list[Point] = []
    owners: list[int] = []
    offsets = _offsets()
    for index, mate in rows:
        bx, by = mate.x + 0.25 * mate.vx, mate.y + 0.25 * mate.vy
        targets = [(bx + dx, by + dy) for dx, dy in offsets]
        place = plan.places.get(mate.id)
        if place is not None and distance(place, mate.position) < 2.0:
            targets.append(place)
        if last is not None and last.receiver == mate.id:
            targets.append(last.target)
        points += targets
        owners += [index] * len(targets)
    if not points:
        return []
    rated = _rate(
        np.array(points),
        np.array(owners),
        ball.x,
        ball.y,
        me.heading,
        own,
        opponents,
        (
            least,
            chips,
            tactics.shortest if plan.short is None else tactics.shortest_restart,
            tactics.area_gap if frame.game.in_play else tactics.area_gap_restart,
            0.0 if plan.without == "one_touch" else tactics.widest,
            min(mate.limits.receives * (1.0 - carrying_share(mate.limits)) for _, mate in rows),
        ),
        plan.numbers,
    )
    found = []
    for (score, speed, wait, chip), index, point in zip(rated.tolist(), owners, points, strict=True):
        if score <= 0.0:
            continue
        number = frame.own[index].id
        if last is not None and last.receiver == number:
            near = distance(last.target, point) < 0.3
            score *= keep if near else 0.5 * (1.0 + keep)
        found.append(Pass(number, point, speed, score, wait, chip > 0.0))
    found.sort(key=lambda one: -one.score)
    return found[:most]


@lru_cache(maxsize=1)
def _offsets() -> list[tuple[float, float]]:
    return [
        (radius * cos(2.0 * pi * k / count), radius * sin(2.0 * pi * k / count))
        for radius, count in _RINGS
        for k in range(count)
    ]


@compiled
def _rate(
    points: FloatArray,
    owners: NDArray[np.int64],
    ox: float,
    oy: float,
    heading: float,
    own_: FloatArray,
    opponents_: FloatArray,
    allowed_: tuple[float, bool, float, float, float, float],
    numbers: FloatArray,
) -> FloatArray:
    """Rate passes to points (G, 2) of the robots ``owners``; return the best to each as a :class:`_Rated`.

    ``allowed_`` holds the values of :class:`_Allowed`.
    """
    passes = np.zeros((len(points), _RATED_SIZE))
    rated = passes.view(_RATED)[:, 0]
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    own, opponents, allowed = mover_records(own_), mover_records(opponents_), _Allowed(*allowed_)
    for g in range(len(points)):
        x, y = points[g]
        length = hypot(x - ox, y - oy)
        if length < allowed.shortest or not _can_be_target(x, y, allowed.area_gap, tactics):
            continue
        i = owners[g]
        best: _Rated = rated[g]
        turn = np.arctan2(y - oy, x - ox) - heading
        turn = abs((turn + pi) % (2.0 * pi) - pi)
        delay = 0.1 + turn / tactics.turn_rate
        there = time_to(own[i], x, y, 0.1)
        for kind in (_TAKEN_PASS, _SENT_ON_PASS, _CHIPPED_PASS):
            ready = there
            if kind == _SENT_ON_PASS:
                if (
                    length < tactics.shortest_redirect
                    or redirect_angle(ox, oy, x, y, tactics.half_length) > allowed.widest
                ):
                    continue
                ready += tactics.redirect_turn
            if kind == _CHIPPED_PASS:
                if (
                    not allowed.chips
                    or not tactics.shortest <= length <= tactics.longest_chip
                    or best.score > 0.0
                ):
                    continue
                speed = chip_speed(length, tactics)
                flight = chip_time(length, tactics)
            else:
                slow = min(tactics.receive_speed, max(allowed.taken, 0.8 + 0.4 * length))
                arrival = tactics.redirect_speed if kind == _SENT_ON_PASS else slow
                speed = kick_speed(length, arrival, tactics)
                flight = flight_time(length, speed, tactics)
            wait = delay
            if wait + flight < ready:
                # The ball waits for the robot.
                wait = ready - flight
                if wait > tactics.longest_wait:
                    continue
            if kind == _CHIPPED_PASS:
                chance = chip_chance(ox, oy, x, y, wait, opponents, own, i, tactics)
            else:
                chance = arrive_chance(ox, oy, x, y, speed, wait, opponents, own, i, tactics)
            if chance < allowed.least:
                continue
            worth = point_worth(ox, oy, x, y, wait + flight, opponents, tactics)
            if kind == _SENT_ON_PASS and worth < tactics.redirect_worth:
                continue
            score = chance * worth * max(0.3, 1.0 - 0.25 * wait)
            if score > best.score:
                best.score, best.speed, best.wait = score, speed, max(0.0, ready - flight)
                best.chip = 1.0 if kind == _CHIPPED_PASS else 0.0
    return passes


@compiled_merged
def _can_be_target(x: float, y: float, area_gap: float, tactics: AppliedTactics) -> bool:
    """Return whether (x, y) is well inside the field and outside the defence areas."""
    half_length, half_area = tactics.half_length, tactics.defense_width / 2.0
    if abs(x) > half_length - 0.15 or abs(y) > tactics.half_width - 0.15:
        return False
    return not (abs(x) > half_length - tactics.defense_depth - area_gap and abs(y) < half_area + area_gap)
