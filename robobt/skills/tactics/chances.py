"""Compiled functions for many points at once: the chance that a shot scores, and the ball's value at a point.

A shot's chance compares the ball's position over time with what opponents can reach by then, as the league's
teams do. The scales were chosen by hand in this simulator; the results are not calibrated probabilities.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from robobt.skills.tactics.lanes import (
    arrive_chance,
    cannot_pass_by,
    flight_time,
    kick_speed,
    sigmoid,
    time_to_pass,
)
from robobt.skills.tactics_settings import TACTICS, AppliedTactics
from robobt.world.compiled import compilable, compiled, compiled_merged, records
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import FIELD_PLACE, MOVER_SIZE, Mover, Place, mover_records
from robobt.world.state import TOUCH_DISTANCE

_AIMS = 13


class AimedShot(NamedTuple):
    """A shot's chance to score, the y of its aim on the goal line [m] and its half angle [rad]."""

    chance: float
    y: float
    half_angle: float


@compiled
def shot_chance(
    x: float, y: float, delay: float, opponents: Sequence[Mover], tactics: AppliedTactics
) -> AimedShot:
    """Return the best shot from (x, y) with the kick in ``delay`` seconds.

    Until the kick, opponents near their goal move between its middle and the ball; after the kick every
    opponent tries to reach the ball.
    """
    goal_x, half_goal = tactics.half_length, tactics.half_goal
    gx, gy = goal_x - x, -y
    to_goal = hypot(gx, gy)
    if gx <= 0.05:
        return AimedShot(0.0, 0.0, 0.0)
    where = _between(x, y, delay, opponents, tactics)
    chances = np.empty(_AIMS)
    top = 0.0
    for a in range(_AIMS):
        aim = (half_goal - tactics.inset) * (2.0 * a / (_AIMS - 1) - 1.0)
        least = _room(x, y, aim, delay, where, opponents, tactics)
        chances[a] = sigmoid((least - 0.01) / (0.5 * tactics.spread))
        top = max(top, chances[a])
    low, high = _longest_run(chances, 0.85 * top)
    at_y = (half_goal - tactics.inset) * ((low + high) / (_AIMS - 1) - 1.0)
    wide = (half_goal - tactics.inset) * 2.0 * (high - low + 1) / (_AIMS - 1)
    # The kick's own error grows with the distance.
    chance = top * min(1.0, 1.6 / max(0.5, 0.4 * to_goal + 0.4))
    return AimedShot(chance, at_y, 0.5 * wide * gx / (to_goal * to_goal))


@compiled_merged
def _between(
    x: float, y: float, delay: float, opponents: Sequence[Mover], tactics: AppliedTactics
) -> Sequence[Place]:
    """Return opponents' positions at the kick; those near their goal move between its middle and (x, y)."""
    where: Sequence[Place] = records(len(opponents), FIELD_PLACE)
    goal_x = tactics.half_length
    gx, gy = goal_x - x, -y
    to_goal = hypot(gx, gy)
    for j, opponent in enumerate(opponents):
        px, py = opponent.x, opponent.y
        if delay > 0.0 and hypot(goal_x - px, py) < tactics.near_goal:
            # They move sideways to the line from the ball to the goal's middle, each staying on its side of
            # it.
            across = ((px - x) * gy - (py - y) * gx) / to_goal
            free = max(0.0, delay - tactics.reaction)
            reach = min(0.5 * opponent.acceleration * 0.7 * free * free, opponent.max_speed * free)
            keep = 0.0 if abs(px - goal_x) < 0.7 else 0.1
            step = min(reach, max(0.0, abs(across) - keep))
            if across < 0.0:
                step = -step
            px -= step * gy / to_goal
            py += step * gx / to_goal
        where[j].x, where[j].y = px, py
    return where


@compiled_merged
def _room(
    x: float,
    y: float,
    aim: float,
    delay: float,
    where: Sequence[Place],
    opponents: Sequence[Mover],
    tactics: AppliedTactics,
) -> float:
    """Return the least distance of a shot at the y ``aim`` from the posts and the opponents' reach [m].

    The search stops once the distance is far below 0.
    """
    goal_x, half_goal = tactics.half_length, tactics.half_goal
    dx, dy = goal_x - x, aim - y
    length = hypot(dx, dy)
    ux, uy = dx / length, dy / length
    least = (half_goal - abs(aim)) * dx / length
    for j, opponent in enumerate(opponents):
        along = (where[j].x - x) * ux + (where[j].y - y) * uy
        if along < -TOUCH_DISTANCE or along > length + TOUCH_DISTANCE:
            continue
        time = min(max(along, 0.0), length) / tactics.shot_speed
        # The opponent keeps its velocity, with less certainty later on.
        goes = min(time, 0.3) if delay < 0.15 else 0.0
        px, py = where[j].x + goes * opponent.vx, where[j].y + goes * opponent.vy
        aside = abs((px - x) * uy - (py - y) * ux)
        # Goalkeepers see a robot aim; most robots are too far away even with that.
        free = max(0.0, time - 0.1 + tactics.sees)
        gap = aside - TOUCH_DISTANCE - 0.5 * opponent.acceleration * free * free
        if gap < least and hypot(goal_x - px, py) >= tactics.keeps:
            free = max(0.0, time - 0.1)
            gap = aside - TOUCH_DISTANCE - 0.5 * opponent.acceleration * free * free
        if gap < least:
            least = gap
            if least < -0.3:
                break
    return least


