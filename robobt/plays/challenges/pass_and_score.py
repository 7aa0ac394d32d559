"""A play for the cooperation challenge: robot 0 passes, robot 1 shoots the goal."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.intercept import Intercept
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.challenges.has_passed import HasPassed
from robobt.skills.challenges.is_number import IsNumber
from robobt.skills.challenges.mate_has_kicked import MateHasKicked
from robobt.skills.conditions.ball_is_moving import BallIsMoving
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.stop import Stop
from robobt.tree import Behaviour, Inverter
from robobt.world.geometry import Point


@PLAYS.register("pass_and_score")
def pass_and_score(
    *, pass_to: Point = (0.9, -0.8), pass_speed: float = 3.0, shot_speed: float = 3.2
) -> Behaviour:
    """Robot 0 passes to a point in the attacked half, robot 1 meets the ball there and shoots at the goal.

    Robot 1 stays still until robot 0 has kicked. Source of the order and of the speed limits: the cooperation
    challenge of 2026.

    Args:
        pass_to: where the pass goes [m].
        pass_speed: speed of the pass [m/s].
        shot_speed: speed of the shot [m/s].
    """
    shoot = when("shoot", HasBall(), KickToTarget(target=(4.5, 0.0), kick_speed=shot_speed, take=True))
    return first_of(
        "together",
        when(
            "major",
            IsNumber(number=0),
            first_of(
                "pass",
                when("passed", HasPassed(), Stop()),
                KickToTarget(target=pass_to, kick_speed=pass_speed),
            ),
        ),
        when("wait", Inverter("not yet", MateHasKicked()), Stop()),
        shoot,
        when("meet", BallIsMoving(), Intercept()),
        when("get the ball", GoToBall(), PickUpBall()),
    )
