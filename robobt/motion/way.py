"""The arithmetic of :mod:`robobt.motion.path_planner`, compiled."""

from __future__ import annotations

from math import cos, hypot, inf, sqrt

import numpy as np

from robobt.motion.arrival import VX, VY, X, Y
from robobt.motion.detour import detour, first_hit
from robobt.motion.give_way import slowed_towards
from robobt.motion.scene import (
    AREA_GAP,
    AVOID_ROBOTS,
    BALL_VX,
    BALL_VY,
    BALL_X,
    BALL_Y,
    EVADES,
    FINAL_SPEED,
    GOALKEEPER,
    IN_PLAY,
    INSISTS,
    KEEP_OFF,
    MOST_SPEED,
    NUMBERS,
    PERIOD,
    PLACING,
    TARGET_X,
    TARGET_Y,
    THEIR_GAP,
    allowed_numbers,
    around_area,
    from_ball,
    is_open,
    row_of,
)
from robobt.motion.speeds import (
    FORWARD,
    LATERAL,
    REACTION,
    TOP,
    command_numbers,
    turn_rate_numbers,
    wanted_velocity,
)
from robobt.motion.velocity_obstacles import STANDS_APART, clear_velocity, is_moving
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray
from robobt.world.state import ROBOT_RADIUS

_LOOK_AHEAD = 0.4
"""Longest time an obstacle is moved ahead along its velocity [s]."""
_HEADSTRONG = 0.5
"""How much longer the way round on that side may be [m]."""
_STANDS = 0.25
"""A slower robot is not under way yet [m/s]."""
_CORNER_SLACK = 0.05
"""How far a waypoint may be cut or overshot [m]; decides the speed there."""


@compiled
def travel_numbers(
    task: FloatArray,
    scene: FloatArray,
    robots: FloatArray,
    own: FloatArray,
    given: FloatArray,
    other: bool,
    spare_mates: bool,
) -> tuple[float, float, float]:
    """Do what :func:`robobt.motion.path_planner.travel` does, to a target outside the stadium.

    Args:
        task: as of :func:`~robobt.motion.scene.task_of`.
        scene: as of :func:`~robobt.motion.scene.scene_of`.
        robots: as of :func:`~robobt.motion.arrival.movers_of`.
        own: what the robot can do, as of :func:`~robobt.motion.speeds.numbers`.
        given: how it is to be driven.
        other: whether those are other limits than its own.
        spare_mates: whether to give way to everybody, in play too.

    Returns:
        The velocity ahead and to the left [m/s] and the turning rate [rad/s].
    """
    gentle = other or own[REACTION] > 0.0
    if scene[MOST_SPEED] < given[TOP]:
        given = given.copy()
        given[TOP] = scene[MOST_SPEED]
        gentle = True
    goal_x, goal_y = allowed_numbers(task, scene)
    final_speed = task[FINAL_SPEED] if goal_x == task[TARGET_X] and goal_y == task[TARGET_Y] else 0.0
    task = task.copy()
    task[TARGET_X], task[TARGET_Y] = goal_x, goal_y
    evades = task[AVOID_ROBOTS] > 0.0 and scene[EVADES] > 0.0
    x, y, speed = waypoint_numbers(task, scene, robots, own, not evades)
    task[TARGET_X], task[TARGET_Y] = x, y
    task[FINAL_SPEED] = final_speed if x == goal_x and y == goal_y else speed
    state, leg = task[:TARGET_X], task[TARGET_X : FINAL_SPEED + 1]
    vx, vy = wanted_velocity(state, leg, own, given, scene[PERIOD])
    if evades:
        vx, vy = clear_velocity(task, scene, robots, own, given, (vx, vy), (goal_x, goal_y))
    omega = turn_rate_numbers(state, leg[2], own, given, scene[PERIOD])
    vx, vy, omega = command_numbers(state, vx, vy, omega, own, given, gentle, scene[PERIOD])
    now, mates = np.array((state[0], state[1], state[2], vx, vy)), len(scene) - NUMBERS
    if task[AVOID_ROBOTS] > 0.0 and scene[IN_PLAY] == 0.0:
        now[3], now[4] = slowed_towards(now, robots[mates:], -1, 0)
    if spare_mates:
        now[3], now[4] = slowed_towards(now, robots, row_of(task, scene), mates)
    return now[3], now[4], omega


