"""The input of :mod:`robobt.motion.path_planner` as numbers, and the places where robots may stand.

The arrays are made once per frame and once per call, because one call of compiled code costs a few
microseconds and a plan takes a dozen steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf
from typing import TypedDict, Unpack

import numpy as np

from robobt.world.compiled import compiled_merged
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import SCENE, Mover, Scene, Trip
from robobt.world.rules import AREA_DISTANCE, STOP_DISTANCE, STOP_SPEED, in_area
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState

ROBOT_AREA_GAP = 0.02
"""Distance from a defence area to a robot that may not enter it [m]."""

BALL_GAP = 0.01
"""Gap to an avoided ball below which a way is blocked [m]. Source: RoboBulls' published code."""

_WALL_GAP = 0.02
_INSIST = 1.5
"""How long a robot that the match waits for tries one way round [s]."""

_EVADES = SCENE.fields["evades"][1] // 8 if SCENE.fields else 0


class Freedom(TypedDict, total=False):
    """The obstacles that a path has to avoid, and the areas that it may enter.

    Attributes:
        avoid_robots: whether to go round other robots; True unless given.
        avoid_ball: whether to go round the ball.
        ball_gap: how far to stay from an avoided ball, hull to ball [m]; :data:`BALL_GAP` unless given.
        goalkeeper: may enter the own defence area.
        placing: may enter both defence areas, as the robot that places the ball may.
    """

    avoid_robots: bool
    avoid_ball: bool
    ball_gap: float
    goalkeeper: bool
    placing: bool


def scene_of(frame: Frame) -> FloatArray:
    """Return the :class:`~robobt.world.records.Scene` of every plan in a frame; made once a frame."""
    made: FloatArray | None = frame.made.get("scene")
    if made is not None:
        return made
    field, ball, game = frame.field, frame.ball, frame.game
    stopped, in_play, late = game.stopped, game.in_play, game.action_time
    extra = AREA_DISTANCE if stopped or game.restart is not None else ROBOT_AREA_GAP
    insists = 0.0
    if late is not None and late < 0.0 and not in_play:
        # The match waits: a robot that sways between two similar paths tries one for a while, then the other.
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
        stopped or (game.restart is not None and game.restart_team is not frame.team),
        ROBOT_RADIUS + extra,
        insists,
        in_play,
        STOP_SPEED if stopped else inf,
        True,
        len(frame.own),
    )
    made = frame.made["scene"] = np.array(scene, dtype=np.float64)
    return made


def evade(frame: Frame, evades: bool) -> None:
    """Make paths in this frame evade moving robots by velocity, or lead round their predicted positions."""
    scene_of(frame)[_EVADES] = evades


def trip_of(
    me: RobotState,
    target: Point,
    heading: float = 0.0,
    final_speed: float = 0.0,
    **freedom: Unpack[Freedom],
) -> FloatArray:
    """Return the :class:`~robobt.world.records.Trip` of one robot."""
    return np.array(trip_numbers(me, target, heading, final_speed, **freedom), dtype=np.float64)


def trip_numbers(
    me: RobotState,
    target: Point,
    heading: float = 0.0,
    final_speed: float = 0.0,
    *,
    avoid_robots: bool = True,
    avoid_ball: bool = False,
    ball_gap: float = BALL_GAP,
    goalkeeper: bool = False,
    placing: bool = False,
) -> tuple[float, ...]:
    """Return the numbers of a :class:`~robobt.world.records.Trip`; options as of :class:`Freedom`."""
    return (
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
        ball_gap if avoid_ball else -1.0,
        avoid_robots,
        goalkeeper,
        placing,
        me.id,
    )


@compiled_merged
def allowed_place(trip: Trip, scene: Scene) -> Point:
    """Return the point nearest to the target where the robot may stand."""
    x, y = trip.x, trip.y
    if scene.keeps_off > 0.0:
        x, y = _away_from_ball(trip, scene)
    most_y = scene.half_width + scene.margin - ROBOT_RADIUS - _WALL_GAP
    y = min(most_y, max(-most_y, y))
    # Behind the goal line there is only the goal or a strip too narrow to be useful.
    beside_goal = abs(y) > scene.half_goal + ROBOT_RADIUS + _WALL_GAP
    behind = scene.behind - ROBOT_RADIUS - _WALL_GAP if beside_goal else 0.0
    most_x = scene.half_length + behind
    x = min(most_x, max(-most_x, x))
    if trip.placing > 0.0:
        return (x, y)
    x, y = _expelled(scene, x, y, scene.their_gap)
    if trip.goalkeeper == 0.0:
        x, y = _expelled(scene, -x, y, ROBOT_RADIUS + ROBOT_AREA_GAP)
        x = -x
    return (x, y)


@compiled_merged
def row_of(trip: Trip, scene: Scene, movers: Sequence[Mover]) -> int:
    """Return the robot's row among the movers, -1 where it is not in the frame."""
    for row in range(int(scene.mates)):
        if movers[row].number == trip.number:
            return row
    return -1


@compiled_merged
def _away_from_ball(trip: Trip, scene: Scene) -> Point:
    x, y, bx, by = trip.x, trip.y, scene.ball.x, scene.ball.y
    keep = STOP_DISTANCE + ROBOT_RADIUS + BALL_RADIUS
    dx, dy = x - bx, y - by
    gap = hypot(dx, dy)
    if gap >= keep:
        return (x, y)
    if gap < 1e-3:
        dx, dy = trip.me.x - bx, trip.me.y - by
        gap = hypot(dx, dy)
        if gap < 1e-3:
            dx, dy, gap = -1.0, 0.0, 1.0
    return (bx + dx * keep / gap, by + dy * keep / gap)


@compiled_merged
def _expelled(scene: Scene, x: float, y: float, gap: float) -> Point:
    """Move (x, y) out of the defence area at +x, grown by ``gap``, over its nearest edge."""
    front = scene.half_length - scene.area_depth - gap
    side = scene.area_width / 2 + gap
    if x <= front or abs(y) >= side:
        return (x, y)
    if x - front <= side - abs(y):
        return (front, y)
    return (x, side if y >= 0.0 else -side)


@compiled_merged
def is_open(trip: Trip, scene: Scene, x: float, y: float, their_gap: float) -> bool:
    """Return whether the robot may pass (x, y), with ``their_gap`` to the opponents' defence area [m]."""
    half_length, depth, width = scene.half_length, scene.area_depth, scene.area_width
    most_x = half_length + (scene.behind - ROBOT_RADIUS)
    most_y = scene.half_width + (scene.margin - ROBOT_RADIUS)
    if abs(x) > most_x or abs(y) > most_y:
        return False
    if trip.placing > 0.0:
        return True
    if in_area(x, y, half_length, depth, width, their_gap - ROBOT_AREA_GAP):
        return False
    return trip.goalkeeper > 0.0 or not in_area(-x, y, half_length, depth, width, ROBOT_RADIUS)


@compiled_merged
def from_ball(trip: Trip, scene: Scene) -> float:
    """Return the least distance of its centre from the ball's [m], 0 if the ball is no obstacle."""
    if scene.keeps_off > 0.0:
        return ROBOT_RADIUS + BALL_RADIUS + STOP_DISTANCE
    return ROBOT_RADIUS + BALL_RADIUS + trip.ball_gap if trip.ball_gap >= 0.0 else 0.0
