"""The goalkeeper of a team that shares out its tasks."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.plays.goalkeeper import keep_goal
from robobt.plays.team import keep_by_the_rules
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.select_clearance import SelectClearance
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense
from robobt.tree import Behaviour


@PLAYS.register("team_keeper")
def team_keeper(*, speed: float = 1.0, chips: bool = True) -> Behaviour:
    """Keep goal as ``keeper`` does, and chip the ball out of the area where there is no way along the ground.

    A ball that rests in the area goes to the foremost team-mate that can be reached, else upfield, over
    whoever waits before the area.

    Args:
        speed: factor on its top speed.
        chips: whether it may chip.
    """

    def kick(*, chip: bool = False) -> KickToTarget:
        return KickToTarget(speed=speed, goalkeeper=True, chip=chip)

    clear = first_of(
        "clear",
        when("clearance", SelectClearance(), kick()),
        when("upfield", AimUpfield(), kick(chip=chips)),
    )
    return keep_by_the_rules(speed, keep_goal(speed, when("ball in the area", BallRestsInDefense(), clear)))
