"""The chance that a shot scores and what the ball is worth somewhere, for many points at once, compiled.

Shots compare where the ball is when with what opponents can reach by then, as the league's teams do.
The scales were chosen by hand in this simulator; they are no calibrated probabilities.
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt

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
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import MOVER_SIZE
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_BODY = ROBOT_RADIUS + BALL_RADIUS

_AIMS = 13


@compiled
def shot_chance(
    x: float,
    y: float,
    delay: float,
    opponents: FloatArray,
    best: FloatArray,
    tactics: AppliedTactics,
) -> float:
    """Return the chance that a shot from (x, y) scores that is kicked ``delay`` from now [s].

    Until then opponents near their goal move to between its middle and the ball; from the kick on
    everybody reaches out for it. ``best`` takes the y on the goal line of the best aim and the
    half angle that is as good [m, rad].
    """
    n, goal_x, half_goal = len(opponents), tactics.half_length, tactics.half_goal
    gx, gy = goal_x - x, -y
    to_goal = hypot(gx, gy)
    best[0], best[1] = 0.0, 0.0
    if gx <= 0.05:
        return 0.0
    where = np.empty((n, 2))
    for j in range(n):
        px, py = opponents[j, 0], opponents[j, 1]
        if delay > 0.0 and hypot(goal_x - px, py) < tactics.near_goal:
            # Across to the line from the ball to the goal's middle, each on its side of it.
            across = ((px - x) * gy - (py - y) * gx) / to_goal
            free = max(0.0, delay - tactics.reaction)
            reach = min(0.5 * opponents[j, 5] * 0.7 * free * free, opponents[j, 4] * free)
            keep = 0.0 if abs(px - goal_x) < 0.7 else 0.1
            step = min(reach, max(0.0, abs(across) - keep))
            if across < 0.0:
                step = -step
            px -= step * gy / to_goal
            py += step * gx / to_goal
        where[j, 0], where[j, 1] = px, py
    chances = np.empty(_AIMS)
    top = 0.0
    for a in range(_AIMS):
        aim = (half_goal - tactics.inset) * (2.0 * a / (_AIMS - 1) - 1.0)
        dx, dy = goal_x - x, aim - y
        length = hypot(dx, dy)
        ux, uy = dx / length, dy / length
        least = (half_goal - abs(aim)) * dx / length
        for j in range(n):
            along = (where[j, 0] - x) * ux + (where[j, 1] - y) * uy
            if along < -_BODY or along > length + _BODY:
                continue
            time = min(max(along, 0.0), length) / tactics.shot_speed
            # It goes on as it moves now, less sure the later.
            goes = min(time, 0.3) if delay < 0.15 else 0.0
            px, py = where[j, 0] + goes * opponents[j, 2], where[j, 1] + goes * opponents[j, 3]
            aside = abs((px - x) * uy - (py - y) * ux)
            # Goalkeepers see a robot aim; most robots are too far off even so.
            free = max(0.0, time - 0.1 + tactics.sees)
            gap = aside - _BODY - 0.5 * opponents[j, 5] * free * free
            if gap < least and hypot(goal_x - px, py) >= tactics.keeps:
                free = max(0.0, time - 0.1)
                gap = aside - _BODY - 0.5 * opponents[j, 5] * free * free
            if gap < least:
                least = gap
                if least < -0.3:
                    break
        chances[a] = sigmoid((least - 0.01) / (0.5 * tactics.spread))
        top = max(top, chances[a])
    low, high = 0, 0
    longest = 0
    for a in range(_AIMS):
        if chances[a] >= 0.85 * top:
            end = a
            while end + 1 < _AIMS and chances[end + 1] >= 0.85 * top:
                end += 1
            if end - a + 1 > longest:
                longest, low, high = end - a + 1, a, end
    at_y = (half_goal - tactics.inset) * ((low + high) / (_AIMS - 1) - 1.0)
    wide = (half_goal - tactics.inset) * 2.0 * (high - low + 1) / (_AIMS - 1)
    best[0] = at_y
    best[1] = 0.5 * wide * gx / (to_goal * to_goal)
    # The kick's own error grows with the way.
    return top * min(1.0, 1.6 / max(0.5, 0.4 * to_goal + 0.4))


@compiled
def redirect_angle(ox: float, oy: float, x: float, y: float, goal_x: float) -> float:
    """Return the angle at (x, y) between where a ball from (ox, oy) comes from and the goal [rad]."""
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

    A kick sends the ball along the heading, with :func:`redirect_kick`, and leaves its sideways speed as it
    was: the one that comes in with (incoming_x, incoming_y) [m/s] is aimed that much to the other side.
    """
    wanted = atan2(heading_y, heading_x)
    heading = wanted
    for _ in range(20):
        sideways = cos(heading) * incoming_y - sin(heading) * incoming_x
        heading = wanted - atan2(sideways, redirect_kick(sideways, shot_speed, fastest))
    return heading


