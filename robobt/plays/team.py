"""The robots of a team under a referee: field players, defenders and a goalkeeper.

Every one reads from the top: what the referee wants comes first, open play last.
Nobody has a fixed part. Of the field players, and of the defenders near their
own goal, the one with the shortest way goes for the ball; the others support it,
or mark opponents while the ball is in their half.
"""

from __future__ import annotations

from typing import NamedTuple

from robobt.plays.attack_main import attack_main
from robobt.plays.attack_support import attack_support
from robobt.plays.base import PLAYS, first_of, when
from robobt.plays.goalkeeper import goalkeeper
from robobt.plays.penalty_kick import penalty_kick
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.raters import Rater
from robobt.skills.aim.select_pass import SelectPass
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.ball.intercept import Intercept
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.conditions.ball_coming import BallComing
from robobt.skills.conditions.ball_in_own_half import BallInOwnHalf
from robobt.skills.conditions.ball_in_play import BallInPlay
from robobt.skills.conditions.carried_far import CarriedFar
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.conditions.is_halted import IsHalted
from robobt.skills.conditions.is_restart import IsRestart
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.skills.conditions.team_has_ball import TeamHasBall
from robobt.skills.conditions.under_pressure import UnderPressure
from robobt.skills.defence.block_shot import BlockShot
from robobt.skills.defence.close_down import CloseDown
from robobt.skills.defence.cover_angle import CoverAngle
from robobt.skills.defence.mark_opponent import MarkOpponent
from robobt.skills.defence.shot_coming import ShotComing
from robobt.skills.defence.stay_out import StayOut
from robobt.skills.defence.wall import Wall
from robobt.skills.restarts.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.restarts.go_to_penalty_position import GoToPenaltyPosition
from robobt.skills.restarts.keep_distance import KeepDistance
from robobt.skills.restarts.place_ball import PlaceBall
from robobt.skills.restarts.prepare_restart import PrepareRestart
from robobt.skills.stop import Stop
from robobt.skills.team.is_attacker import IsAttacker
from robobt.tree import Behaviour, Inverter, Selector, Sequence
from robobt.world.game import Restart

UPFIELD_SPEED = 2.0
"""Of a kick that is neither shot nor pass: fast enough to get away, too slow to leave the field [m/s]."""


_KICKED = 2.5
"""A ball that approaches the goal faster than this was kicked, not rolled on [m/s]."""


class Shooting(NamedTuple):
    """Which shots are taken.

    Attributes:
        rater: the shot rater, by name or with settings.
        min_score: worst shot taken, 0 to 1; what a score means is the rater's.
        distance: farthest from the goal [m].
    """

    rater: Rater
    min_score: float
    distance: float


@PLAYS.register("field_player")
def field_player(
    *,
    rater: Rater = "open_angle",
    min_score: float = 0.05,
    shot_distance: float = 5.0,
    dribble_speed: float = 1.2,
    farthest: float | None = None,
) -> Behaviour:
    """Attack when first to the ball, else mark in the own half and support in the other.

    Args:
        rater: the shot rater, by name or with settings.
        min_score: worst shot taken, 0 to 1.
        shot_distance: no shots from farther than this from the goal [m].
        dribble_speed: top speed with the ball [m/s].
        farthest: largest x of the ball at which it goes for it [m]; None is any.
    """
    shooting = Shooting(rater, min_score, shot_distance)
    return StayOut(
        "field player",
        first_of(
            "by the rules",
            when("halted", IsHalted(), Stop()),
            take_penalty(farthest),
            place_ball(farthest),
            take_restart(shooting, farthest),
            when("kick-off", IsRestart(kind=Restart.KICKOFF), GoToKickoffPosition()),
            when("penalty", IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition()),
            when("ball is dead", ball_dead(), KeepDistance(), off_the_ball()),
            when("on the ball", IsAttacker(farthest=farthest), on_the_ball(shooting, dribble_speed)),
            off_the_ball(),
        ),
    )


@PLAYS.register("defender")
def defender(
    *,
    place: int = 0,
    size: int = 1,
    rater: Rater = "open_angle",
    min_score: float = 0.05,
    shot_distance: float = 5.0,
    dribble_speed: float = 1.0,
    farthest: float = -1.0,
) -> Behaviour:
    """Stand in the wall before the own defence area; play the ball when first to it there.

    Args:
        place: in the wall, counted from 0 on the left as it looks out.
        size: how many defenders the wall has.
        rater: the shot rater, by name or with settings.
        min_score: worst shot taken, 0 to 1.
        shot_distance: no shots from farther than this from the goal [m].
        dribble_speed: top speed with the ball [m/s].
        farthest: largest x of the ball at which it goes for it [m].
    """
    shooting = Shooting(rater, min_score, shot_distance)
    return StayOut(
        "defender",
        first_of(
            "by the rules",
            when("halted", IsHalted(), Stop()),
            take_penalty(farthest),
            place_ball(farthest),
            take_restart(shooting, farthest),
            when("penalty", IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition()),
            when("ball is dead", ball_dead(), KeepDistance(), Wall(place=place, size=size)),
            when("on the ball", IsAttacker(farthest=farthest), on_the_ball(shooting, dribble_speed)),
            Wall(place=place, size=size),
        ),
    )


