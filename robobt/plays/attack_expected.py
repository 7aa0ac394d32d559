"""An attacker that shoots when a goal is very likely."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.aim.raters import Rater
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.tree import Behaviour


@PLAYS.register("attack_expected")
def attack_expected(
    *,
    rater: Rater = "expected_goal",
    min_score: float = 0.9,
    last_resort: float = 0.3,
    patience: float = 10.0,
    max_distance: float | None = None,
    shot_speed: float | None = None,
    speed_factor: float = 1.0,
    dribble_speed: float = 2.0,
) -> Behaviour:
    """Shoot where the probability of a goal is high enough; else create such an opening.

    The robot kicks in the control period in which it points into an opening whose probability reaches the
    threshold. Until then it carries the ball to the best place and there draws the goalkeeper from one side
    to the other; when ``patience`` has run out it takes the best shot available.

    Args:
        rater: the shot rater, by name or with settings. The default learns from the match how good the
            opponents' goalkeeper is.
        min_score: worst shot taken, 0 to 1; with the default rater the probability of a goal.
        last_resort: worst shot taken once ``patience`` has run out.
        patience: longest time to draw the goalkeeper [s].
        max_distance: no shots from farther than this from the goal [m]; None for no limit.
        shot_speed: kick speed of a shot [m/s]; None for the kick's default.
        speed_factor: factor on the top speed without the ball.
        dribble_speed: top speed with the ball [m/s].
    """
    return first_of(
        "attack expected",
        when(
            "score",
            SelectShot(rater=rater, min_score=min_score, max_distance=max_distance),
            KickToTarget(kick_speed=shot_speed, speed_factor=speed_factor),
        ),
        when(
            "make an opening",
            HasBall(),
            BestFieldPosition(),
            DribbleTo(max_speed=dribble_speed),
            DrawGoalkeeper(patience=patience),
        ),
        when(
            "last resort",
            HasBall(),
            SelectShot(rater=rater, min_score=last_resort, max_distance=max_distance),
            KickToTarget(kick_speed=shot_speed, speed_factor=speed_factor),
        ),
        when("get the ball", GoToBall(speed_factor=speed_factor), PickUpBall()),
    )
