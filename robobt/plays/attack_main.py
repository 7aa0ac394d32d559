"""The main attacker."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.aim.pass_is_steady import PassIsSteady
from robobt.skills.aim.raters import Rater
from robobt.skills.aim.select_pass import SelectPass
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.aim.shot_is_steady import ShotIsSteady
from robobt.skills.ball.dribble_to import DribbleTo
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.tree import Behaviour, FailureIsSuccess


@PLAYS.register("attack_main")
def attack_main(
    *,
    rater: Rater = "segment_clearance",
    min_score: float = 0.0,
    max_distance: float | None = None,
    shot_speed: float | None = None,
    speed_factor: float = 1.0,
    dribble_speed: float = 2.0,
    steady: float = 0.1,
) -> Behaviour:
    """Get the ball, then shoot, else pass, else dribble to a better place for a shot.

    Without team-mates it never passes. A shot or pass starts once it has been open for ``steady``. It then
    survives a gap as long as it has been open, up to ``steady``.

    Source: RoboBulls' published code, AttackMain.

    Args:
        rater: the shot rater, by name or with settings.
        min_score: worst shot taken, 0 to 1.
        max_distance: no shots from farther than this from the goal [m]; None for no limit.
        shot_speed: kick speed of a shot [m/s]; None for the kick's default.
        speed_factor: factor on the top speed without the ball.
        dribble_speed: top speed with the ball [m/s].
        steady: how long a shot or pass must have been open [s]; RoboBulls uses 0.9.
    """
    look = SelectShot(rater=rater, min_score=min_score, max_distance=max_distance)
    return first_of(
        "attack main",
        when(
            "score",
            FailureIsSuccess("look for a shot", look),
            ShotIsSteady(rise=steady, fall=steady),
            KickToTarget(kick_speed=shot_speed, speed_factor=speed_factor),
        ),
        when(
            "pass",
            FailureIsSuccess("look for a pass", SelectPass()),
            PassIsSteady(rise=steady, fall=steady),
            KickToTarget(speed_factor=speed_factor),
        ),
        when("dribble", HasBall(), BestFieldPosition(), DribbleTo(max_speed=dribble_speed)),
        when("get the ball", GoToBall(speed_factor=speed_factor), PickUpBall()),
    )
