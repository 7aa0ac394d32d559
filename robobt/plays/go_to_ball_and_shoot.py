"""The paper's benchmark: get the ball and shoot at the goal."""

from __future__ import annotations

from typing import Literal

from robobt.plays.base import PLAYS
from robobt.skills.go_to_ball import GoToBall
from robobt.skills.has_ball import HasBall
from robobt.skills.kick_to_target import KickToTarget
from robobt.skills.pick_up_ball import PickUpBall
from robobt.skills.select_shot import SelectShot
from robobt.tree import Behaviour, Selector, Sequence


@PLAYS.register("go_to_ball_and_shoot")
def go_to_ball_and_shoot(
    *,
    style: Literal["default", "robobulls"] = "default",
    policy: str = "geometric",
    rater: str = "segment_clearance",
) -> Behaviour:
    """Go to the ball, pick it up, shoot at the opponent's goal: Table 4 of the paper.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    Go-To-Ball-And-Shoot.

    Args:
        style: "default" goes through the three skills; "robobulls" is the paper's
            baseline, whose kick includes the way behind the ball.
        policy: what decides the approach in the default style.
        rater: name of the shot rater that chooses the point to shoot at.
    """
    if style == "robobulls":
        return Sequence(
            "go to ball and shoot",
            memory=False,
            children=[SelectShot(rater=rater), KickToTarget(style="robobulls")],
        )
    return Selector(
        "go to ball and shoot",
        memory=False,
        children=[
            Sequence("shoot", memory=False, children=[HasBall(), SelectShot(rater=rater), KickToTarget()]),
            Sequence(
                "get the ball",
                memory=False,
                children=[GoToBall(policy=policy, approach="behind_target"), PickUpBall()],
            ),
        ],
    )
