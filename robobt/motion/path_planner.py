"""Find the next waypoint around robots, ball and defence areas, and drive there.

The plan is made anew every tick and only its first leg is driven. Obstacles are
circles; a blocked path leaves along the tangent of the first circle on it, on
the side with the shorter way round. Defence areas are passed by their corners.

Source of the idea and the clearances: RoboBulls' published code (FPPA planner);
tangents, side choice and moving obstacles are robobt's.
"""

from __future__ import annotations

from functools import lru_cache
from math import cos, hypot, inf, sqrt

import numpy as np

from robobt.motion.arrival import VX, VY, X, Y, movers_of, place_of
from robobt.motion.detour import detour, first_hit
from robobt.motion.give_way import give_way
from robobt.motion.pilot import drive
from robobt.motion.stadium import outside_stadium
from robobt.world.command import RobotCommand
from robobt.world.compiled import compiled
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.limits import RobotLimits
from robobt.world.rules import (
    AREA_DISTANCE,
    STOP_DISTANCE,
    STOP_SPEED,
    in_own_defense_area,
    in_their_defense_area,
)
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState

ROBOT_GAP = 0.03
"""Gap to another robot below which a way is blocked [m]."""
BALL_GAP = 0.01
"""Gap to an avoided ball below which a way is blocked [m]. Source: RoboBulls' published code."""

_ROBOTS_APART = 2.0 * ROBOT_RADIUS + ROBOT_GAP
_NOBODY = np.empty((0, 7))
_AREA_GAP = 0.02
_WALL_GAP = 0.02
_LOOK_AHEAD = 0.4
"""Longest time an obstacle is moved ahead along its velocity [s]."""
_INSIST = 1.5
"""For how long a robot that the match waits for tries one way round [s]."""
_HEADSTRONG = 0.5
"""How much longer the way round on that side may be [m]."""
_CORNER_SLACK = 0.05
"""How far a waypoint may be cut or overshot [m]; decides the speed there."""


