"""The rules that decide a match, in one place: lines, goals, defence areas, touches and possession.

Referee, end conditions, training rewards, statistics and tests call the functions
here. Those that take single numbers can be called from compiled code too, as the
kernels of training do. Lengths are metres, coordinates those of the world
(blue defends -x) unless a function says otherwise.

Source: RoboCup SSL rules, chapters "Scoring Goals", "Ball Leaves The Field" and
"Offenses"; distances that involve a robot count from its hull.
"""

from __future__ import annotations

from math import copysign, cos, hypot, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import Ball, Robot
from robobt.world.state import (
    BALL_RADIUS,
    GOAL_HEIGHT,
    RECEIVED_HEIGHT,
    ROBOT_HEIGHT,
    ROBOT_RADIUS,
    BallState,
    Frame,
    RobotId,
    RobotState,
)

IN_PLAY_DISTANCE = 0.05
"""The ball is in play once it has moved this far from a restart's spot. Source: SSL rules [m]."""

STOP_SPEED = 1.5
"""Most a robot may drive while the referee has stopped the game. Source: SSL rules [m/s]."""

STOP_DISTANCE = 0.5
"""Distance to the ball while the game is stopped or the opponents restart it. Source: SSL rules [m]."""

KICKED_SHARE, KICKED_SPEED = 0.25, 1.0
"""A kicked ball leaves its robot with this share of the commanded speed, or this fast [m/s]."""


AREA_DISTANCE = 0.2
"""Distance to the opponents' defence area while the game is stopped or restarts. Source: SSL rules [m]."""

PLACED_DISTANCE = 0.15
"""A ball this near to its spot has been placed. Source: SSL rules [m]."""

CARRY_DISTANCE = 1.0
"""A robot may carry the ball no farther than this, as the crow flies. Source: SSL rules [m]."""

_FRONT_DISTANCE = 0.075
"""Distance of the flat front from the robot's centre [m]."""

_TOUCH_GAP = 0.005
"""A ball this close to the hull touches it: contact is seen once a tick [m]."""

HELD_GAP = 0.02
"""A ball closer to the hull than this is held. Source: RoboBulls' code and Sumatra's referee [m]."""

KEPT_GAP = 0.06
"""A robot that had the ball still has it up to this gap [m]. Source: Sumatra's autoreferee."""

MOUTH_SECTOR = radians(45.0)
"""A robot has a ball that lies within this angle of its heading [rad]."""

ALL_AROUND = pi
"""The sector of a goalkeeper, which holds the ball on any side of its hull [rad]."""

ALONG = 1.0
"""Difference of velocities up to which the ball moves along [m/s]; a turning robot swings it."""


def own_side(team: Team) -> float:
    """Return the sign of x at the goal that ``team`` defends."""
    return -1.0 if team is Team.BLUE else 1.0


# Lines and goals.


@compilable
def is_out(x: float, y: float, half_length: float, half_width: float) -> bool:
    """Return whether a ball at (x, y) is behind a line as a whole."""
    return abs(x) > half_length + BALL_RADIUS or abs(y) > half_width + BALL_RADIUS


@compilable
def leaving(
    x0: float, y0: float, x1: float, y1: float, half_length: float, half_width: float
) -> tuple[float, float, bool]:
    """Find where a ball that went straight from (x0, y0) to (x1, y1) left the field.

    The ball has left once it is over a line as a whole, so the lines are taken one
    ball radius further out. Of two lines crossed in one step the first counts.

    Returns:
        The point, (x1, y1) where the ball was out already, and whether it left over a goal line.
    """
    edge_x, edge_y = half_length + BALL_RADIUS, half_width + BALL_RADIUS
    share, goal_line = 1.0, abs(x1) > edge_x
    if abs(x1) > edge_x >= abs(x0):
        share = (copysign(edge_x, x1) - x0) / (x1 - x0)
    if abs(y1) > edge_y >= abs(y0):
        touch_share = (copysign(edge_y, y1) - y0) / (y1 - y0)
        if not goal_line or touch_share < share:
            share, goal_line = touch_share, False
    return x0 + share * (x1 - x0), y0 + share * (y1 - y0), goal_line


