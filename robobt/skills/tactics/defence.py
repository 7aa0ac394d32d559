"""Where defenders stand: the wall before the own area, and markers."""

from __future__ import annotations

from collections.abc import Collection
from math import hypot

from robobt.skills.defence.wall import GAP, DefenseEdge
from robobt.world.geometry import Point
from robobt.world.rules import owner
from robobt.world.state import Frame, RobotId, RobotState

MARK_GAP = 0.3
"""From the marked opponent's centre to the marker's [m]."""

MARK_FROM = 0.8
"""Opponents are marked up to this x [m]."""

MARK_STAYS = 0.5
"""An opponent that is marked counts so much nearer to the goal [m]."""

_LEAD = 0.15
"""The wall looks so far ahead of a rolling ball [s]."""


def wall_places(frame: Frame, size: int) -> list[Point]:
    """Return where a wall of ``size`` robots stands, from left to right as they look out."""
    if size <= 0:
        return []
    ball = frame.ball
    edge, ahead = DefenseEdge(frame.field, GAP), (ball.x + _LEAD * ball.vx, ball.y + _LEAD * ball.vy)
    return [edge.wall_place(ahead, place, size) for place in range(size)]


def threats(frame: Frame, marked: Collection[int] = ()) -> list[RobotState]:
    """Return the opponents without the ball that could score soon, the most dangerous first.

    Those in ``marked`` stay before others that are hardly nearer to the goal.
    """
    goal_x, goal_y = frame.field.our_goal
    holder = owner(frame)
    others = [
        robot
        for robot in frame.opponents
        if robot.x < MARK_FROM
        and (holder is None or holder != RobotId(frame.team.other, robot.id))
        and hypot(robot.x - frame.ball.x, robot.y - frame.ball.y) > 0.5
    ]
    return sorted(
        others,
        key=lambda robot: hypot(robot.x - goal_x, robot.y - goal_y) - MARK_STAYS * (robot.id in marked),
    )


def mark_places(frame: Frame, opponents: list[RobotState]) -> list[tuple[int, Point]]:
    """Return of each of these opponents its number and where to mark it from: towards ball and own goal."""
    ball, (goal_x, goal_y) = frame.ball, frame.field.our_goal
    places = []
    for robot in opponents:
        bx, by = ball.x - robot.x, ball.y - robot.y
        gx, gy = goal_x - robot.x, goal_y - robot.y
        to_ball, to_goal = max(hypot(bx, by), 1e-6), max(hypot(gx, gy), 1e-6)
        ux, uy = bx / to_ball + 0.7 * gx / to_goal, by / to_ball + 0.7 * gy / to_goal
        size = max(hypot(ux, uy), 1e-6)
        places.append((robot.id, (robot.x + MARK_GAP * ux / size, robot.y + MARK_GAP * uy / size)))
    return places
