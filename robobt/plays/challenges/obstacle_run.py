"""Plays for the obstacle challenge: ways to the target, and the robots in the way."""

from __future__ import annotations

from robobt.plays.base import PLAYS
from robobt.plays.baselines.go_round import GoRound
from robobt.skills.challenges.drive_straight import DriveStraight
from robobt.skills.challenges.to_and_fro import ToAndFro
from robobt.skills.go_to_pose import GoToPose
from robobt.skills.keep_clear import KeepClear
from robobt.tree import Behaviour
from robobt.world.geometry import Point

OBSTACLE_TARGET = (4.35, 1.35)
"""Target of the challenge as blue sees it [m]; the rules play it at the other end: (-4350, -1350) mm."""

VIRTUAL_LINE = (2, 3)
"""Numbers of the two obstacle robots between which there is a line. Source: the challenge's rules of 2025."""


@PLAYS.register("obstacle_run")
def obstacle_run(*, target: Point = OBSTACLE_TARGET, margin: float = 0.05) -> Behaviour:
    """Drive to the target of the obstacle challenge and keep clear of everything.

    Args:
        target: where to [m].
        margin: distance to keep from everything beyond what the rules ask [m].
    """
    return KeepClear(target=target, margin=margin, line=VIRTUAL_LINE)


@PLAYS.register("obstacle_run_planner")
def obstacle_run_planner(*, target: Point = OBSTACLE_TARGET) -> Behaviour:
    """Drive to the target of the obstacle challenge with the planner of the team's other skills.

    Args:
        target: where to [m].
    """
    return GoToPose(target=target)


@PLAYS.register("obstacle_run_2026_11")
def obstacle_run_2026_11(*, target: Point = OBSTACLE_TARGET) -> Behaviour:
    """Drive to the target of the obstacle challenge with the planner of November 2026.

    Args:
        target: where to [m].
    """
    return GoRound("as in 2026-11", GoToPose(target=target))


@PLAYS.register("obstacle_run_straight")
def obstacle_run_straight(*, target: Point = OBSTACLE_TARGET) -> Behaviour:
    """Drive straight to the target of the obstacle challenge, whatever is in the way.

    Args:
        target: where to [m].
    """
    return DriveStraight(target=target)


@PLAYS.register("patrol")
def patrol(*, to: Point | None = None, speed: float = 1.0, dribbler: bool = False) -> Behaviour:
    """Drive to and fro between where the robot started and another point, as obstacles of a challenge do.

    Args:
        to: the other point [m]; None stands still.
        speed: top speed [m/s].
        dribbler: whether the dribbler turns, to carry a ball along.
    """
    return ToAndFro(to=to, speed=speed, dribbler=dribbler)
