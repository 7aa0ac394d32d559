"""An attacker whose shots a network can veto."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.skills.aim.raters import Rater
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.aim.shot_is_steady import ShotIsSteady
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.tree import Behaviour, FailureIsSuccess

_STRONG_NETWORK_FILTER: Rater = {"name": "nn_filtered", "model": "shot_nn_strong"}


@PLAYS.register("attack_nn")
def attack_nn(
    *,
    rater: Rater = _STRONG_NETWORK_FILTER,
    max_distance: float | None = None,
    shot_speed: float | None = None,
    speed_factor: float = 1.0,
    dribble_speed: float = 2.0,
    steady: float = 0.1,
    feint: bool = True,
) -> Behaviour:
    """Play Attack Main without passes, with shots filtered by a network; without a shot keep dribbling.

    At the best place the robot draws the goalkeeper from one side to the other until the network accepts a
    shot.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    AttackNN.

    Args:
        rater: the shot rater, by name or with settings. The default's model knows our own goalkeeper;
            ``shot_nn`` knows the weaker one of the paper's real shots.
        max_distance: no shots from farther than this from the goal [m]; None for no limit.
        shot_speed: kick speed of a shot [m/s]; None for the kick's default.
        speed_factor: factor on the top speed without the ball.
        dribble_speed: top speed with the ball [m/s].
        steady: how long a shot must have been open before it starts [s].
        feint: draw the goalkeeper; the paper's play does not, and waits at the best place instead.
    """
    draw = (DrawGoalkeeper(),) if feint else ()
    return first_of(
        "attack nn",
        when(
            "score",
            FailureIsSuccess("look for a shot", SelectShot(rater=rater, max_distance=max_distance)),
            ShotIsSteady(rise=steady, fall=steady),
            KickToTarget(kick_speed=shot_speed, speed_factor=speed_factor),
        ),
        when("dribble", HasBall(), BestFieldPosition(), DribbleTo(max_speed=dribble_speed), *draw),
        when("get the ball", GoToBall(speed_factor=speed_factor), PickUpBall()),
    )
