"""What a plan of :mod:`robobt.motion.path_planner` depends on, as numbers, and where robots may stand.

It comes in arrays that are made once a frame and once a call: one call of compiled code costs a few
microseconds, and a plan takes a dozen steps.
"""

from __future__ import annotations

from math import hypot, inf

import numpy as np

from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, Point
from robobt.world.rules import AREA_DISTANCE, STOP_DISTANCE, STOP_SPEED, in_area
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState

TARGET_X, TARGET_Y, HEADING, FINAL_SPEED, BALL_GAP = 6, 7, 8, 9, 10
AVOID_ROBOTS, GOALKEEPER, PLACING, NUMBER = 11, 12, 13, 14
"""Entries of a task; before them are x, y, heading, vx, vy and omega of the robot."""

(
    HALF_LENGTH,
    HALF_WIDTH,
    HALF_GOAL,
    DEPTH,
    AREA_WIDTH,
    MARGIN,
    BEHIND,
    BALL_X,
    BALL_Y,
    BALL_VX,
    BALL_VY,
    PERIOD,
    KEEP_OFF,
    THEIR_GAP,
    INSISTS,
    IN_PLAY,
    MOST_SPEED,
    EVADES,
    NUMBERS,
) = range(19)
"""Entries of a scene; from the last on there are the numbers of the own robots.

``EVADES`` says whether ways evade robots that move; with 0 they go round where those will be.
"""

AREA_GAP = 0.02
"""From a defence area to a robot that may not enter it [m]."""

_WALL_GAP = 0.02
_INSIST = 1.5
"""For how long a robot that the match waits for tries one way round [s]."""


def scene_of(frame: Frame) -> FloatArray:
    """Return what every plan in a frame depends on but the robots; made once a frame."""
    made: FloatArray | None = frame.made.get("scene")
    if made is not None:
        return made
    field, ball, game = frame.field, frame.ball, frame.game
    stopped, in_play, late = game.stopped, game.in_play, game.action_time
    keep_off = stopped or (game.restart is not None and game.restart_team is not frame.team)
    extra = AREA_DISTANCE if stopped or game.restart is not None else AREA_GAP
    insists = 0.0
    if late is not None and late < 0.0 and not in_play:
        # The match waits; a robot that sways between two like ways tries one for a while, then the other.
        insists = 1.0 if int(frame.time / _INSIST) % 2 == 0 else -1.0
    scene = (
        field.half_length,
        field.half_width,
        field.goal_width / 2,
        field.defense_depth,
        field.defense_width,
        field.margin,
        field.goal_line_margin,
        ball.x,
        ball.y,
        ball.vx,
        ball.vy,
        frame.period,
        keep_off,
        ROBOT_RADIUS + extra,
        insists,
        in_play,
        STOP_SPEED if stopped else inf,
        True,
        *[robot.id for robot in frame.own],
    )
    made = frame.made["scene"] = np.array(scene, dtype=np.float64)
    return made


def task_of(
    me: RobotState,
    target: Point,
    heading: float = 0.0,
    final_speed: float = 0.0,
    *,
    avoid_robots: bool = True,
    ball_gap: float = -1.0,
    goalkeeper: bool = False,
    placing: bool = False,
) -> FloatArray:
    """Return what one robot is to do; of the ball it stays clear where ``ball_gap`` is not negative.

    Arguments as for :func:`robobt.motion.path_planner.travel`.
    """
    row = (
        me.x,
        me.y,
        me.heading,
        me.vx,
        me.vy,
        me.omega,
        target[0],
        target[1],
        heading,
        final_speed,
        ball_gap,
        avoid_robots,
        goalkeeper,
        placing,
        me.id,
    )
    return np.array(row, dtype=np.float64)