@compilable
def goal_side(
    x0: float, y0: float, x1: float, y1: float, half_length: float, half_width: float, half_goal: float
) -> int:
    """Return the sign of x at the goal that a ball going from (x0, y0) to (x1, y1) enters; 0 for none.

    A goal is scored when the ball leaves the field over a goal line between the posts.
    Their inner sides stand at ``half_goal``; a ball is inside them by its radius or
    outside them by its radius and more, so its centre decides. A ball that was out
    before scores no goal.
    """
    if abs(x1) <= half_length + BALL_RADIUS or is_out(x0, y0, half_length, half_width):
        return 0
    _, y, goal_line = leaving(x0, y0, x1, y1, half_length, half_width)
    if not goal_line or abs(y) > half_goal:
        return 0
    return 1 if x1 > 0.0 else -1


def ball_out(field: FieldGeometry, ball: Point) -> bool:
    """Return whether the ball is behind one of the field's lines as a whole."""
    return is_out(ball[0], ball[1], field.half_length, field.half_width)


def exit_point(field: FieldGeometry, before: Point, after: Point) -> tuple[Point, bool]:
    """Return where the ball left the field, and whether over a goal line; see :func:`leaving`."""
    x, y, goal_line = leaving(*before, *after, field.half_length, field.half_width)
    return (x, y), goal_line


def scorer(field: FieldGeometry, before: BallState, after: BallState) -> Team | None:
    """Return the team that scores as the ball goes by :func:`goal_side`'s rule, as a whole below the bar."""
    side = goal_side(
        *before.position, *after.position, field.half_length, field.half_width, field.goal_width / 2
    )
    if side == 0:
        return None
    share = (field.half_length + BALL_RADIUS - abs(before.x)) / (abs(after.x) - abs(before.x))
    if before.z + share * (after.z - before.z) + 2.0 * BALL_RADIUS > GOAL_HEIGHT:
        return None
    return Team.BLUE if side > 0 else Team.YELLOW


# Defence areas.


@compilable
def in_area(
    x: float, y: float, half_length: float, depth: float, width: float, tolerance: float = 0.0
) -> bool:
    """Return whether (x, y) lies in the defence area at +x, grown by ``tolerance`` on front and sides."""
    return x >= half_length - depth - tolerance and abs(y) <= width / 2 + tolerance


def in_their_defense_area(field: FieldGeometry, x: float, y: float, tolerance: float = 0.0) -> bool:
    """Return whether (x, y), as a team sees it, lies in the opponents' defence area; see :func:`in_area`."""
    return in_area(x, y, field.half_length, field.defense_depth, field.defense_width, tolerance)


def in_own_defense_area(field: FieldGeometry, x: float, y: float, tolerance: float = 0.0) -> bool:
    """Return whether (x, y), as a team sees it, lies in its own defence area; see :func:`in_area`."""
    return in_area(-x, y, field.half_length, field.defense_depth, field.defense_width, tolerance)


def in_defense_area(field: FieldGeometry, defender: Team, x: float, y: float, tolerance: float = 0.0) -> bool:
    """Return whether (x, y) lies in ``defender``'s defence area; see :func:`in_area`."""
    return in_their_defense_area(field, own_side(defender) * x, y, tolerance)


def area_distance(field: FieldGeometry, defender: Team, x: float, y: float) -> float:
    """Return the distance of (x, y) from ``defender``'s defence area, 0 inside it [m]."""
    ahead = field.half_length - field.defense_depth - own_side(defender) * x
    aside = abs(y) - field.defense_width / 2
    return hypot(max(0.0, ahead), max(0.0, aside))


# Touches and possession.


@compilable
def hull_gap(robot: Robot, ball: Ball) -> float:
    """Return the gap between the robot's round hull and the ball [m]; below 0 if it is in the mouth."""
    return hypot(robot.x - ball.x, robot.y - ball.y) - ROBOT_RADIUS - BALL_RADIUS


def touches(robot: RobotState, ball: BallState) -> bool:
    """Return whether the ball is in the robot's mouth or touches its hull."""
    if robot.ball_contact:
        return True
    return ball.z < ROBOT_HEIGHT and against_hull(ball.x - robot.x, ball.y - robot.y, robot.heading)


