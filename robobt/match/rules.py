"""The rules as plane geometry: lines, goals, restart spots, contact. World coordinates, metres.

Source: RoboCup SSL rules, chapters "Scoring Goals", "Ball Leaves The Field" and
"Offenses"; distances that involve a robot count from its hull.
"""

from __future__ import annotations

from math import copysign, cos, sin

from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, RobotState

LINE_GAP = 0.2
"""Least distance of a restart from the lines [m]."""

AREA_GAP = 1.0
"""Least distance of a restart from a defence area [m]."""

GOAL_KICK_DISTANCE = 1.0
"""Distance of a goal kick from the goal line [m]."""

_PENALTY_SHARE = 2.0 / 3.0
"""Penalty mark to attacked goal as a share of the field's length: 6 of 9 m, 8 of 12 m."""

_MOUTH_FACE = 0.075
"""Distance of the flat front from the robot's centre [m]."""

_TOUCH_GAP = 0.005
"""A ball this close to the hull touches it [m]."""


def own_side(team: Team) -> float:
    """Sign of x at the goal that ``team`` defends."""
    return -1.0 if team is Team.BLUE else 1.0


def left_over_goal_line(field: FieldGeometry, x: float) -> bool:
    """Whether a ball at ``x`` is fully behind a goal line."""
    return abs(x) > field.half_length + BALL_RADIUS


def left_over_touch_line(field: FieldGeometry, y: float) -> bool:
    """Whether a ball at ``y`` is fully behind a touch line."""
    return abs(y) > field.half_width + BALL_RADIUS


def exit_point(field: FieldGeometry, before: Point, after: Point) -> Point:
    """Where the ball's way from ``before`` (in the field) to ``after`` (out of it) passed the line.

    The ball counts as out once it has crossed in full, so the lines are taken
    one ball radius further out. ``after`` itself when ``before`` was out too.
    """
    edge_x, edge_y = field.half_length + BALL_RADIUS, field.half_width + BALL_RADIUS
    share = 1.0
    for start, end, edge in ((before[0], after[0], edge_x), (before[1], after[1], edge_y)):
        if abs(end) > edge >= abs(start):
            share = min(share, (copysign(edge, end) - start) / (end - start))
    return (before[0] + share * (after[0] - before[0]), before[1] + share * (after[1] - before[1]))


def between_posts(field: FieldGeometry, y: float) -> bool:
    """Whether a ball that crosses a goal line at ``y`` goes into the goal.

    The posts' inner sides stand at half the goal's width. A ball is either
    inside them by its radius or outside them by its radius and more, so its
    centre decides.
    """
    return abs(y) <= field.goal_width / 2


def free_kick_spot(field: FieldGeometry, x: float, y: float) -> Point:
    """The nearest legal place for a free kick: off the lines and off the defence areas."""
    most_x, most_y = field.half_length - LINE_GAP, field.half_width - LINE_GAP
    x = min(most_x, max(-most_x, x))
    y = min(most_y, max(-most_y, y))
    front = field.half_length - field.defense_depth - AREA_GAP
    side = field.defense_width / 2 + AREA_GAP
    into_front, into_side = abs(x) - front, side - abs(y)
    if into_front <= 0.0 or into_side <= 0.0:
        return (x, y)
    if into_side < into_front and side <= most_y:
        return (x, copysign(side, y))
    return (copysign(max(0.0, front), x), y)


def goal_kick_spot(field: FieldGeometry, defender: Team, y: float) -> Point:
    """Where ``defender`` takes a goal kick when the ball has left at ``y``."""
    x = own_side(defender) * (field.half_length - GOAL_KICK_DISTANCE)
    return (x, copysign(field.half_width - LINE_GAP, y))


def corner_spot(field: FieldGeometry, defender: Team, y: float) -> Point:
    """Where the attackers take a corner kick at ``defender``'s goal line when the ball has left at ``y``."""
    x = own_side(defender) * (field.half_length - LINE_GAP)
    return (x, copysign(field.half_width - LINE_GAP, y))


def penalty_mark(field: FieldGeometry, attacker: Team) -> Point:
    """Where ``attacker`` takes a penalty kick."""
    return (-own_side(attacker) * (field.half_length - _PENALTY_SHARE * field.length), 0.0)


def in_defense_area(field: FieldGeometry, defender: Team, x: float, y: float, tolerance: float = 0.0) -> bool:
    """Whether (x, y) lies in ``defender``'s defence area grown by ``tolerance`` [m]."""
    side = -own_side(defender)
    return field.in_our_defense(side * x, side * y, tolerance)


def touches(robot: RobotState, ball: BallState) -> bool:
    """Whether the ball lies in the robot's mouth or against its hull."""
    if robot.ball_contact:
        return True
    dx, dy = ball.x - robot.x, ball.y - robot.y
    reach = ROBOT_RADIUS + BALL_RADIUS + _TOUCH_GAP
    if dx * dx + dy * dy > reach * reach:
        return False
    ahead = cos(robot.heading) * dx + sin(robot.heading) * dy
    return ahead <= _MOUTH_FACE + BALL_RADIUS + _TOUCH_GAP