@compiled
def allowed_numbers(task: FloatArray, scene: FloatArray) -> Point:
    """Do what :func:`robobt.motion.path_planner.allowed_target` does."""
    x, y = task[TARGET_X], task[TARGET_Y]
    if scene[KEEP_OFF] > 0.0:
        x, y = _away_from_ball(task, scene, x, y)
    most_y = scene[HALF_WIDTH] + scene[MARGIN] - ROBOT_RADIUS - _WALL_GAP
    y = min(most_y, max(-most_y, y))
    # Behind the goal line there is the goal or a strip too narrow to be of use near it.
    beside_goal = abs(y) > scene[HALF_GOAL] + ROBOT_RADIUS + _WALL_GAP
    behind = scene[BEHIND] - ROBOT_RADIUS - _WALL_GAP if beside_goal else 0.0
    most_x = scene[HALF_LENGTH] + behind
    x = min(most_x, max(-most_x, x))
    if task[PLACING] > 0.0:
        return (x, y)
    x, y = _expelled(scene, x, y, scene[THEIR_GAP])
    if task[GOALKEEPER] == 0.0:
        x, y = _expelled(scene, -x, y, ROBOT_RADIUS + AREA_GAP)
        x = -x
    return (x, y)


@compiled
def row_of(task: FloatArray, scene: FloatArray) -> int:
    """Return the robot's row among the movers, -1 where it is not in the frame."""
    for place in range(len(scene) - NUMBERS):
        if scene[NUMBERS + place] == task[NUMBER]:
            return place
    return -1


@compiled
def from_ball(task: FloatArray, scene: FloatArray) -> float:
    """Return how far its centre has to stay from the ball's, 0 where that is no obstacle [m]."""
    if scene[KEEP_OFF] > 0.0:
        return ROBOT_RADIUS + BALL_RADIUS + STOP_DISTANCE
    return ROBOT_RADIUS + BALL_RADIUS + task[BALL_GAP] if task[BALL_GAP] >= 0.0 else 0.0


@compiled
def _away_from_ball(task: FloatArray, scene: FloatArray, x: float, y: float) -> Point:
    bx, by = scene[BALL_X], scene[BALL_Y]
    keep = STOP_DISTANCE + ROBOT_RADIUS + BALL_RADIUS
    dx, dy = x - bx, y - by
    gap = hypot(dx, dy)
    if gap >= keep:
        return (x, y)
    if gap < 1e-3:
        dx, dy = task[0] - bx, task[1] - by
        gap = hypot(dx, dy)
        if gap < 1e-3:
            dx, dy, gap = -1.0, 0.0, 1.0
    return (bx + dx * keep / gap, by + dy * keep / gap)


@compiled
def _expelled(scene: FloatArray, x: float, y: float, gap: float) -> Point:
    """Move (x, y) out of the defence area at +x, grown by ``gap``, over its nearest edge."""
    front = scene[HALF_LENGTH] - scene[DEPTH] - gap
    side = scene[AREA_WIDTH] / 2 + gap
    if x <= front or abs(y) >= side:
        return (x, y)
    if x - front <= side - abs(y):
        return (front, y)
    return (x, side if y >= 0.0 else -side)


@compiled
def around_area(
    scene: FloatArray, x: float, y: float, gx: float, gy: float, gap: float
) -> tuple[float, float, bool]:
    """Return (gx, gy), or the corner to go to first where the defence area at +x is in the way; and if so."""
    front = scene[HALF_LENGTH] - scene[DEPTH] - gap
    if x <= front and gx <= front:
        return gx, gy, False
    side = scene[AREA_WIDTH] / 2 + gap
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
    return front - AREA_GAP, side + AREA_GAP if beside > 0.0 else -side - AREA_GAP, True


@compiled
def is_open(scene: FloatArray, x: float, y: float, goalkeeper: bool, placing: bool) -> bool:
    """Return whether a robot may pass (x, y)."""
    half_length, depth, width = scene[HALF_LENGTH], scene[DEPTH], scene[AREA_WIDTH]
    most_x = half_length + (scene[BEHIND] - ROBOT_RADIUS)
    most_y = scene[HALF_WIDTH] + (scene[MARGIN] - ROBOT_RADIUS)
    if abs(x) > most_x or abs(y) > most_y:
        return False
    if placing:
        return True
    if in_area(x, y, half_length, depth, width, scene[THEIR_GAP] - AREA_GAP):
        return False
    return goalkeeper or not in_area(-x, y, half_length, depth, width, ROBOT_RADIUS)
