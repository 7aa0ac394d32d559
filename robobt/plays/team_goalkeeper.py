"""The goalkeeper of a team that shares out its tasks."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.plays.goalkeeper import keep_goal
from robobt.plays.refereed_goalkeeper import keep_by_the_rules
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.select_clearance import SelectClearance
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.conditions.ball_in_own_half import BallInOwnHalf
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense
from robobt.skills.defence.goalkeeper import Goalkeeper
from robobt.tree import Behaviour


@PLAYS.register("team_goalkeeper")
def team_goalkeeper(*, speed_factor: float = 1.0, chips: bool = True, policy: str = "") -> Behaviour:
    """Keep goal as ``refereed_goalkeeper`` does, and chip the ball out where no way along the ground is free.

    A ball that rests in the area is kicked to the foremost team-mate that can be reached, else upfield, over
    robots in front of the area.

    Args:
        speed_factor: factor on its top speed.
        chips: whether it may chip.
        policy: name or file of a model for Goalkeeper, which keeps goal while the ball is in play in the own
            half and does not have to be cleared; empty for the hand-written goalkeeper alone.
    """

    def kick(*, chip: bool = False) -> KickToTarget:
        return KickToTarget(speed_factor=speed_factor, goalkeeper=True, chip=chip)

    clear = first_of(
        "clear",
        when("clearance", SelectClearance(), kick()),
        when("upfield", AimUpfield(), kick(chip=chips)),
    )
    has_to_clear = when("ball in the area", BallRestsInDefense(), clear)
    learned = when("threat", BallInOwnHalf(), Goalkeeper(policy=policy)) if policy else None
    return keep_by_the_rules(speed_factor, keep_goal(speed_factor, has_to_clear, learned))
