"""Hand-written skills that take over when a policy does not get the ball."""

from __future__ import annotations

from robobt.plays.base import when
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.conditions.is_closest_to_ball import IsClosestToBall
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.skills.conditions.stuck_at_ball import StuckAtBall
from robobt.tree import Behaviour


def get_where_stuck(patience: float = StuckAtBall.patience) -> Behaviour:
    """Get a ball that a policy fails to get for ``patience`` [s]. Return the tree.

    With robots or a ball that differ from training, a policy may stop at a ball beside its mouth.
    """
    return when(
        "stuck", StuckAtBall(patience=patience), MayTouchBall(), IsClosestToBall(), GoToBall(), PickUpBall()
    )