@compiled
def waypoint_numbers(
    task: FloatArray, scene: FloatArray, robots: FloatArray, own: FloatArray, moving: bool
) -> tuple[float, float, float]:
    """Do what :func:`robobt.motion.path_planner.next_waypoint` does.

    Arguments as for :func:`travel_numbers`, and whether robots that move are gone round too. Returns the
    point's x and y [m], and the speed there [m/s].
    """
    target_x, target_y = task[TARGET_X], task[TARGET_Y]
    x, y, vx, vy = task[0], task[1], task[3], task[4]
    their_gap, placing, goalkeeper = scene[THEIR_GAP], task[PLACING] > 0.0, task[GOALKEEPER] > 0.0
    goal_x, goal_y, corner_first = target_x, target_y, False
    if not placing:
        goal_x, goal_y, corner_first = around_area(scene, x, y, target_x, target_y, their_gap)
        if not goalkeeper and not corner_first:
            goal_x, goal_y, corner_first = around_area(
                scene, -x, y, -target_x, target_y, ROBOT_RADIUS + AREA_GAP
            )
            goal_x = -goal_x
    circles = _obstacles(task, scene, robots, goal_x, goal_y, moving)
    hit, radius = first_hit(x, y, goal_x, goal_y, circles, not corner_first)
    if hit < 0:
        return goal_x, goal_y, own[TOP] * 0.5 if corner_first else 0.0
    first = np.array((circles[hit, 0], circles[hit, 1], radius))
    acceleration = min(own[FORWARD], own[LATERAL])
    best_x, best_y, passing = goal_x, goal_y, 0.0
    least = inf
    speed = max(1.0, hypot(vx, vy))
    stands = hypot(vx, vy) < _STANDS and scene[KEEP_OFF] > 0.0
    for side in (1.0, -1.0):
        px, py, cost, arc, blocked = detour(x, y, goal_x, goal_y, first, side, side, circles, 4)
        if blocked and stands:
            # What is in the way may be passed on its other side: else the choice turns on which is met first.
            between = detour(x, y, goal_x, goal_y, first, side, -side, circles, 4)
            if between[2] < cost:
                px, py, cost, arc, blocked = between
        if side == scene[INSISTS]:
            cost -= _HEADSTRONG
        gap = hypot(px - x, py - y)
        if gap > 0.0:
            # Keep to the side one is already driving to.
            cost -= 0.15 * (vx * (px - x) + vy * (py - y)) / (gap * speed)
        if not is_open(scene, px, py, goalkeeper, placing):
            cost += 10.0
        if cost < least:
            bend = 1.0 / cos(min(arc, 2.8) / 2.0) - 1.0
            passing = sqrt(acceleration * max(radius, _CORNER_SLACK / max(bend, 1e-3)))
            best_x, best_y, least = px, py, cost
    return best_x, best_y, passing


@compiled
def _obstacles(
    task: FloatArray,
    scene: FloatArray,
    robots: FloatArray,
    gx: float,
    gy: float,
    moving: bool,
) -> FloatArray:
    """Return the obstacles (n, 3) near enough to matter, each where it will be when the robot gets there.

    ``moving`` says whether robots that move are among them.
    """
    x, y = task[0], task[1]
    circles = np.empty((len(robots) + 1, 3))
    n = 0
    reach = hypot(gx - x, gy - y) + 1.0
    pace = 1.0 / max(1.0, hypot(task[3], task[4]))
    if task[AVOID_ROBOTS] > 0.0:
        skip = row_of(task, scene)
        for i in range(len(robots)):
            ox, oy = robots[i, X], robots[i, Y]
            gap = hypot(ox - x, oy - y)
            if i != skip and gap < reach and (moving or not is_moving(robots, i)):
                ahead = min(_LOOK_AHEAD, gap * pace)
                circles[n] = (ox + robots[i, VX] * ahead, oy + robots[i, VY] * ahead, STANDS_APART)
                n += 1
    ball_radius = from_ball(task, scene)
    if ball_radius > 0.0:
        bx, by = scene[BALL_X], scene[BALL_Y]
        ahead = min(_LOOK_AHEAD, hypot(bx - x, by - y) * pace)
        circles[n] = (bx + scene[BALL_VX] * ahead, by + scene[BALL_VY] * ahead, ball_radius)
        n += 1
    return circles[:n]
