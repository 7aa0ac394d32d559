"""Take a penalty kick: carry the ball on, draw the goalkeeper, shoot."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
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


@PLAYS.register("penalty_kick")
def penalty_kick(
    *,
    model: str = "shot_expected_strong",
    threshold: float = 0.85,
    distance: float = 2.8,
    patience: float = 2.5,
    carry: float = 0.8,
    dribble_speed: float = 1.0,
) -> Behaviour:
    """Carry the ball towards the goal, there draw the goalkeeper to one side and shoot into the other.

    The kick is over after 10 s. Until it shoots the robot lets the ball go now and
    then, because nobody may carry it farther than a metre; it is slow enough with
    the ball to stand within that way and draw the goalkeeper at rest.

    Args:
        model: predictor of the ``expected_goal`` rater: a shipped model or a file.
        threshold: probability of a goal with which it shoots at once, 0 to 1.
        distance: from the goal at which it draws the goalkeeper [m].
        patience: longest time to do that; then it shoots at what there is [s].
        carry: farthest that it carries the ball at once [m].
        dribble_speed: top speed with the ball [m/s].
    """
    rater = ExpectedGoal(model=model, threshold=threshold)
    return first_of(
        "penalty kick",
        when("let go", CarriedFar(limit=carry), Stop()),
        when("score", SelectShot(rater=rater, min_score=threshold), KickToTarget()),
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
