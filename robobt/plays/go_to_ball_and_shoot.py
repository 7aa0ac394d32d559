"""The paper's benchmark: get the ball and shoot at the goal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, TypeAlias

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.aim.raters import Rater
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.ball.go_to_ball import GoToBall, GoToBallPolicy
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.learned_control import policies_by_name
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.ball.shoot import SHOOT_POLICIES, Policy, Shoot
from robobt.skills.conditions.has_ball import HasBall
from robobt.tree import Behaviour

_Shot: TypeAlias = Annotated[
    str | Mapping[str, object] | Policy, policies_by_name(SHOOT_POLICIES, "kick_to_target")
]


@PLAYS.register("go_to_ball_and_shoot")
def go_to_ball_and_shoot(
    *,
    policy: GoToBallPolicy = "geometric",
    shoot: _Shot = "kick_to_target",
    pickup_speed: float | None = 0.5,
    rater: Rater = "segment_clearance",
) -> Behaviour:
    """Go to the ball, pick it up, shoot at the opponent's goal: Table 4 of the paper.

    Approach and shot are hand-written or learned, in any combination. The
    pick-up between them is hand-written, as in the paper; approach and pick-up
    both keep their state up to 0.3 m from the ball, so that they do not alternate at 0.2 m.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    Go-To-Ball-And-Shoot.

    Args:
        policy: policy of the approach: "geometric", "ddpg", or the name or file of a
            model for GoToBall; ``{name: NAME, SETTING: VALUE}`` with settings.
        shoot: how to shoot: "kick_to_target" uses KickToTarget at the rater's choice;
            otherwise a policy for Shoot: "geometric", which also takes the rater's choice, "ddpg", or the
            name or file of a model.
        pickup_speed: how fast the pick-up closes in on the ball [m/s]; None for the
            highest speed that the robot's dribbler takes, for approaches that arrive at speed.
        rater: the shot rater that chooses the point to shoot at, by name or with settings.
    """
    kick = KickToTarget() if shoot == "kick_to_target" else Shoot(policy=shoot)
    aim = () if isinstance(kick, Shoot) and kick.learned else (SelectShot(rater=rater),)
    return first_of(
        "go to ball and shoot",
        when("shoot", HasBall(), *aim, kick),
        when(
            "get the ball", GoToBall(policy=policy, approach="behind_target"), PickUpBall(speed=pickup_speed)
        ),
    )