def travel(
    frame: Frame,
    me: RobotState,
    target: Point,
    heading: float,
    limits: RobotLimits,
    *,
    avoid_robots: bool = True,
    avoid_ball: bool = False,
    goalkeeper: bool = False,
    placing: bool = False,
    ball_gap: float = BALL_GAP,
    final_speed: float = 0.0,
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
        avoid_robots: whether to go round other robots.
        avoid_ball: whether to go round the ball.
        goalkeeper: may enter the own defence area.
        placing: may enter both defence areas, as the robot that places the ball may.
        ball_gap: how far to stay from an avoided ball, hull to ball [m].
        final_speed: speed allowed at the target [m/s].
    """
    game = frame.game
    if game.stopped and limits.max_speed > STOP_SPEED:
        limits = slowed(limits, STOP_SPEED)
    goal = outside_stadium(frame, me, target)
    goal = allowed_target(frame, me, goal, goalkeeper=goalkeeper, placing=placing)
    if goal != target:
        final_speed = 0.0
    point, speed = next_waypoint(
        frame,
        me,
        goal,
        avoid_robots=avoid_robots,
        avoid_ball=avoid_ball,
        goalkeeper=goalkeeper,
        placing=placing,
        ball_gap=ball_gap,
    )
    order = drive(me, point, heading, limits, frame.period, final_speed if point == goal else speed)
    return order if game.in_play or not avoid_robots else give_way(frame, me, order)


@lru_cache(maxsize=256)
def slowed(limits: RobotLimits, max_speed: float) -> RobotLimits:
    """Return the same limits with a top speed of at most ``max_speed`` [m/s]."""
    if limits.max_speed <= max_speed:
        return limits
    return limits.model_copy(update={"max_speed": max_speed})


def allowed_target(
    frame: Frame, me: RobotState, target: Point, *, goalkeeper: bool = False, placing: bool = False
) -> Point:
    """Return the point nearest to ``target`` where the robot may stand.

    That is inside the walls, outside the opponents' defence area, outside the
    own one unless it is the goalkeeper, and far enough from the ball while the
    referee demands it; a robot that is ``placing`` the ball may stand in both areas.
    """
    field = frame.field
    x, y = target
    if _keep_off(frame):
        x, y = _away_from_ball(frame, me, x, y)
    most_y = field.half_width + field.margin - ROBOT_RADIUS - _WALL_GAP
    y = min(most_y, max(-most_y, y))
    # Behind the goal line there is the goal or a strip too narrow to be of use near it.
    beside_goal = abs(y) > field.goal_width / 2 + ROBOT_RADIUS + _WALL_GAP
    behind = field.goal_line_margin - ROBOT_RADIUS - _WALL_GAP if beside_goal else 0.0
    most_x = field.half_length + behind
    x = min(most_x, max(-most_x, x))
    if placing:
        return (x, y)
    x, y = _expelled(field, x, y, _their_gap(frame))
    if not goalkeeper:
        x, y = _expelled(field, -x, y, ROBOT_RADIUS + _AREA_GAP)
        x = -x
    return (x, y)


def next_waypoint(
    frame: Frame,
    me: RobotState,
    target: Point,
    *,
    avoid_robots: bool = True,
    avoid_ball: bool = False,
    goalkeeper: bool = False,
    placing: bool = False,
    ball_gap: float = BALL_GAP,
) -> tuple[Point, float]:
    """Return the next point of a free path to ``target``, and the speed at which to pass it [m/s].

    The speed is 0 for ``target`` itself. An obstacle that the robot already
    overlaps, or that ``target`` lies in, blocks only ways that lead deeper into it.
    """
    field = frame.field
    x, y = me.x, me.y
    their_gap = _their_gap(frame)
    goal = target if placing else _around_area(field, x, y, target, their_gap)
    if not goalkeeper and not placing and goal is target:
        corner = _around_area(field, -x, y, (-target[0], target[1]), ROBOT_RADIUS + _AREA_GAP)
        if corner != (-target[0], target[1]):
            goal = (-corner[0], corner[1])
    corner_first = goal != target
    hit, radius, circles = -1, 0.0, _NOBODY
    keep_off = _keep_off(frame)
    if avoid_robots or avoid_ball or keep_off:
        ball = frame.ball
        ball_radius = -1.0
        if avoid_ball or keep_off:
            ball_radius = ROBOT_RADIUS + BALL_RADIUS + (STOP_DISTANCE if keep_off else ball_gap)
        way = (x, y, me.vx, me.vy, *goal, ball.x, ball.y, ball.vx, ball.vy, ball_radius)
        robots = movers_of(frame) if avoid_robots else _NOBODY
        hit, radius, circles = _blocked(
            np.array(way, dtype=np.float64), robots, place_of(frame, me), not corner_first
        )
    if hit < 0:
        return (goal, me.limits.max_speed * 0.5 if corner_first else 0.0)
    ends = (float(x), float(y), float(goal[0]), float(goal[1]))
    first = np.array((circles[hit, 0], circles[hit, 1], radius))
    acceleration = min(me.limits.acceleration, me.limits.lateral_acceleration)
    best = (goal, 0.0)
    least = inf
    speed = max(1.0, hypot(me.vx, me.vy))
    insists = 0.0
    late = frame.game.action_time
    if late is not None and late < 0.0 and not frame.game.in_play:
        # The match waits; a robot that sways between two like ways tries one for a while, then the other.
        insists = 1.0 if int(frame.time / _INSIST) % 2 == 0 else -1.0
    for side in (1.0, -1.0):
        px, py, cost, arc = detour(*ends, first, side, circles, 4)
        if side == insists:
            cost -= _HEADSTRONG
        gap = hypot(px - x, py - y)
        if gap > 0.0:
            # Keep to the side one is already driving to.
            cost -= 0.15 * (me.vx * (px - x) + me.vy * (py - y)) / (gap * speed)
        if not _open(field, px, py, their_gap, goalkeeper, placing):
            cost += 10.0
        if cost < least:
            bend = 1.0 / cos(min(arc, 2.8) / 2.0) - 1.0
            passing = sqrt(acceleration * max(radius, _CORNER_SLACK / max(bend, 1e-3)))
            best, least = ((px, py), passing), cost
    return best


def _keep_off(frame: Frame) -> bool:
    game = frame.game
    return game.stopped or (game.restart is not None and game.restart_team is not frame.team)


def _their_gap(frame: Frame) -> float:
    game = frame.game
    extra = AREA_DISTANCE if game.stopped or game.restart is not None else _AREA_GAP
    return ROBOT_RADIUS + extra


def _away_from_ball(frame: Frame, me: RobotState, x: float, y: float) -> Point:
    ball = frame.ball
    keep = STOP_DISTANCE + ROBOT_RADIUS + BALL_RADIUS
    dx, dy = x - ball.x, y - ball.y
    gap = hypot(dx, dy)
    if gap >= keep:
        return (x, y)
    if gap < 1e-3:
        dx, dy = me.x - ball.x, me.y - ball.y
        gap = hypot(dx, dy)
        if gap < 1e-3:
            dx, dy, gap = -1.0, 0.0, 1.0
    return (ball.x + dx * keep / gap, ball.y + dy * keep / gap)


def _expelled(field: FieldGeometry, x: float, y: float, gap: float) -> Point:
    """Move (x, y) out of the defence area at +x, grown by ``gap``, over its nearest edge."""
    front = field.half_length - field.defense_depth - gap
    side = field.defense_width / 2 + gap
    if x <= front or abs(y) >= side:
        return (x, y)
    if x - front <= side - abs(y):
        return (front, y)
    return (x, side if y >= 0.0 else -side)


def _around_area(field: FieldGeometry, x: float, y: float, target: Point, gap: float) -> Point:
    """Return ``target``, or the corner to go to first when the defence area at +x is in the way."""
    gx, gy = target
    front = field.half_length - field.defense_depth - gap
    if x <= front and gx <= front:
        return target
    side = field.defense_width / 2 + gap
    if x > front and abs(y) < side:
        return target
    # The part of the way beyond the front edge, from (., ya) to (., yb).
    ya, yb = y, gy
    if x <= front:
        ya = y + (gy - y) * (front - x) / (gx - x)
    elif gx <= front:
        yb = y + (gy - y) * (front - x) / (gx - x)
    if max(ya, yb) <= -side or min(ya, yb) >= side:
        return target
    if x > front:
        return (front - _AREA_GAP, side + _AREA_GAP if y > 0.0 else -side - _AREA_GAP)
    return (front - _AREA_GAP, side + _AREA_GAP if gy > 0.0 else -side - _AREA_GAP)


def _open(
    field: FieldGeometry, x: float, y: float, their_gap: float, goalkeeper: bool, placing: bool
) -> bool:
    most_x = field.half_length + (field.goal_line_margin - ROBOT_RADIUS)
    most_y = field.half_width + (field.margin - ROBOT_RADIUS)
    if abs(x) > most_x or abs(y) > most_y:
        return False
    if placing:
        return True
    if in_their_defense_area(field, x, y, their_gap - _AREA_GAP):
        return False
    return goalkeeper or not in_own_defense_area(field, x, y, ROBOT_RADIUS)


@compiled
def _blocked(
    way: FloatArray, robots: FloatArray, skip: int, end_counts: bool
) -> tuple[int, float, FloatArray]:
    """Return what :func:`first_hit` does and the obstacles (n, 3) near enough to matter.

    Each is where it will be when the robot gets there.

    Args:
        way: place and velocity of the robot, where it drives to, place and velocity of the ball, and how far
            to stay from the ball; below 0 it is no obstacle. An array, for numba would compile anew for every
            mixture of int and float.
        robots: as of movers.
        skip: the row of the robot itself.
        end_counts: as for :func:`first_hit`.
    """
    x, y, gx, gy, ball_radius = way[0], way[1], way[4], way[5], way[10]
    circles = np.empty((len(robots) + 1, 3))
    n = 0
    reach = hypot(gx - x, gy - y) + 1.0
    pace = 1.0 / max(1.0, hypot(way[2], way[3]))
    for i in range(len(robots)):
        ox, oy = robots[i, X], robots[i, Y]
        gap = hypot(ox - x, oy - y)
        if i != skip and gap < reach:
            ahead = min(_LOOK_AHEAD, gap * pace)
            circles[n] = (ox + robots[i, VX] * ahead, oy + robots[i, VY] * ahead, _ROBOTS_APART)
            n += 1
    if ball_radius >= 0.0:
        ahead = min(_LOOK_AHEAD, hypot(way[6] - x, way[7] - y) * pace)
        circles[n] = (way[6] + way[8] * ahead, way[7] + way[9] * ahead, ball_radius)
        n += 1
    circles = circles[:n]
    hit, radius = first_hit(x, y, gx, gy, circles, end_counts)
    return hit, radius, circles
