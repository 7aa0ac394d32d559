"""The robots that count as on the field: robots that left a team with too many do not."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from robobt.world.division import A, division_of
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

SUBSTITUTION_REACH = 1.0
"""How far from the half-way line robots may leave and enter over a touch line. Source: SSL rules [m]."""

GOAL_SUBSTITUTION_WIDTH = 0.3
"""Width of the goal substitution areas, along the walls behind the goal lines. Source: SSL rules [m]."""


def in_substitution_area(field: FieldGeometry, robot: RobotState) -> bool:
    """Return whether a robot stands in a substitution area: beside the half-way line, over a touch line."""
    return abs(robot.y) > field.half_width and abs(robot.x) <= SUBSTITUTION_REACH


def taken_off(
    field: FieldGeometry, robots: Sequence[RobotState], most: int | None, side: float = -1.0
) -> frozenset[int]:
    """Return the numbers of a team's robots that count as off the field.

    If a team has more robots than ``most``, for example after a card, the surplus robots count as off while
    they stand in a substitution area: centre outside a touch line and at most 1 m from the half-way line,
    where their handler has taken them, or in division A behind its own goal line. A robot that only fetches
    the ball there still counts. If there are several, those with the highest numbers are off; None allows any
    number.

    Args:
        field: the field.
        robots: all robots of the team.
        most: how many the team may have.
        side: of the team's goal in these coordinates, -1 or 1.
    """
    excess = 0 if most is None else len(robots) - most
    if excess <= 0:
        return frozenset()
    # Wholly in the area, as the league's game controller counts.
    line = field.outer[0] - GOAL_SUBSTITUTION_WIDTH + ROBOT_RADIUS if division_of(field) is A else inf
    outside = [it.id for it in robots if in_substitution_area(field, it) or side * it.x >= line]
    return frozenset(sorted(outside)[-excess:])


def without_absent(frame: Frame, game: GameState) -> Frame:
    """Return the frame without the robots that count as off the field; itself where all play."""
    own, opponents = game.status(frame.team).max_robots, game.status(frame.team.other).max_robots
    if (own is None or len(frame.own) <= own) and (opponents is None or len(frame.opponents) <= opponents):
        return frame
    field = frame.field
    off = taken_off(field, frame.own, own), taken_off(field, frame.opponents, opponents, side=1.0)
    if not off[0] and not off[1]:
        return frame
    return Frame(
        frame.time,
        field,
        frame.ball,
        tuple([robot for robot in frame.own if robot.id not in off[0]]) if off[0] else frame.own,
        tuple([robot for robot in frame.opponents if robot.id not in off[1]]) if off[1] else frame.opponents,
        frame.team,
        frame.period,
        frame.game,
        frame.last_touch,
        frame.ball_model,
    )
