"""What a branch is worth: expected goals from its shots, and from how it stands at its end."""

from __future__ import annotations

from math import atan2, hypot

import numpy as np

from robobt.motion.arrival import meetings
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.aim.raters.goal_line import goal_candidates
from robobt.world.game import Team
from robobt.world.records import ball_of, movers_of
from robobt.world.rules import owner
from robobt.world.state import BALL_RADIUS, Frame, RobotId, RobotState

_SPACING = 0.05
"""Distance between the points of the goal line that are rated [m]."""

_BEHIND = 0.075 + BALL_RADIUS
"""Distance from the ball of the centre of a robot that shoots: its front and the ball touch [m]."""

_SOON = 1.0
"""A loose ball that nobody can have within this time is nobody's [s]."""


def standing(frame: Frame, rater: ExpectedGoal, team: Team) -> float:
    """Return the chance of the best shot from here; it is negative where the opponents have the ball.

    The ball counts as that robot's which has it or, if it is loose, as that robot's which can have it first,
    there where it meets it. The robot counts as ready to shoot, with its front at the ball.

    Args:
        frame: the present frame, from any side.
        rater: rates the shot.
        team: the team that it is counted for.

    Returns:
        The chance of a goal, -1 to 1.
    """
    found = _next_owner(frame)
    if found is None:
        return 0.0
    robot, (x, y) = found
    view = frame.seen_by(robot.team)
    if frame.team is not robot.team:
        x, y = -x, -y
    way = hypot(view.field.half_length - x, y)
    me = view.robot(robot.number)
    if me is None or abs(x) >= view.field.half_length:
        return 0.0
    # It stands behind the ball, as it will when it shoots.
    ux, uy = (view.field.half_length - x) / way, -y / way
    shooter = RobotState(me.id, x - _BEHIND * ux, y - _BEHIND * uy, atan2(uy, ux), limits=me.limits)
    chances = rater.chances(view, (x, y), shooter, goal_candidates(view.field, _SPACING))
    chance = 0.0 if chances is None else float(np.max(chances, initial=0.0))
    return chance if robot.team is team else -chance


def _next_owner(frame: Frame) -> tuple[RobotId, tuple[float, float]] | None:
    """Return the robot that has the ball or can have it first, and where; None if that takes too long."""
    holder = owner(frame)
    if holder is not None:
        return holder, frame.ball.position
    model, field = frame.ball_model, frame.field
    movers = movers_of(frame)
    if not len(movers):
        return None
    rows = meetings(
        movers,
        ball_of(frame.ball),
        0.0,
        model.slide_deceleration,
        model.roll_deceleration,
        field.half_length,
        field.half_width,
    )
    first = int(np.argmin(rows[:, 0]))
    time, x, y = rows[first].tolist()
    if time > _SOON:
        return None
    if first < len(frame.own):
        return RobotId(frame.team, frame.own[first].id), (x, y)
    return RobotId(frame.team.other, frame.opponents[first - len(frame.own)].id), (x, y)
