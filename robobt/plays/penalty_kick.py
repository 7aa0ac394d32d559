"""Take a penalty kick: carry the ball on, draw the goalkeeper, shoot."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.aim.raters import Rater
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.conditions.carried_far import CarriedFar
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.stop import Stop
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.tree import Behaviour

_CONFIDENT_EXPECTED_GOAL: Rater = {
    "name": "expected_goal",
    "threshold": 0.85,
}


@PLAYS.register("penalty_kick")
def penalty_kick(
    *,
    rater: Rater = _CONFIDENT_EXPECTED_GOAL,
    min_score: float = 0.85,
    distance: float = 2.8,
    patience: float = 2.5,
    carry: float = 0.8,
    dribble_speed: float = 1.0,
) -> Behaviour:
    """Carry the ball towards the goal, draw the goalkeeper to one side and shoot into the other.

    The kick is over after 10 s. Until it shoots, the robot releases the ball repeatedly, because the rules
    allow carrying it for a metre only; it is slow enough to stop within that distance and draw the goalkeeper
    at rest.

    Args:
        rater: the shot rater, by name or with settings.
        min_score: score of a shot that it takes at once, 0 to 1; with the default rater the probability of a
            goal.
        distance: distance from the goal at which it draws the goalkeeper [m].
        patience: longest time to do that; then it takes the best shot available [s].
        carry: largest distance that it carries the ball without releasing it [m].
        dribble_speed: top speed with the ball [m/s].
    """
    return first_of(
        "penalty kick",
        when("let go", CarriedFar(limit=carry), Stop()),
        when("score", SelectShot(rater=rater, min_score=min_score), KickToTarget()),
        when(
            "draw",
            HasBall(),
            SelectShot(rater=rater, min_score=0.0, max_distance=distance),
            DrawGoalkeeper(patience=patience),
        ),
        when(
            "last resort",
            HasBall(),
            SelectShot(rater=rater, min_score=0.0, max_distance=distance),
            KickToTarget(),
        ),
        when("carry", HasBall(), BestFieldPosition(), DribbleTo(max_speed=dribble_speed)),
        when("get the ball", GoToBall(), PickUpBall()),
    )
