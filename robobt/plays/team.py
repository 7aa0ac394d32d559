"""The robots of a team under a referee: field players, defenders and a goalkeeper.

Every one reads from the top: what the referee wants comes first, open play last.
Nobody has a fixed part. Of the field players, and of the defenders near their
own goal, the one with the shortest way goes for the ball; the others support it,
or mark opponents while the ball is in their half.
"""

from __future__ import annotations

from robobt.plays.attack_main import attack_main
from robobt.plays.attack_support import attack_support
from robobt.plays.base import PLAYS
from robobt.plays.goalkeeper import goalkeeper
from robobt.skills.aim_upfield import AimUpfield
from robobt.skills.ball_in_own_half import BallInOwnHalf
from robobt.skills.ball_in_play import BallInPlay
from robobt.skills.carried_far import CarriedFar
from robobt.skills.cover_angle import CoverAngle
from robobt.skills.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.go_to_penalty_position import GoToPenaltyPosition
from robobt.skills.has_ball import HasBall
from robobt.skills.is_attacker import IsAttacker
from robobt.skills.is_halted import IsHalted
from robobt.skills.is_restart import IsRestart
from robobt.skills.keep_distance import KeepDistance
from robobt.skills.kick_to_target import KickToTarget
from robobt.skills.mark_opponent import MarkOpponent
from robobt.skills.may_touch_ball import MayTouchBall
from robobt.skills.prepare_restart import PrepareRestart
from robobt.skills.receive_ball import ReceiveBall
from robobt.skills.select_pass import SelectPass
from robobt.skills.select_shot import SelectShot
from robobt.skills.stop import Stop
from robobt.skills.team_has_ball import TeamHasBall
from robobt.skills.wall import Wall
from robobt.tree import Behaviour, Inverter, Selector, Sequence
from robobt.world.game import Restart


@PLAYS.register("field_player")
def field_player(
    *, shot_distance: float = 4.0, dribble_speed: float = 1.2, farthest: float | None = None
) -> Behaviour:
    """Attack when nearest to the ball, else mark in the own half and support in the other.

    Args:
        shot_distance: no shots from farther than this from the goal [m].
        dribble_speed: top speed with the ball [m/s].
        farthest: largest x of the ball at which it goes for it [m]; None is any.
    """
    return Selector(
        "field player",
        memory=False,
        children=[
            when("halted", IsHalted(), Stop()),
            take_restart(shot_distance, farthest),
            when("kick-off", IsRestart(kind=Restart.KICKOFF), GoToKickoffPosition()),
            when("penalty", IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition()),
            when("ball is dead", ball_dead(), KeepDistance(), off_the_ball()),
            when("on the ball", IsAttacker(farthest=farthest), on_the_ball(shot_distance, dribble_speed)),
            off_the_ball(),
        ],
    )


@PLAYS.register("defender")
def defender(
    *, place: int = 0, size: int = 1, shot_distance: float = 4.0, farthest: float = -1.0
) -> Behaviour:
    """Stand in the wall before the own defence area; play the ball when nearest to it there.

    Args:
        place: in the wall, counted from 0 on the left as it looks out.
        size: how many defenders the wall has.
        shot_distance: no shots from farther than this from the goal [m].
        farthest: largest x of the ball at which it goes for it [m].
    """
    return Selector(
        "defender",
        memory=False,
        children=[
            when("halted", IsHalted(), Stop()),
            take_restart(shot_distance, farthest),
            when("penalty", IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition()),
            when("ball is dead", ball_dead(), KeepDistance(), Wall(place=place, size=size)),
            when("on the ball", IsAttacker(farthest=farthest), on_the_ball(shot_distance, 1.0)),
            Wall(place=place, size=size),
        ],
    )


@PLAYS.register("keeper")
def keeper(*, speed: float = 1.0) -> Behaviour:
    """The goalkeeper, who obeys the referee too.

    Args:
        speed: factor on its top speed.
    """
    return Selector(
        "keeper",
        memory=False,
        children=[
            when("halted", IsHalted(), Stop()),
            when("penalty", IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition(goalkeeper=True)),
            when("ball is dead", ball_dead(), KeepDistance(goalkeeper=True), CoverAngle(speed=speed)),
            goalkeeper(speed=speed),
        ],
    )


def when(name: str, *steps: Behaviour) -> Behaviour:
    """Conditions, then what to do while they hold; looked at anew every tick."""
    return Sequence(name, memory=False, children=list(steps))


def ball_dead() -> Behaviour:
    """The ball is not in play."""
    return Inverter("ball is dead", BallInPlay())


def take_restart(shot_distance: float, farthest: float | None) -> Behaviour:
    """Take an own restart when nearest to it; where it goes is settled when it may be taken."""
    take_it = Sequence("take it", memory=True, children=[MayTouchBall(), aim(shot_distance), KickToTarget()])
    get_ready = when("get ready", aim(shot_distance), PrepareRestart())
    return when(
        "our restart",
        IsRestart(ours=True),
        IsAttacker(farthest=farthest),
        Selector("restart", memory=False, children=[take_it, get_ready]),
    )


def aim(shot_distance: float) -> Behaviour:
    """A shot, else a pass, else upfield."""
    return Selector(
        "aim",
        memory=False,
        children=[SelectShot(max_distance=shot_distance), SelectPass(min_score=0.1), AimUpfield()],
    )


def on_the_ball(shot_distance: float, dribble_speed: float) -> Behaviour:
    """Attack, and let the ball go before it has been carried as far as the rules allow."""
    return Selector(
        "attack",
        memory=False,
        children=[
            when("let go", CarriedFar(limit=0.6), Stop()),
            when("receive", Inverter("free ball", HasBall()), ReceiveBall()),
            attack_main(max_distance=shot_distance, dribble_speed=dribble_speed),
        ],
    )


def off_the_ball() -> Behaviour:
    """Mark an opponent while the ball is in the own half and not ours, else support."""
    return Selector(
        "off the ball",
        memory=False,
        children=[
            when("mark", BallInOwnHalf(), Inverter("not ours", TeamHasBall()), MarkOpponent()),
            attack_support(),
        ],
    )
