"""The simplest ball placement: the nearest robot pushes the ball to its spot."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.challenges.aim_at_spot import AimAtSpot
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.conditions.is_closest_to_ball import IsClosestToBall
from robobt.skills.stop import Stop
from robobt.tree import Behaviour


@PLAYS.register("carry_to_spot")
def carry_to_spot() -> Behaviour:
    """Let the robot nearest to the ball take it and push it to the referee's spot; all others stand."""
    return first_of(
        "place the ball",
        when("carry", IsClosestToBall(), AimAtSpot(), HasBall(), DribbleTo(tolerance=0.05)),
        when("get the ball", IsClosestToBall(), AimAtSpot(), GoToBall(), PickUpBall()),
        Stop(),
    )
