"""Find the next waypoint around robots, ball and defence areas, and drive there.

The plan is recomputed in every tick and only its first leg is driven. Obstacles are circles; a blocked path
leaves along the tangent of the first circle on it, on the side with the shorter way round. Defence areas are
passed by their corners. Robots that move are no obstacles to the path: the velocity along it is changed where
it would meet one (:mod:`robobt.motion.velocity_obstacles`).

Source of the idea and the clearances: RoboBulls' published code (FPPA planner);
tangents and side choice are robobt's.
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence
from math import acos, atan2, cos, hypot, inf, pi, sin, sqrt, tan
from typing import Protocol, Unpack

import numpy as np

from robobt.motion.give_way import slowed_towards
from robobt.motion.pilot import command_law, turn_law, wanted_velocity
from robobt.motion.scene import (
    ROBOT_AREA_GAP,
    Freedom,
    allowed_place,
    from_ball,
    is_open,
    row_of,
    scene_of,
    trip_numbers,
    trip_of,
)
from robobt.motion.stadium import outside_stadium
from robobt.motion.velocity_obstacles import STANDS_APART, clear_velocity, is_moving
from robobt.world.command import RobotCommand
from robobt.world.compiled import compiled, compiled_merged, record_dtype, records
from robobt.world.geometry import FloatArray, Point
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    LIMITS,
    SCENE,
    TRIP,
    Limits,
    Mover,
    Scene,
    Trip,
    limits_of,
    mover_records,
    movers_of,
)
from robobt.world.sketch import Sketch
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

PATHS, TARGETS = "paths", "targets"
"""Drawing layers of planned paths, and of targets of driving and kicking."""

_MOST_LEGS = 6

_OBSTACLE_LOOK_AHEAD = 0.4
"""Longest time an obstacle is moved ahead along its velocity [s]."""
_HEADSTRONG = 0.5
"""Additional length allowed for the present side of a detour [m]."""
_STANDS = 0.25
"""A robot slower than this has not started yet [m/s]."""
_CORNER_SLACK = 0.05
"""Distance by which a waypoint may be cut or overshot [m]; it decides the speed there."""
_CLEARANCE = 0.04
"""How much wider than the blocking circle a detour is, so that the next plan finds it free [m]."""
_WIDEST_TURN = 0.9
_MOST_ROUND = 4
"""Number of further circles avoided on the way to the first."""


class _Circle(Protocol):
    """An obstacle [m]."""

    x: float
    y: float
    radius: float


_CIRCLE = record_dtype(_Circle)


def travel(
    frame: Frame,
    me: RobotState,
    target: Point,
    heading: float,
    limits: RobotLimits,
    *,
    final_speed: float = 0.0,
    spare_mates: bool = False,
    sketch: Sketch | None = None,
    **freedom: Unpack[Freedom],
) -> RobotCommand:
    """:func:`~robobt.motion.pilot.drive` along a free path, within the rules.

    A target that may not be driven to is replaced by :func:`allowed_target`.
    While the referee has stopped the game the robot keeps to the speed and, as
    in the opponents' restarts, to the distance from the ball that the rules ask. It keeps
    out of the way of a ball that the opponents place, and gives way to opponents while the
    ball is not in play.

    Args:
        frame: what is on the field.
        me: the robot to drive.
        target: where to [m].
        heading: where the mouth is to point [rad].
        limits: how to drive; usually ``me.limits``.
        final_speed: speed allowed at the target [m/s].
        spare_mates: whether to avoid collisions with all robots, also while the ball is in play.
        sketch: records the whole path in the layer "paths", if that layer is watched.
        freedom: obstacles to avoid and areas that may be entered: :class:`~robobt.motion.scene.Freedom`.
    """
    goal = outside_stadium(frame, me, target)
    numbers = trip_numbers(me, goal, heading, final_speed if goal is target else 0.0, **freedom)
    trip = np.array(numbers, dtype=np.float64)
    scene, robots, own = scene_of(frame), movers_of(frame), limits_of(me.limits)
    if sketch is not None:
        sketch.point(TARGETS, target)
        if sketch.wants(PATHS):
            legs = _legs(trip.copy(), scene, robots, own).tolist()
            sketch.path(PATHS, [me.position, *((x, y) for x, y in legs)])
    other = limits is not me.limits
    return RobotCommand(*_travel(trip, scene, robots, own, limits_of(limits), other, spare_mates))


def allowed_target(
    frame: Frame, me: RobotState, target: Point, *, goalkeeper: bool = False, placing: bool = False
) -> Point:
    """Return the point nearest to ``target`` where the robot may stand.

    That is inside the walls, outside the opponents' defence area, outside the
    own one unless it is the goalkeeper, and far enough from the ball while the
    referee demands it; a robot that is ``placing`` the ball may stand in both areas.
    """
    return _allowed(trip_of(me, target, goalkeeper=goalkeeper, placing=placing), scene_of(frame))


def next_waypoint(
    frame: Frame, me: RobotState, target: Point, **freedom: Unpack[Freedom]
) -> tuple[Point, float]:
    """Return the next point of a free path to ``target``, and the speed at which to pass it [m/s].

    The speed is 0 for ``target`` itself. Moving robots are avoided at their predicted positions. An obstacle
    that the robot already overlaps, or that contains ``target``, blocks only paths that lead deeper into it.
    The options are those of :class:`~robobt.motion.scene.Freedom`.
    """
    trip = trip_of(me, target, **freedom)
    x, y, speed = _next(trip, scene_of(frame), movers_of(frame), limits_of(me.limits))
    return (x, y), speed


@compiled
def _travel(
    trip_: FloatArray,
    scene_: FloatArray,
    movers_: FloatArray,
    own_: FloatArray,
    given_: FloatArray,
    other: bool,
    spare_mates: bool,
) -> tuple[float, float, float]:
    trip, scene, movers = trip_.view(TRIP)[0], scene_.view(SCENE)[0], mover_records(movers_)
    own, given = own_.view(LIMITS)[0], given_.view(LIMITS)[0]
    return travel_law(trip, scene, movers, own, given, other, spare_mates)


@compiled
def _allowed(trip_: FloatArray, scene_: FloatArray) -> Point:
    return allowed_place(trip_.view(TRIP)[0], scene_.view(SCENE)[0])


@compiled
def _next(
    trip_: FloatArray, scene_: FloatArray, movers_: FloatArray, own_: FloatArray
) -> tuple[float, float, float]:
    trip: Trip = trip_.view(TRIP)[0]
    movers, own = mover_records(movers_), own_.view(LIMITS)[0]
    return waypoint_law(trip, (trip.x, trip.y), scene_.view(SCENE)[0], movers, own, True)


@compiled
def _legs(trip_: FloatArray, scene_: FloatArray, movers_: FloatArray, own_: FloatArray) -> FloatArray:
    """Return the points (n, 2) of the whole path, as if all other robots stood still.

    ``trip_`` is changed.
    """
    trip: Trip = trip_.view(TRIP)[0]
    scene: Scene = scene_.view(SCENE)[0]
    own: Limits = own_.view(LIMITS)[0]
    movers, goal, evades = mover_records(movers_), allowed_place(trip, scene), scene.evades > 0.0
    points = np.empty((_MOST_LEGS, 2))
    for leg in range(_MOST_LEGS):
        x, y, _ = waypoint_law(trip, goal, scene, movers, own, not evades)
        points[leg] = x, y
        if x == goal[0] and y == goal[1]:
            return points[: leg + 1]
        trip.me.x, trip.me.y = x, y
    return points


@compiled
def travel_law(
    trip: Trip,
    scene: Scene,
    movers: Sequence[Mover],
    own: Limits,
    given: Limits,
    other: bool,
    spare_mates: bool,
) -> tuple[float, float, float]:
    """Return the command of :func:`travel`, to a target outside the stadium.

    Args:
        trip: the robot and its target.
        scene: what the plan depends on.
        movers: everybody on the field, the own team first.
        own: what the robot can do.
        given: how it is to be driven.
        other: whether those are other limits than its own.
        spare_mates: whether to give way to everybody, in play too.

    Returns:
        The velocity ahead and to the left [m/s] and the turning rate [rad/s].
    """
    me, period = trip.me, scene.period
    gentle, top = other or own.trailing_time > 0.0, given.max_speed
    if scene.max_speed < top:
        gentle, top = True, scene.max_speed
    goal = allowed_place(trip, scene)
    evades = trip.avoids_robots > 0.0 and scene.evades > 0.0
    x, y, speed = waypoint_law(trip, goal, scene, movers, own, not evades)
    if x == goal[0] and y == goal[1]:
        speed = trip.final_speed if x == trip.x and y == trip.y else 0.0
    velocity = wanted_velocity(me, (x, y), speed, own, given, top, period)
    if evades:
        velocity = clear_velocity(trip, scene, movers, own, given, velocity, goal)
    omega = turn_law(me, trip.heading, own, given, period)
    ahead, left, omega = command_law(me, velocity, omega, own, given, top, gentle, period)
    mates = int(scene.mates)
    if trip.avoids_robots > 0.0 and scene.in_play == 0.0:
        ahead, left = slowed_towards(me, (ahead, left), movers[mates:], -1, 0)
    if spare_mates:
        ahead, left = slowed_towards(me, (ahead, left), movers, row_of(trip, scene, movers), mates)
    return ahead, left, omega


@compiled
def waypoint_law(
    trip: Trip, target: Point, scene: Scene, movers: Sequence[Mover], own: Limits, moving: bool
) -> tuple[float, float, float]:
    """Return the result of :func:`next_waypoint` for ``target``: x and y [m], and the speed there [m/s].

    The rest is as for :func:`travel_law`; ``moving`` says whether moving robots are avoided too.
    """
    x, y, vx, vy = trip.me.x, trip.me.y, trip.me.vx, trip.me.vy
    goal_x, goal_y, corner_first = _round_areas(trip, target, scene)
    circles = _obstacles(trip, scene, movers, goal_x, goal_y, moving)
    hit, radius = _first_hit(x, y, goal_x, goal_y, circles, not corner_first)
    if hit < 0:
        return goal_x, goal_y, own.max_speed * 0.5 if corner_first else 0.0
    acceleration = min(own.acceleration, own.lateral_acceleration)
    best_x, best_y, passing = goal_x, goal_y, 0.0
    least = inf
    speed = max(1.0, hypot(vx, vy))
    stands = hypot(vx, vy) < _STANDS and scene.keeps_off > 0.0
    for side in (1.0, -1.0):
        px, py, cost, arc, blocked = _detour((x, y), (goal_x, goal_y), hit, radius, side, side, circles)
        if blocked and stands:
            # The blocking obstacle may be passed on its other side; otherwise the choice would depend on
            # which is met first.
            between = _detour((x, y), (goal_x, goal_y), hit, radius, side, -side, circles)
            if between[2] < cost:
                px, py, cost, arc, blocked = between
        if side == scene.insists:
            cost -= _HEADSTRONG
        gap = hypot(px - x, py - y)
        if gap > 0.0:
            # Keep the side that the robot already drives to.
            cost -= 0.15 * (vx * (px - x) + vy * (py - y)) / (gap * speed)
        if not is_open(trip, scene, px, py, scene.their_gap):
            cost += 10.0
        if cost < least:
            bend = 1.0 / cos(min(arc, 2.8) / 2.0) - 1.0
            passing = sqrt(acceleration * max(radius, _CORNER_SLACK / max(bend, 1e-3)))
            best_x, best_y, least = px, py, cost
    return best_x, best_y, passing


@compiled_merged
def _round_areas(trip: Trip, target: Point, scene: Scene) -> tuple[float, float, bool]:
    """Return the target, or the first corner if a defence area is in the way; and whether one is."""
    x, y = trip.me.x, trip.me.y
    if trip.placing > 0.0:
        return target[0], target[1], False
    goal_x, goal_y, corner_first = _round_area(scene, x, y, target[0], target[1], scene.their_gap)
    if trip.goalkeeper == 0.0 and not corner_first:
        goal_x, goal_y, corner_first = _round_area(
            scene, -x, y, -target[0], target[1], ROBOT_RADIUS + ROBOT_AREA_GAP
        )
        goal_x = -goal_x
    return goal_x, goal_y, corner_first


@compiled_merged
def _round_area(
    scene: Scene, x: float, y: float, gx: float, gy: float, gap: float
) -> tuple[float, float, bool]:
    """Like :func:`_round_areas`, for one defence area at +x grown by ``gap``, and the target (gx, gy)."""
    front = scene.half_length - scene.area_depth - gap
    if x <= front and gx <= front:
        return gx, gy, False
    side = scene.area_width / 2 + gap
    if x > front and abs(y) < side:
        return gx, gy, False
    # The part of the way beyond the front edge, from (., ya) to (., yb).
    ya, yb = y, gy
    if x <= front:
        ya = y + (gy - y) * (front - x) / (gx - x)
    elif gx <= front:
        yb = y + (gy - y) * (front - x) / (gx - x)
    if max(ya, yb) <= -side or min(ya, yb) >= side:
        return gx, gy, False
    beside = y if x > front else gy
    return front - ROBOT_AREA_GAP, side + ROBOT_AREA_GAP if beside > 0.0 else -side - ROBOT_AREA_GAP, True


@compiled_merged
def _obstacles(
    trip: Trip, scene: Scene, movers: Sequence[Mover], gx: float, gy: float, moving: bool
) -> Sequence[_Circle]:
    """Return the obstacles near enough to matter, each where it will be when the robot gets there.

    ``moving`` says whether robots that move are among them.
    """
    x, y, ball = trip.me.x, trip.me.y, scene.ball
    circles: Sequence[_Circle] = records(len(movers) + 1, _CIRCLE)
    count = 0
    reach = hypot(gx - x, gy - y) + 1.0
    pace = 1.0 / max(1.0, hypot(trip.me.vx, trip.me.vy))
    if trip.avoids_robots > 0.0:
        skip = row_of(trip, scene, movers)
        for i, other in enumerate(movers):
            gap = hypot(other.x - x, other.y - y)
            if i != skip and gap < reach and (moving or not is_moving(other)):
                ahead, circle = min(_OBSTACLE_LOOK_AHEAD, gap * pace), circles[count]
                circle.x, circle.y = other.x + other.vx * ahead, other.y + other.vy * ahead
                circle.radius = STANDS_APART
                count += 1
    ball_radius = from_ball(trip, scene)
    if ball_radius > 0.0:
        ahead, circle = min(_OBSTACLE_LOOK_AHEAD, hypot(ball.x - x, ball.y - y) * pace), circles[count]
        circle.x, circle.y = ball.x + ball.vx * ahead, ball.y + ball.vy * ahead
        circle.radius = ball_radius
        count += 1
    return circles[:count]


@compiled
def _first_hit(
    x: float, y: float, gx: float, gy: float, circles: Sequence[_Circle], end_counts: bool
) -> tuple[int, float]:
    """Find the circle that the segment from (x, y) to (gx, gy) enters first.

    Each of ``circles`` is shrunk to leave out the segment's start. ``end_counts`` says whether one around the
    end is shrunk too.

    Returns:
        Its row, -1 without one, and its shrunk radius [m].
    """
    dx, dy = gx - x, gy - y
    length = hypot(dx, dy)
    hit, hit_radius = -1, 0.0
    if length < 1e-6:
        return hit, hit_radius
    ux, uy = dx / length, dy / length
    nearest = inf
    for i, circle in enumerate(circles):
        radius = circle.radius
        ox, oy = circle.x - x, circle.y - y
        ahead = ox * ux + oy * uy
        if ahead <= 0.0 or ahead >= length + radius:
            continue
        across = ox * uy - oy * ux
        if across >= radius or across <= -radius:
            continue
        to_start = hypot(ox, oy)
        if to_start < radius:
            radius = to_start * 0.999
        if end_counts:
            to_end = hypot(circle.x - gx, circle.y - gy)
            if to_end < radius:
                radius = to_end * 0.999
        half_chord = radius * radius - across * across
        if half_chord <= 0.0:
            continue
        entry = ahead - sqrt(half_chord)
        if entry < length and entry < nearest:
            nearest = entry
            hit, hit_radius = i, radius
    return hit, hit_radius


@compiled
def _detour(
    start: Point,
    goal: Point,
    hit: int,
    radius: float,
    side: float,
    others_side: float,
    circles: Sequence[_Circle],
) -> tuple[float, float, float, float, bool]:
    """Compute the first waypoint from ``start`` to ``goal`` round one of ``circles`` on one side.

    ``hit`` is which, of the shrunk ``radius`` [m]. A ``side`` of 1 leaves it to the right, -1 to the left;
    ``others_side`` is the same for what is in the way to it.

    Returns:
        The point where the tangents from start and end meet, x and y, the length of the
        path plus a penalty for what else is in it, the angle turned there, and whether anything
        was in the way to the circle.
    """
    # A loop instead of recursion, because numba's cache breaks recursive functions.
    costs, reaches, arcs = np.empty(_MOST_ROUND), np.empty(_MOST_ROUND), np.empty(_MOST_ROUND)
    x, y = start
    gx, gy = goal
    others = circles
    n = 0
    while True:
        cx, cy = others[hit].x, others[hit].y
        wide = radius + _CLEARANCE
        to_start, to_end = hypot(x - cx, y - cy), hypot(gx - cx, gy - cy)
        near, far = min(wide, to_start), min(wide, to_end)
        turned = (atan2(y - cy, x - cx) - atan2(gy - cy, gx - cx)) * side % (2.0 * pi)
        to_tangent = acos(near / to_start) if to_start > 0.0 else 0.0
        arc = max(0.0, turned - to_tangent - (acos(far / to_end) if to_end > 0.0 else 0.0))
        leg = sqrt(max(0.0, to_start * to_start - near * near))
        cost = leg + wide * arc + sqrt(max(0.0, to_end * to_end - far * far))
        tangent = atan2(cy - y, cx - x) + side * (pi / 2.0 - to_tangent)
        reach = leg + near * tan(min(arc / 2.0, _WIDEST_TURN)) + 0.01
        corner_x, corner_y = x + reach * cos(tangent), y + reach * sin(tangent)
        if n == _MOST_ROUND:
            break
        others = _without(others, cx, cy)
        hit, radius = _first_hit(x, y, corner_x, corner_y, others, False)
        if hit < 0:
            if _first_hit(corner_x, corner_y, gx, gy, others, True)[0] >= 0:
                cost += 0.2
            break
        # An obstacle is in the way to the corner, so avoid it first.
        costs[n], reaches[n], arcs[n] = cost, reach, arc
        n += 1
        gx, gy, side = corner_x, corner_y, others_side
    for k in range(n - 1, -1, -1):
        cost = costs[k] + cost - reaches[k] + 0.1
        arc = arcs[k] + arc
    return corner_x, corner_y, cost, arc, n > 0


@compiled_merged
def _without(circles: Sequence[_Circle], x: float, y: float) -> Sequence[_Circle]:
    """Return the circles except those around (x, y)."""
    rest: MutableSequence[_Circle] = records(len(circles), _CIRCLE)
    count = 0
    for circle in circles:
        if circle.x != x or circle.y != y:
            rest[count] = circle
            count += 1
    return rest[:count]
