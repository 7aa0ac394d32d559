"""The attacker's supporter."""

from __future__ import annotations

from math import radians

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.ball.face_ball import FaceBall
from robobt.skills.ball.intercept import Intercept
from robobt.skills.go_to_pose import GoToPose
from robobt.skills.team.mate_aims_at_me import MateAimsAtMe
from robobt.skills.team.pass_is_coming import PassIsComing
from robobt.skills.team.select_support_position import SelectSupportPosition
from robobt.tree import Behaviour


@PLAYS.register("attack_support")
def attack_support(*, speed_factor: float = 1.0) -> Behaviour:
    """Receive a pass, else stand still while a mate aims one, else wait where a pass and a shot are possible.

    Source: RoboBulls' published code, AttackSupport.

    Args:
        speed_factor: factor on the top speed when driving to a pass.
    """
    return first_of(
        "attack support",
        when("receive", PassIsComing(), Intercept(speed_factor=speed_factor)),
        when("expect", MateAimsAtMe(), FaceBall(dribbler=True)),
        when("position", SelectSupportPosition(), GoToPose(face_ball=True, heading_tolerance=radians(15.0))),
    )
