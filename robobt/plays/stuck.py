"""Written skills that help out where a policy does not get the ball."""

from __future__ import annotations

from robobt.plays.base import when
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.conditions.is_closest_to_ball import IsClosestToBall
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.skills.conditions.stuck_at_ball import StuckAtBall
from robobt.tree import Behaviour


def get_where_stuck(patience: float = StuckAtBall.patience) -> Behaviour:
    """Get a ball at which a policy stops; ``patience`` is how long it may be there without getting it [s].

    Where robots and ball are others than in training, a policy may come to rest at a ball beside its mouth.
    """
    return when(
        "stuck", StuckAtBall(patience=patience), MayTouchBall(), IsClosestToBall(), GoToBall(), PickUpBall()
    )
