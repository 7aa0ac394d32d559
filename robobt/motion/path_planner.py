"""Find the next waypoint around robots, ball and defence areas, and drive there.

The plan is made anew every tick and only its first leg is driven. Obstacles are
circles; a blocked path leaves along the tangent of the first circle on it, on
the side with the shorter way round. Defence areas are passed by their corners.
Robots that move are no obstacles to the path: the velocity along it is changed
where it would meet one (:mod:`robobt.motion.velocity_obstacles`).

Source of the idea and the clearances: RoboBulls' published code (FPPA planner);
tangents and side choice are robobt's.
"""

from __future__ import annotations

from collections.abc import Iterator

from robobt.motion.arrival import movers_of
from robobt.motion.scene import EVADES, TARGET_X, TARGET_Y, allowed_numbers, scene_of, task_of
from robobt.motion.speeds import numbers
from robobt.motion.stadium import outside_stadium
from robobt.motion.way import travel_numbers, waypoint_numbers
from robobt.world.command import RobotCommand
from robobt.world.geometry import FloatArray, Point
from robobt.world.limits import RobotLimits
from robobt.world.sketch import Sketch
from robobt.world.state import Frame, RobotState

PATHS, TARGETS = "paths", "targets"
"""The layers of planned ways, and of where robots drive and kick to."""

_MOST_LEGS = 6

BALL_GAP = 0.01
"""Gap to an avoided ball below which a way is blocked [m]. Source: RoboBulls' published code."""


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
    spare_mates: bool = False,
    sketch: Sketch | None = None,
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
        spare_mates: whether to give way to everybody, while the ball is in play too.
        sketch: takes the whole way in the layer "paths", where somebody looks at it.
    """
    goal = outside_stadium(frame, me, target)
    task = task_of(
        me,
        goal,
        heading,
        final_speed if goal is target else 0.0,
        avoid_robots=avoid_robots,
        ball_gap=ball_gap if avoid_ball else -1.0,
        goalkeeper=goalkeeper,
        placing=placing,
    )
    if sketch is not None:
        sketch.point(TARGETS, target)
        if sketch.wants(PATHS):
            sketch.path(PATHS, _way(frame, me, task))
    own, other = numbers(me.limits), limits is not me.limits
    return RobotCommand(
        *travel_numbers(task, scene_of(frame), movers_of(frame), own, numbers(limits), other, spare_mates)
    )


def allowed_target(
    frame: Frame, me: RobotState, target: Point, *, goalkeeper: bool = False, placing: bool = False
) -> Point:
    """Return the point nearest to ``target`` where the robot may stand.

    That is inside the walls, outside the opponents' defence area, outside the
    own one unless it is the goalkeeper, and far enough from the ball while the
    referee demands it; a robot that is ``placing`` the ball may stand in both areas.
    """
    return allowed_numbers(task_of(me, target, goalkeeper=goalkeeper, placing=placing), scene_of(frame))


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

    The speed is 0 for ``target`` itself. Robots that move are gone round where they will be. An obstacle that
    the robot already overlaps, or that ``target`` lies in, blocks only ways that lead deeper into it.
    """
    task = task_of(
        me,
        target,
        avoid_robots=avoid_robots,
        ball_gap=ball_gap if avoid_ball else -1.0,
        goalkeeper=goalkeeper,
        placing=placing,
    )
    x, y, speed = waypoint_numbers(task, scene_of(frame), movers_of(frame), numbers(me.limits), True)
    return (x, y), speed


def _way(frame: Frame, me: RobotState, task: FloatArray) -> Iterator[Point]:
    """Give the points of the whole way as it would be driven if all else stood still."""
    task, scene, robots, own = task.copy(), scene_of(frame), movers_of(frame), numbers(me.limits)
    target = task[TARGET_X], task[TARGET_Y] = allowed_numbers(task, scene)
    yield me.position
    for _ in range(_MOST_LEGS):
        x, y, _ = waypoint_numbers(task, scene, robots, own, scene[EVADES] == 0.0)
        yield x, y
        if (x, y) == target:
            break
        task[0], task[1] = x, y
