"""The passes that a robot can play, rated."""

from __future__ import annotations

from functools import lru_cache
from math import cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from robobt.motion.arrival import arrival_time
from robobt.skills.store import Pass, TeamStore
from robobt.skills.tactics.chances import WIDEST, point_worth, redirect_angle
from robobt.skills.tactics.lanes import (
    LONGEST_CHIP,
    RECEIVE_SPEED,
    arrive_chance,
    ball_row,
    chip_chance,
    chip_speed,
    chip_time,
    flight_time,
    kick_speed,
)
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray
from robobt.world.state import Frame, RobotState

SHORTEST = 1.4
"""Of a pass [m]."""

SHORTEST_RESTART = 0.35
"""Of a pass from an own restart, where no opponent may be so near [m]."""

AREA_GAP, AREA_GAP_RESTART = 0.15, 0.3
"""How far from the defence areas a pass may end: at an own restart no hull within the rules' 0.2 m [m]."""

LONGEST_WAIT = 1.2
"""For a receiver that is not there yet [s]."""

REDIRECT_SPEED = 3.2
"""Of a ball that is to be sent on with one touch, as it arrives [m/s]."""

SHORTEST_REDIRECT = 1.8
"""Of a pass that is to be sent on with one touch [m]."""

REDIRECT_WORTH = 0.25
"""Least that the ball has to be worth at the end of a pass that is to be sent on with one touch."""

TURNS = 0.2
"""What a receiver needs to turn to where it sends the ball on [s]."""

_RINGS = ((0.0, 1), (0.35, 6), (0.8, 8))
_TURN_RATE = 4.0


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
    """Return the best passes from where the ball lies, at most ``most``, the best first.

    To every team-mate there are points about it that it can reach before the ball. A pass scores the
    chance to arrive, which is at least ``least``, times what the ball is worth there; ``last`` counts
    ``keep`` times. ``chips`` says whether it may fly over opponents.
    """
    plan, ball, field = team.plan, frame.ball, frame.field
    own, opponents = plan.own_movers, plan.their_movers
    keeper = frame.game.status(frame.team).keeper
    rows = [
        (index, mate)
        for index, mate in enumerate(frame.own)
        if mate.id != me.id and mate.id != keeper and mate.id in plan.players
    ]
    points, owners = [], []
    offsets = _offsets()
    for index, mate in rows:
        bx, by = mate.x + 0.25 * mate.vx, mate.y + 0.25 * mate.vy
        for dx, dy in offsets:
            points.append((bx + dx, by + dy))
            owners.append(index)
        place = plan.places.get(mate.id)
        if place is not None and hypot(place[0] - mate.x, place[1] - mate.y) < 2.0:
            points.append(place)
            owners.append(index)
        if last is not None and last.receiver == mate.id:
            points.append(last.target)
            owners.append(index)
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
        np.array(
            (
                field.half_length,
                field.half_width,
                field.goal_width / 2.0,
                field.defense_depth,
                field.defense_width / 2.0,
                least,
                1.0 if chips else 0.0,
                SHORTEST if plan.short is None else SHORTEST_RESTART,
                AREA_GAP if frame.game.in_play else AREA_GAP_RESTART,
                0.0 if plan.without == "one_touch" else WIDEST,
            )
        ),
        ball_row(frame.ball_model),
    )
    found = []
    for (score, speed, wait, chip), index, point in zip(rated.tolist(), owners, points, strict=True):
        if score <= 0.0:
            continue
        number = frame.own[index].id
        if last is not None and last.receiver == number:
            near = hypot(point[0] - last.target[0], point[1] - last.target[1]) < 0.3
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
    own: FloatArray,
    opponents: FloatArray,
    size: FloatArray,
    ball: FloatArray,
) -> FloatArray:
    """Rate passes to points (G, 2) of the robots ``owners``.

    Returns (G, 4): score, kick speed [m/s], wait [s] and whether it is chipped.
    """
    out = np.zeros((len(points), 4))
    half_length, half_width, half_goal, depth, half_area = size[0], size[1], size[2], size[3], size[4]
    least, chips, shortest, area_gap, widest = size[5], size[6] > 0.0, size[7], size[8], size[9]
    for g in range(len(points)):
        x, y = points[g, 0], points[g, 1]
        if abs(x) > half_length - 0.15 or abs(y) > half_width - 0.15:
            continue
        if abs(x) > half_length - depth - area_gap and abs(y) < half_area + area_gap:
            continue
        length = hypot(x - ox, y - oy)
        if length < shortest:
            continue
        i = owners[g]
        turn = np.arctan2(y - oy, x - ox) - heading
        turn = abs((turn + pi) % (2.0 * pi) - pi)
        delay = 0.1 + turn / _TURN_RATE
        there = arrival_time(own[i], x, y, 0.1)
        for kind in range(3):
            redirect, chip = kind == 1, kind == 2
            ready = there
            if redirect:
                if length < SHORTEST_REDIRECT or redirect_angle(ox, oy, x, y, half_length) > widest:
                    continue
                ready += TURNS
            if chip:
                if not chips or not SHORTEST <= length <= LONGEST_CHIP or out[g, 0] > 0.0:
                    continue
                speed = chip_speed(length, ball)
                flight = chip_time(length, ball)
            else:
                arrival = REDIRECT_SPEED if redirect else min(RECEIVE_SPEED, 0.8 + 0.4 * length)
                speed = kick_speed(length, arrival, ball)
                flight = flight_time(length, speed, ball)
            wait = delay
            if wait + flight < ready:
                # The ball waits for the robot.
                wait = ready - flight
                if wait > LONGEST_WAIT:
                    continue
            if chip:
                chance = chip_chance(ox, oy, x, y, wait, opponents, own, i, ball)
            else:
                chance = arrive_chance(ox, oy, x, y, speed, wait, opponents, own, i, ball)
            if chance < least:
                continue
            worth = point_worth(ox, oy, x, y, wait + flight, opponents, half_length, half_goal)
            if redirect and worth < REDIRECT_WORTH:
                continue
            score = chance * worth * max(0.3, 1.0 - 0.25 * wait)
            if score > out[g, 0]:
                out[g, 0] = score
                out[g, 1] = speed
                out[g, 2] = max(0.0, ready - flight)
                out[g, 3] = 1.0 if chip else 0.0
    return out