@compiled_merged
def _longest_run(chances: FloatArray, enough: float) -> tuple[int, int]:
    """Return the first and last aim of the longest run of aims with a chance of at least ``enough``."""
    low, high, longest = 0, 0, 0
    for a in range(len(chances)):
        if chances[a] >= enough:
            end = a
            while end + 1 < len(chances) and chances[end + 1] >= enough:
                end += 1
            if end - a + 1 > longest:
                longest, low, high = end - a + 1, a, end
    return low, high


@compilable
def redirect_angle(ox: float, oy: float, x: float, y: float, goal_x: float) -> float:
    """Return the angle at (x, y) between the directions to the origin (ox, oy) and to the goal [rad]."""
    turn = atan2(oy - y, ox - x) - atan2(-y, goal_x - x)
    while turn > pi:
        turn -= 2.0 * pi
    while turn < -pi:
        turn += 2.0 * pi
    return abs(turn)


@compiled
def aim_of(
    heading_x: float,
    heading_y: float,
    incoming_x: float,
    incoming_y: float,
    shot_speed: float,
    fastest: float,
) -> float:
    """Return the heading [rad] from which a ball kicked at once leaves along (heading_x, heading_y).

    A kick sends the ball along the heading at the speed of :func:`redirect_kick`. The heading compensates for
    the part across it of (incoming_x, incoming_y) [m/s], which the ball keeps
    (:func:`~robobt.motion.dribbling.velocity_for_kick`).
    """
    wanted = atan2(heading_y, heading_x)
    heading = wanted
    for _ in range(20):
        sideways = cos(heading) * incoming_y - sin(heading) * incoming_x
        heading = wanted - atan2(sideways, redirect_kick(sideways, shot_speed, fastest))
    return heading


@compilable
def redirect_kick(sideways: float, shot_speed: float, fastest: float) -> float:
    """Return the kick speed of a shot with one touch, given the speed across the heading it keeps [m/s]."""
    return min(shot_speed, sqrt(max(1.0, fastest * fastest - sideways * sideways)))


@compiled
def point_worth(
    ox: float,
    oy: float,
    x: float,
    y: float,
    delay: float,
    opponents: Sequence[Mover],
    tactics: AppliedTactics,
) -> float:
    """Return the ball's value at (x, y) when it arrives there in ``delay`` seconds from (ox, oy).

    The value is a chance of a goal: by a shot at once, by a shot after a turn, or by later play, which counts
    more the nearer the goal and the farther the opponents are.
    """
    goal_x = tactics.half_length
    to_goal = hypot(goal_x - x, y)
    angle = redirect_angle(ox, oy, x, y, goal_x)
    turn = 0.0 if angle <= tactics.widest else 0.25 + 0.15 * angle
    shot = 0.0
    if to_goal < 5.5:
        shot = shot_chance(x, y, delay + turn, opponents, tactics).chance
        if angle > tactics.widest:
            shot *= 0.7
    # An opponent that arrives later than this counts as no opponent.
    first = min(10.0, delay + 0.5 * tactics.free + 1e-9)
    for opponent in opponents:
        if not cannot_pass_by(opponent, x, y, first, tactics):
            first = min(first, time_to_pass(opponent, x, y, tactics))
    free = min(1.0, max(0.05, 0.5 + (first - delay) / tactics.free))
    later = free * (0.04 + 0.10 * max(0.0, 1.0 - to_goal / (2.0 * goal_x)))
    return shot + (1.0 - shot) * later


@compiled
def rate_points(
    points: FloatArray,
    ox: float,
    oy: float,
    delay: float,
    opponents_: FloatArray,
    numbers: FloatArray,
) -> FloatArray:
    """Rate passes from (ox, oy) to every point: (G, 2), the chance to arrive and the ball's value there.

    ``delay`` is the time until the kick [s]; ``points`` are (G, 2) [m]; ``numbers`` are those of
    :func:`~robobt.skills.tactics_settings.applied`.
    """
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    out = np.empty((len(points), 2))
    opponents, nobody = mover_records(opponents_), mover_records(np.empty((0, MOVER_SIZE)))
    for g in range(len(points)):
        x, y = points[g]
        length = hypot(x - ox, y - oy)
        speed = kick_speed(length, tactics.receive_speed, tactics)
        time = flight_time(length, speed, tactics)
        arrives = arrive_chance(ox, oy, x, y, speed, delay, opponents, nobody, -1, tactics)
        out[g, 0] = arrives
        out[g, 1] = point_worth(ox, oy, x, y, delay + time, opponents, tactics)
    return out


@compiled
def shot_from(
    x: float, y: float, delay: float, opponents_: FloatArray, numbers: FloatArray
) -> tuple[float, float, float]:
    """Return the result of :func:`shot_chance` to Python; ``numbers`` as in :func:`rate_points`."""
    shot = shot_chance(x, y, delay, mover_records(opponents_), numbers.view(TACTICS)[0])
    # A plain tuple reaches Python in half the time.
    return shot.chance, shot.y, shot.half_angle


@compiled
def worth_at(origin: Point, place: Point, delay: float, opponents_: FloatArray, numbers: FloatArray) -> float:
    """Return the result of :func:`point_worth` to Python; ``numbers`` as in :func:`rate_points`."""
    return point_worth(*origin, *place, delay, mover_records(opponents_), numbers.view(TACTICS)[0])
