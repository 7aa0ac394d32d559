"""The ways of all robots of a team to their places in its plan, found together once a frame."""

from __future__ import annotations

from robobt.motion.scene import BALL_GAP
from robobt.motion.together import travel_together
from robobt.skills.base import KICKER_GAP, heading_thereabouts
from robobt.skills.plan import TeamPlan
from robobt.skills.store import TeamStore
from robobt.world.command import RobotCommand
from robobt.world.state import Frame


def way_to_place(frame: Frame, team: TeamStore, number: int) -> RobotCommand | None:
    """Return a robot's command on the way to its place in the plan, where it faces the ball roughly.

    None for the attacker, and for a robot that has been given its command in this frame before.

    Args:
        frame: the frame for which the team has agreed.
        team: the team.
        number: the robot's number.
    """
    plan = team.plan
    if plan.ways is None:
        plan.ways = _ways(frame, team, plan)
    return plan.ways.pop(number, None)


def _ways(frame: Frame, team: TeamStore, plan: TeamPlan) -> dict[int, RobotCommand]:
    ball, slack, places = frame.ball.position, plan.tactics.facing, plan.places
    robots = [me for me in frame.own if me.id in plan.players and me.id in places and me.id != team.attacker]
    ways = [
        (
            me,
            places[me.id],
            heading_thereabouts(me, ball, slack),
            KICKER_GAP if me.id == team.kicker else BALL_GAP,
        )
        for me in robots
    ]
    commands = travel_together(frame, ways, spare_mates=True) if ways else []
    return {me.id: command for me, command in zip(robots, commands, strict=True)}
