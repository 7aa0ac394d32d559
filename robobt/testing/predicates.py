"""What can hold at a frame of a trial, ready for ``eventually``, ``always`` and ``never``.

Functions that return a predicate make one for one run: what it has seen before belongs to that run.
"""

from __future__ import annotations

from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.match.referee.touches import Touches
from robobt.testing.statements import Predicate
from robobt.world import ROBOT_RADIUS, BallState, Frame, RobotId, RobotState, Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import ball_out, in_defense_area, scorer, touches


def goal_for(team: Team) -> Predicate:
    """Return whether ``team`` scores between the frame before and this one."""
    before: BallState | None = None

    def scores(frame: Frame) -> bool:
        nonlocal before
        last, before = before or frame.ball, frame.ball
        return scorer(frame.field, last, frame.ball) is team

    return scores


@dataclass(frozen=True)
class HasStatus:
    """Whether a node of a tree that is played has a status; asked only once the tree has been ticked.

    Attributes:
        node: the node.
        status: the status.
    """

    node: Behaviour
    status: Status

    def __call__(self, _frame: Frame) -> bool:
        """Return whether the node has the status, whatever the frame."""
        return self.node.status is self.status


def succeeds(node: Behaviour) -> Predicate:
    """Return whether a ``node`` of a tree that is played has the status SUCCESS."""
    return HasStatus(node, Status.SUCCESS)


def fails(node: Behaviour) -> Predicate:
    """Return whether a ``node`` of a tree that is played has the status FAILURE."""
    return HasStatus(node, Status.FAILURE)


def has_ball(robot: RobotId) -> Predicate:
    """Return whether the ball touches the kicker of ``robot``."""
    return lambda frame: _robot(frame, robot).ball_contact


def ball_near(place: Point, within: float) -> Predicate:
    """Return whether the ball's centre is ``within`` [m] of a ``place`` [m]."""
    return lambda frame: distance(frame.ball.position, place) <= within


def ball_leaves_the_field(frame: Frame) -> bool:
    """Return whether the ball is out of the field, in a goal too, in this ``frame``."""
    return ball_out(frame.field, frame.ball.position)


def inside_the_field(frame: Frame) -> bool:
    """Return whether every robot of a ``frame`` is inside the walls, the margin around the lines included."""
    return all(
        frame.field.contains(robot.x, robot.y, frame.field.margin - ROBOT_RADIUS)
        for robot in (*frame.own, *frame.opponents)
    )


def leaves_the_field(robot: RobotId) -> Predicate:
    """Return whether ``robot`` is wholly outside the lines of the field."""

    def leaves(frame: Frame) -> bool:
        there = _robot(frame, robot)
        return not frame.field.contains(there.x, there.y, ROBOT_RADIUS)

    return leaves


def touches_a_robot(robot: RobotId) -> Predicate:
    """Return whether the hull of ``robot`` touches that of any other robot."""

    def does(frame: Frame) -> bool:
        here = _robot(frame, robot).position
        others = [other.position for one, other in frame.robots().items() if one != robot]
        return any(distance(here, other) < 2.0 * ROBOT_RADIUS for other in others)

    return does


def dribbles_too_far(robot: RobotId, most: float = 1.0) -> Predicate:
    """Return whether ``robot`` has carried the ball farther than the rules allow, as the referee counts it.

    Args:
        robot: that may not.
        most: the farthest from where it got the ball, in a straight line [m].
    """
    seen = Touches()

    def does(frame: Frame) -> bool:
        seen.watch(frame)
        return seen.carrier == robot and seen.carried > most

    return does


def touches_the_ball(robot: RobotId) -> Predicate:
    """Return whether the ball touches ``robot``, its kicker or its hull."""
    return lambda frame: touches(_robot(frame, robot), frame.ball)


def touches_inside_area(robot: RobotId, defender: Team) -> Predicate:
    """Return whether ``robot`` touches the ball while a part of it is inside a defence area.

    Args:
        robot: that may not.
        defender: the team whose defence area it is.
    """

    def does(frame: Frame) -> bool:
        there = _robot(frame, robot)
        return touches(there, frame.ball) and in_defense_area(
            frame.field, defender, there.x, there.y, ROBOT_RADIUS
        )

    return does


def _robot(frame: Frame, robot: RobotId) -> RobotState:
    found = frame.robots().get(robot)
    if found is None:
        raise ValueError(f"{robot} is not on the field")
    return found