@compiled
def redirect_kick(sideways: float, shot_speed: float, fastest: float) -> float:
    """Return the kick speed of a shot with one touch, given the ball's speed across the heading [m/s]."""
    return min(shot_speed, sqrt(max(1.0, fastest * fastest - sideways * sideways)))


@compiled
def point_worth(
    ox: float,
    oy: float,
    x: float,
    y: float,
    delay: float,
    opponents: FloatArray,
    tactics: AppliedTactics,
) -> float:
    """Return what the ball is worth at (x, y) when it gets there ``delay`` from now out of (ox, oy).

    As a chance of a goal: by a shot at once or after a turn, or by what comes later, the more the
    nearer to the goal and the freer of opponents it is.
    """
    best, goal_x = np.empty(2), tactics.half_length
    to_goal = hypot(goal_x - x, y)
    angle = redirect_angle(ox, oy, x, y, goal_x)
    turn = 0.0 if angle <= tactics.widest else 0.25 + 0.15 * angle
    shot = 0.0
    if to_goal < 5.5:
        shot = shot_chance(x, y, delay + turn, opponents, best, tactics)
        if angle > tactics.widest:
            shot *= 0.7
    # Whoever comes later than this counts as little as nobody.
    first = min(10.0, delay + 0.5 * tactics.free + 1e-9)
    for j in range(len(opponents)):
        if not cannot_pass_by(opponents[j], x, y, first, tactics):
            first = min(first, time_to_pass(opponents[j], x, y, tactics))
    free = min(1.0, max(0.05, 0.5 + (first - delay) / tactics.free))
    later = free * (0.04 + 0.10 * max(0.0, 1.0 - to_goal / (2.0 * goal_x)))
    return shot + (1.0 - shot) * later


@compiled
def rate_points(
    points: FloatArray,
    ox: float,
    oy: float,
    delay: float,
    opponents: FloatArray,
    numbers: FloatArray,
) -> FloatArray:
    """Rate passes from (ox, oy) to every point: (G, 2), chance to arrive and worth there.

    ``delay`` is the time until the kick [s]; ``points`` are (G, 2) [m]; ``numbers`` are those of
    :func:`~robobt.skills.tactics_settings.applied`.
    """
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    out = np.empty((len(points), 2))
    nobody = np.empty((0, MOVER_SIZE))
    for g in range(len(points)):
        x, y = points[g, 0], points[g, 1]
        length = hypot(x - ox, y - oy)
        speed = kick_speed(length, tactics.receive_speed, tactics)
        time = flight_time(length, speed, tactics)
        out[g, 0] = arrive_chance(ox, oy, x, y, speed, delay, opponents, nobody, -1, tactics)
        out[g, 1] = point_worth(ox, oy, x, y, delay + time, opponents, tactics)
    return out


@compiled
def shot_from(
    x: float, y: float, delay: float, opponents: FloatArray, best: FloatArray, numbers: FloatArray
) -> float:
    """Return what :func:`shot_chance` does, to Python: ``numbers`` as of :func:`rate_points`."""
    return shot_chance(x, y, delay, opponents, best, numbers.view(TACTICS)[0])


@compiled
def worth_at(origin: Point, place: Point, delay: float, opponents: FloatArray, numbers: FloatArray) -> float:
    """Return what :func:`point_worth` does, to Python: ``numbers`` as of :func:`rate_points`."""
    return point_worth(*origin, *place, delay, opponents, numbers.view(TACTICS)[0])
