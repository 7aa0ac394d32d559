"""Positions of defenders: the wall in front of the own area, and markers."""

from __future__ import annotations

from collections.abc import Collection
from math import hypot

from robobt.skills.defence.wall import wall_place
from robobt.skills.tactics_settings import TacticsSettings
from robobt.world.geometry import Point
from robobt.world.rules import owner
from robobt.world.state import Frame, RobotId, RobotState


def wall_places(frame: Frame, size: int, tactics: TacticsSettings) -> list[Point]:
    """Return the positions of a wall of ``size`` robots, from left to right facing out."""
    if size <= 0:
        return []
    ball, lead = frame.ball, tactics.wall_lead
    x, y = ball.x + lead * ball.vx, ball.y + lead * ball.vy
    return [wall_place(frame.field, x, y, place, size) for place in range(size)]


def threats(frame: Frame, tactics: TacticsSettings, marked: Collection[int] = ()) -> list[RobotState]:
    """Return the opponents without the ball that could score soon, the most dangerous first.

    Opponents in ``marked`` stay ahead of others that are hardly nearer to the goal.
    """
    goal_x, goal_y = frame.field.our_goal
    holder = owner(frame)
    others = [
        robot
        for robot in frame.opponents
        if robot.x < tactics.mark_from
        and (holder is None or holder != RobotId(frame.team.other, robot.id))
        and hypot(robot.x - frame.ball.x, robot.y - frame.ball.y) > tactics.mark_off_ball
    ]
    return sorted(
        others,
        key=lambda robot: (
            hypot(robot.x - goal_x, robot.y - goal_y) - tactics.mark_stays * (robot.id in marked)
        ),
    )


def mark_places(
    frame: Frame, opponents: list[RobotState], tactics: TacticsSettings
) -> list[tuple[int, Point]]:
    """Return each opponent's number and the place to mark it, on the side of the ball and the own goal."""
    ball, (goal_x, goal_y) = frame.ball, frame.field.our_goal
    goalward, gap, places = tactics.mark_goalward, tactics.mark_gap, []
    for robot in opponents:
        bx, by = ball.x - robot.x, ball.y - robot.y
        gx, gy = goal_x - robot.x, goal_y - robot.y
        to_ball, to_goal = max(hypot(bx, by), 1e-6), max(hypot(gx, gy), 1e-6)
        ux, uy = bx / to_ball + goalward * gx / to_goal, by / to_ball + goalward * gy / to_goal
        size = max(hypot(ux, uy), 1e-6)
        places.append((robot.id, (robot.x + gap * ux / size, robot.y + gap * uy / size)))
    return places