@compilable
def against_hull(dx: float, dy: float, heading: float) -> bool:
    """Return whether a ball at this distance from a robot's centre [m], and no higher, touches its hull."""
    reach = ROBOT_RADIUS + BALL_RADIUS + _TOUCH_GAP
    if dx * dx + dy * dy > reach * reach:
        return False
    return cos(heading) * dx + sin(heading) * dy <= _FRONT_DISTANCE + BALL_RADIUS + _TOUCH_GAP


def against_hulls(dx: FloatArray, dy: FloatArray, heading: FloatArray) -> NDArray[np.bool_]:
    """Return :func:`against_hull` for arrays of one shape."""
    near = dx * dx + dy * dy <= (ROBOT_RADIUS + BALL_RADIUS + _TOUCH_GAP) ** 2
    before = np.cos(heading) * dx + np.sin(heading) * dy <= _FRONT_DISTANCE + BALL_RADIUS + _TOUCH_GAP
    return np.asarray(near & before)


def has_ball(robot: RobotState, ball: BallState, sector: float = MOUTH_SECTOR) -> bool:
    """Return whether the robot has the ball: its sensor sees it, or it lies before the mouth.

    The sensor may be silent for a tick while the ball bounces on the dribbler, so a
    ball within ``sector`` of the heading and within :data:`HELD_GAP` of the hull counts too.
    One that is too high to be received does not.

    ``sector`` is on which side of the robot that may be, :data:`MOUTH_SECTOR` or :data:`ALL_AROUND` [rad].
    """
    if robot.ball_contact:
        return True
    dx = ball.x - robot.x
    if dx > _HOLDING_REACH or dx < -_HOLDING_REACH:
        return False
    dy = ball.y - robot.y
    if dy > _HOLDING_REACH or dy < -_HOLDING_REACH or ball.z > RECEIVED_HEIGHT:
        return False
    return before_mouth(dx, dy, robot.heading, sector)


@compilable
def before_mouth(dx: float, dy: float, heading: float, sector: float = MOUTH_SECTOR) -> bool:
    """Return whether a ball at this distance from a robot's centre [m] is held, regardless of the sensor.

    ``sector`` is on which side of the ``heading`` that may be [rad].
    """
    gap = hypot(dx, dy)
    if gap >= _HOLDING_REACH:
        return False
    return sector >= pi or cos(heading) * dx + sin(heading) * dy > cos(sector) * gap


def carries(robot: RobotState, ball: BallState) -> bool:
    """Return whether the robot has the ball and it moves along: neither kicked nor bouncing off."""
    return has_ball(robot, ball) and hypot(ball.vx - robot.vx, ball.vy - robot.vy) < ALONG


@compilable
def keeps_ball(robot: Robot, ball: Ball) -> bool:
    """Return whether a robot that had the ball has not lost it yet: it is within :data:`KEPT_GAP`."""
    return hull_gap(robot, ball) <= KEPT_GAP


def owner(frame: Frame) -> RobotId | None:
    """Return the robot that has the ball; the nearest of several, or None. Looked for once a frame."""
    made = frame.made
    if "owner" not in made:
        made["owner"] = _owner(frame)
    found: RobotId | None = made["owner"]
    return found


def _owner(frame: Frame) -> RobotId | None:
    best: RobotId | None = None
    nearest = 2.0 * _HOLDING_REACH
    ball = frame.ball
    x, y = ball.x, ball.y
    for team, robots in ((frame.team, frame.own), (frame.team.other, frame.opponents)):
        for robot in robots:
            # Most robots are far from it, as the first number says.
            close = -_HOLDING_REACH <= x - robot.x <= _HOLDING_REACH
            if (close or robot.ball_contact) and has_ball(robot, ball):
                gap = hypot(x - robot.x, y - robot.y)
                if gap < nearest:
                    best, nearest = RobotId(team, robot.id), gap
    return best


_HOLDING_REACH = ROBOT_RADIUS + BALL_RADIUS + HELD_GAP
