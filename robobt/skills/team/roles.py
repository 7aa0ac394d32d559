"""What each role costs a robot, and who plays which: agreed once a frame by the first robot that asks.

Robots enter themselves in the team's store when they first ask, so a team may have any size.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot, inf
from typing import TypeAlias

from robobt.skills.store import TeamStore
from robobt.skills.team.teamwork import attacker
from robobt.tree import Registry
from robobt.tree.nodes import assign_roles
from robobt.world.geometry import Point
from robobt.world.rules import has_ball
from robobt.world.state import Frame, RobotState

RoleCost: TypeAlias = Callable[[Frame, TeamStore, RobotState], float]
"""What a role costs a robot, as a distance [m]; infinite where it may not play it."""

ROLES: Registry[RoleCost] = Registry("role")
"""The cost of every role by its name."""

_LEAD = 0.25
"""The ball is looked for where it will be after this time [s]."""

_HELD = 1.0
"""How much nearer to the ball a robot counts that has it [m]."""


@ROLES.register("attacker")
def attacker_cost(frame: Frame, team: TeamStore, robot: RobotState) -> float:
    """The way to the ball; a kicker that may not touch it again yet cannot attack."""
    if robot.id == team.kicker:
        return inf
    ball = frame.ball
    way = _way(robot, (ball.x + _LEAD * ball.vx, ball.y + _LEAD * ball.vy))
    return way - _HELD if has_ball(robot, ball) else way


@ROLES.register("supporter")
def supporter_cost(frame: Frame, _team: TeamStore, robot: RobotState) -> float:
    """The way to the middle of the wider side of the field, level with the ball."""
    ball = frame.ball
    side = -frame.field.half_width / 2 if ball.y > 0.0 else frame.field.half_width / 2
    return _way(robot, (ball.x, side))


@ROLES.register("defender")
def defender_cost(frame: Frame, _team: TeamStore, robot: RobotState) -> float:
    """The way to the middle between the ball and the own goal."""
    goal_x, goal_y = frame.field.our_goal
    return _way(robot, ((frame.ball.x + goal_x) / 2, (frame.ball.y + goal_y) / 2))


def agree_roles(frame: Frame, team: TeamStore, roles: Sequence[str], margin: float) -> dict[int, str]:
    """Who plays which role on this frame, by number.

    Args:
        roles: names in :data:`ROLES`, in order of importance: the last ones stay
            open when there are fewer robots.
        margin: how much shorter all ways together have to be for a change [m].
    """
    if team.roles_agreed_on is not frame:
        team.roles_agreed_on = frame
        # It also follows who may not touch the ball after a restart.
        attacker(frame, team)
        players = [robot for robot in frame.own if robot.id in team.role_players]
        costs = {
            robot.id: {role: ROLES[role](frame, team, robot) for role in roles[: len(players)]}
            for robot in players
        }
        team.roles = assign_roles(costs, team.roles, margin)
    return team.roles


def _way(robot: RobotState, point: Point) -> float:
    return hypot(robot.x - point[0], robot.y - point[1])