@PLAYS.register("keeper")
def keeper(*, speed: float = 1.0) -> Behaviour:
    """Keep goal as ``goalkeeper`` does, within the referee's commands.

    Args:
        speed: factor on its top speed.
    """
    return keep_by_the_rules(speed, goalkeeper(speed=speed))


def keep_by_the_rules(speed: float, in_play: Behaviour) -> Behaviour:
    """Do what the referee wants of a goalkeeper, and ``in_play`` while the ball is."""
    return first_of(
        "keeper",
        when("halted", IsHalted(), Stop()),
        when("penalty", ball_dead(), IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition(goalkeeper=True)),
        when("ball is dead", ball_dead(), KeepDistance(goalkeeper=True), CoverAngle(speed=speed)),
        when("their penalty", IsRestart(kind=Restart.PENALTY, ours=False), save_penalty(speed)),
        in_play,
    )


def save_penalty(speed: float) -> Behaviour:
    """Come out to the kicker of a penalty kick, who is alone; get onto the line of what it kicks."""
    return first_of(
        "save",
        when("shot", ShotComing(min_speed=_KICKED, margin=0.1), BlockShot(speed=speed)),
        CloseDown(speed=speed),
    )


def ball_dead() -> Behaviour:
    """Succeed while the ball is not in play."""
    return Inverter("ball is dead", BallInPlay())


def take_penalty(farthest: float | None) -> Behaviour:
    """Take an own penalty kick when nearest to it: carry the ball on, draw the goalkeeper, shoot in time."""
    return when(
        "our penalty",
        IsRestart(kind=Restart.PENALTY, ours=True),
        IsAttacker(farthest=farthest),
        first_of("wait", MayTouchBall(), PrepareRestart()),
        penalty_kick(),
    )


def place_ball(farthest: float | None) -> Behaviour:
    """Bring the ball to the referee's spot when nearest to it; the others keep away."""
    return when(
        "our placement",
        IsRestart(kind=Restart.BALL_PLACEMENT, ours=True),
        IsAttacker(farthest=farthest),
        PlaceBall(),
    )


def take_restart(shooting: Shooting, farthest: float | None) -> Behaviour:
    """Take an own restart when nearest to it; where it goes is settled when it may be taken."""
    take_it = Sequence("take it", memory=True, children=[MayTouchBall(), kick_away(shooting, settled=True)])
    where_to = first_of("where to", *aims(shooting))
    return when(
        "our restart",
        IsRestart(ours=True),
        IsAttacker(farthest=farthest),
        first_of("restart", take_it, when("get ready", where_to, PrepareRestart())),
    )


def kick_away(shooting: Shooting, *, settled: bool) -> Behaviour:
    """Shoot, else pass, else kick the ball upfield; ``settled`` stays with what was begun."""
    shot, pass_, upfield = aims(shooting)
    return Selector(
        "kick away",
        memory=settled,
        children=[
            Sequence("shoot", memory=settled, children=[shot, KickToTarget()]),
            Sequence("pass", memory=settled, children=[pass_, KickToTarget()]),
            Sequence("upfield", memory=settled, children=[upfield, KickToTarget(kick_speed=UPFIELD_SPEED)]),
        ],
    )


def aims(shooting: Shooting) -> tuple[Behaviour, Behaviour, Behaviour]:
    """Return where the ball may be kicked, the best first: at the goal, to a team-mate, upfield."""
    shot = SelectShot(rater=shooting.rater, min_score=shooting.min_score, max_distance=shooting.distance)
    return shot, SelectPass(min_score=0.1), AimUpfield()


def on_the_ball(shooting: Shooting, dribble_speed: float) -> Behaviour:
    """Attack, and let the ball go before it has been carried as far as the rules allow."""
    return first_of(
        "attack",
        when("let go", CarriedFar(limit=0.8), Stop()),
        when("receive", BallComing(), Intercept()),
        when("pressed", HasBall(), UnderPressure(), kick_away(shooting, settled=False)),
        attack_main(
            rater=shooting.rater,
            min_score=shooting.min_score,
            max_distance=shooting.distance,
            dribble_speed=dribble_speed,
        ),
    )


def off_the_ball() -> Behaviour:
    """Mark an opponent while the ball is in the own half and not ours, else support."""
    return first_of(
        "off the ball",
        when("mark", BallInOwnHalf(), Inverter("not ours", TeamHasBall()), MarkOpponent()),
        attack_support(),
    )
