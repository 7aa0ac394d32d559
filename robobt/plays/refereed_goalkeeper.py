"""A goalkeeper under a referee: the referee's commands come first, open play last."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.plays.goalkeeper import goalkeeper
from robobt.skills.conditions.ball_in_play import BallInPlay
from robobt.skills.conditions.is_halted import IsHalted
from robobt.skills.conditions.is_restart import IsRestart
from robobt.skills.defence.block_shot import BlockShot
from robobt.skills.defence.close_down import CloseDown
from robobt.skills.defence.cover_angle import CoverAngle
from robobt.skills.defence.shot_coming import ShotComing
from robobt.skills.restarts.go_to_penalty_position import GoToPenaltyPosition
from robobt.skills.restarts.keep_distance import KeepDistance
from robobt.skills.stop import Stop
from robobt.tree import Behaviour, Inverter
from robobt.world.game import Restart

_PENALTY_SHOT_SPEED = 2.5
"""A ball that approaches the goal faster than this counts as kicked [m/s]."""


@PLAYS.register("refereed_goalkeeper")
def refereed_goalkeeper(*, speed_factor: float = 1.0) -> Behaviour:
    """Keep goal as ``goalkeeper`` does, within the referee's commands.

    Args:
        speed_factor: factor on its top speed.
    """
    return keep_by_the_rules(speed_factor, goalkeeper(speed_factor=speed_factor))


def keep_by_the_rules(speed_factor: float, in_play: Behaviour) -> Behaviour:
    """Follow the referee's commands for a goalkeeper, and tick ``in_play`` while the ball is in play."""
    return first_of(
        "goalkeeper",
        when("halted", IsHalted(), Stop()),
        when("penalty", ball_dead(), IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition(goalkeeper=True)),
        when(
            "ball is dead", ball_dead(), KeepDistance(goalkeeper=True), CoverAngle(speed_factor=speed_factor)
        ),
        when("their penalty", IsRestart(kind=Restart.PENALTY, ours=False), save_penalty(speed_factor)),
        in_play,
    )


def save_penalty(speed_factor: float) -> Behaviour:
    """Come out towards the kicker of a penalty kick; get onto the line of a kicked ball."""
    return first_of(
        "save",
        when(
            "shot",
            ShotComing(min_speed=_PENALTY_SHOT_SPEED, margin=0.1),
            BlockShot(speed_factor=speed_factor),
        ),
        CloseDown(speed_factor=speed_factor),
    )


def ball_dead() -> Behaviour:
    """Succeed while the ball is not in play."""
    return Inverter("ball is dead", BallInPlay())
