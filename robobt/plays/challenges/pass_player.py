"""A player of a team that only passes, for the passing challenge."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.plays.team_player import PASS_TOLERANCE, let_go
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.kick_loose import KickLoose
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.ball.settle_ball import SettleBall
from robobt.skills.conditions.is_second_to_ball import IsSecondToBall
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.skills.conditions.opponent_has_ball import OpponentHasBall
from robobt.skills.defence.avoid_crash import AvoidCrash
from robobt.skills.defence.challenge_ball import ChallengeBall
from robobt.skills.restarts.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.restarts.keep_distance import KeepDistance
from robobt.skills.restarts.prepare_restart import PrepareRestart
from robobt.skills.stop import Stop
from robobt.skills.tactics.choose_safe_pass import ChooseSafePass
from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.skills.tactics.show_for_pass import ShowForPass
from robobt.skills.tactics.task_switch import TaskSwitch
from robobt.skills.tactics_settings import TacticsSettings
from robobt.tree import Behaviour, Sequence


@PLAYS.register("pass_player")
def pass_player(
    *, enough: float = 0.6, patience: float = 1.0, quickest: float = 1.5, reaction: float = 0.25
) -> Behaviour:
    """Keep the ball in the team by passes of at least 1.3 m, and never shoot, within the referee's commands.

    While the opponents have the ball, one robot goes for it and another stands in its way.
    Any number of robots may play it; it needs no goalkeeper.

    Args:
        enough: worth of a pass that is played at once, 0 to 1.
        patience: time in which that falls to almost nothing [s].
        quickest: highest speed and acceleration assumed of opponents [m/s, m/s^2].
        reaction: reaction time assumed of opponents to a kick [s].
    """
    attack = first_of(
        "keep the ball",
        let_go(),
        KickLoose(),
        ReceivePass(redirect_at=1.0),
        SettleBall(),
        when(
            "pass",
            ChooseSafePass(enough=enough, patience=patience),
            KickToTarget(take=True, pass_tolerance=PASS_TOLERANCE),
        ),
        when("get the ball", GoToBall(), PickUpBall()),
    )
    restart = first_of(
        "restart",
        Sequence(
            "take it",
            memory=True,
            children=[
                # Chosen before the whistle too, so that the robot stands behind the ball for it.
                ChooseSafePass(enough=0.0, least=0.0),
                MayTouchBall(),
                KickToTarget(pass_tolerance=PASS_TOLERANCE),
            ],
        ),
        PrepareRestart(stay=True),
    )
    off_the_ball = first_of(
        "off the ball",
        when("challenge", OpponentHasBall(), IsSecondToBall(), ChallengeBall()),
        ShowForPass(),
    )
    player = TaskSwitch(
        "part",
        {
            "halt": Stop(),
            "take_restart": restart,
            "kickoff": first_of(
                "kick-off",
                when("ours", MayTouchBall(), ShowForPass()),
                GoToKickoffPosition(spare_mates=True),
            ),
            "dead_ball": first_of(
                "ball is dead",
                when("ours", MayTouchBall(), ShowForPass()),
                when("keep away", KeepDistance(), ShowForPass()),
            ),
            "attack": attack,
        },
        otherwise=off_the_ball,
        tactics=TacticsSettings(quickest=quickest, reaction=reaction),
    )
    return AvoidCrash("no crash", player)
