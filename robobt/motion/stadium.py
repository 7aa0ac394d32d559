"""The stadium around the path of a ball that the opponents place, which other robots must leave.

Source: RoboCup SSL rules, chapter "Ball Placement": 0.5 m from the segment between ball and spot.
"""

from __future__ import annotations

from robobt.world.game import BALL_PLACEMENT
from robobt.world.geometry import (
    Point,
    closest_point_on_segment,
    distance,
    segment_distance,
    segments_distance,
)
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

_STADIUM_MARGIN = 0.06
"""Margin outside it, because a robot does not stop at once [m]."""

_ESCAPE_DISTANCE = 0.1
"""Distance beyond the margin of a leaving robot's target, so that it does not creep [m]."""


def outside_stadium(frame: Frame, me: RobotState, goal: Point) -> Point:
    """Return ``goal``, or where to go first while the opponents place the ball between.

    A robot inside goes straight out of the stadium unless ``goal`` is outside; any other robot waits until
    the ball has passed instead of driving round.
    """
    game = frame.game
    spot = game.placement
    if game.restart is not BALL_PLACEMENT or game.restart_team is frame.team or spot is None:
        return goal
    ball = frame.ball.position
    keep = STOP_DISTANCE + ROBOT_RADIUS + _STADIUM_MARGIN
    if _are_apart(me.position, goal, ball, spot, keep + 1e-6):
        return goal
    here = closest_point_on_segment(me.position, ball, spot)
    gap = distance(here, me.position)
    if gap < keep and segment_distance(goal, ball, spot) >= keep:
        return goal
    if 0.0 < gap < keep:
        share = (keep + _ESCAPE_DISTANCE) / gap
        return (here[0] + share * (me.x - here[0]), here[1] + share * (me.y - here[1]))
    if segments_distance(me.position, goal, ball, spot) < keep:
        return me.position
    return goal


def _are_apart(start: Point, end: Point, other_start: Point, other_end: Point, gap: float) -> bool:
    """Return whether two segments are certainly farther apart than ``gap`` [m]: in x alone, or in y."""
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = start, end, other_start, other_end
    return (
        min(ax, bx) - max(cx, dx) > gap
        or min(cx, dx) - max(ax, bx) > gap
        or min(ay, by) - max(cy, dy) > gap
        or min(cy, dy) - max(ay, by) > gap
    )
