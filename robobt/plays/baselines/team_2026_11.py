"""The team of November 2026: field players, defenders and a goalkeeper, by the rules.

New teams are measured against this one. It is frozen: when a skill that these trees use changes its
decisions, they get a copy of the old skill. ``field_player`` and ``defender`` are the same trees with later
improvements: they evade moving robots by velocity and do not touch the ball in a defence area.

Every tree reads from the top: the referee's commands come first, open play last. No robot has a fixed part.
Among the field players, and the defenders near their own goal, the robot with the shortest way goes for the
ball; the others support it, or mark opponents while the ball is in their half.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from robobt.plays.attack_main import attack_main
from robobt.plays.attack_support import attack_support
from robobt.plays.base import PLAYS, first_of, when
from robobt.plays.baselines.go_round import GoRound
from robobt.plays.baselines.is_attacker import IsAttacker
from robobt.plays.baselines.mark_opponent import MarkOpponent
from robobt.plays.goalkeeper import goalkeeper
from robobt.plays.penalty_kick import penalty_kick
from robobt.plays.refereed_goalkeeper import ball_dead
from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.aim.raters import Rater
from robobt.skills.aim.select_pass import SelectPass
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.ball.intercept import Intercept
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.conditions.ball_coming import BallComing
from robobt.skills.conditions.ball_in_own_half import BallInOwnHalf
from robobt.skills.conditions.carried_far import CarriedFar
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.conditions.is_halted import IsHalted
from robobt.skills.conditions.is_restart import IsRestart
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.skills.conditions.team_has_ball import TeamHasBall
from robobt.skills.conditions.under_pressure import UnderPressure
from robobt.skills.defence.cover_angle import CoverAngle
from robobt.skills.defence.stay_out import StayOut
from robobt.skills.defence.wall import Wall
from robobt.skills.restarts.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.restarts.go_to_penalty_position import GoToPenaltyPosition
from robobt.skills.restarts.keep_distance import KeepDistance
from robobt.skills.restarts.place_ball import PlaceBall
from robobt.skills.restarts.prepare_restart import PrepareRestart
from robobt.skills.stop import Stop
from robobt.tree import Behaviour, Inverter, Selector, Sequence
from robobt.world.game import Restart

UPFIELD_SPEED = 2.0
"""Speed of a kick that is neither shot nor pass: it gets away but does not leave the field [m/s]."""


@dataclass(frozen=True)
class _Player:
    """A field player or defender.

    Attributes:
        rater: the shot rater, by name or with settings.
        min_score: worst shot taken, 0 to 1; its meaning depends on the rater.
        shot_distance: largest distance of a shot from the goal [m].
        dribble_speed: top speed with the ball [m/s].
        farthest: largest x of the ball at which it goes for it [m]; None is any.
    """

    rater: Rater
    min_score: float
    shot_distance: float
    dribble_speed: float
    farthest: float | None

    def field_player(self, name: str, penalty: Behaviour) -> Behaviour:
        """Attack when first to the ball, else mark in the own half and support in the other."""
        return first_of(
            name,
            *self._restarts(penalty),
            when("kick-off", IsRestart(kind=Restart.KICKOFF), GoToKickoffPosition()),
            when("penalty", IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition()),
            when("ball is dead", ball_dead(), KeepDistance(), _off_the_ball()),
            when("on the ball", self._attacks(), self._on_the_ball()),
            _off_the_ball(),
        )

    def defender(self, name: str, penalty: Behaviour, wall: Callable[[], Behaviour]) -> Behaviour:
        """Stand in the wall before the own defence area; play the ball when first to it there."""
        return first_of(
            name,
            *self._restarts(penalty),
            when("penalty", IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition()),
            when("ball is dead", ball_dead(), KeepDistance(), wall()),
            when("on the ball", self._attacks(), self._on_the_ball()),
            wall(),
        )

    def _restarts(self, penalty: Behaviour) -> tuple[Behaviour, ...]:
        """Return the branches for the referee's commands to the attacker, and to all robots in a halt."""
        take_it = Sequence("take it", memory=True, children=[MayTouchBall(), self._kick_away(settled=True)])
        get_ready = when("get ready", first_of("where to", *self._aims()), PrepareRestart())
        placing = IsRestart(kind=Restart.BALL_PLACEMENT, ours=True)
        return (
            when("halted", IsHalted(), Stop()),
            when(
                "our penalty",
                IsRestart(kind=Restart.PENALTY, ours=True),
                self._attacks(),
                first_of("wait", MayTouchBall(), PrepareRestart()),
                penalty,
            ),
            when("our placement", placing, self._attacks(), PlaceBall()),
            # The target is chosen when the restart may be taken.
            when(
                "our restart", IsRestart(ours=True), self._attacks(), first_of("restart", take_it, get_ready)
            ),
        )

    def _attacks(self) -> Behaviour:
        return IsAttacker(farthest=self.farthest)

    def _kick_away(self, *, settled: bool) -> Behaviour:
        """Shoot, else pass, else kick the ball upfield; ``settled`` keeps the first choice."""
        shot, pass_, upfield = self._aims()
        return Selector(
            "kick away",
            memory=settled,
            children=[
                Sequence("shoot", memory=settled, children=[shot, KickToTarget()]),
                Sequence("pass", memory=settled, children=[pass_, KickToTarget()]),
                Sequence(
                    "upfield", memory=settled, children=[upfield, KickToTarget(kick_speed=UPFIELD_SPEED)]
                ),
            ],
        )

    def _aims(self) -> tuple[Behaviour, Behaviour, Behaviour]:
        """Return the targets for a kick, the best first: the goal, a team-mate, upfield."""
        shot = SelectShot(rater=self.rater, min_score=self.min_score, max_distance=self.shot_distance)
        return shot, SelectPass(min_score=0.1), AimUpfield()

    def _on_the_ball(self) -> Behaviour:
        """Attack, and release the ball before the dribbling limit."""
        return first_of(
            "attack",
            when("let go", CarriedFar(limit=0.8), Stop()),
            when("receive", BallComing(), Intercept()),
            when("pressed", HasBall(), UnderPressure(), self._kick_away(settled=False)),
            attack_main(
                rater=self.rater,
                min_score=self.min_score,
                max_distance=self.shot_distance,
                dribble_speed=self.dribble_speed,
            ),
        )


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
    player = _Player(rater, min_score, shot_distance, dribble_speed, farthest)
    return StayOut("field player", player.field_player("by the rules", penalty_kick()))


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
    player = _Player(rater, min_score, shot_distance, dribble_speed, farthest)
    wall = partial(Wall, place=place, size=size)
    return StayOut("defender", player.defender("by the rules", penalty_kick(), wall))


@PLAYS.register("field_player_2026_11")
def field_player_2026_11(
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
    player = _Player(rater, min_score, shot_distance, dribble_speed, farthest)
    return GoRound("as in 2026-11", player.field_player("field player", _penalty_kick()))


@PLAYS.register("defender_2026_11")
def defender_2026_11(
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
    player = _Player(rater, min_score, shot_distance, dribble_speed, farthest)
    wall = partial(Wall, place=place, size=size)
    return GoRound("as in 2026-11", player.defender("defender", _penalty_kick(), wall))


@PLAYS.register("goalkeeper_2026_11")
def goalkeeper_2026_11(*, speed_factor: float = 1.0) -> Behaviour:
    """Keep goal as ``goalkeeper`` does, within the referee's commands.

    Args:
        speed_factor: factor on its top speed.
    """
    tree = first_of(
        "goalkeeper",
        when("halted", IsHalted(), Stop()),
        when("penalty", ball_dead(), IsRestart(kind=Restart.PENALTY), GoToPenaltyPosition(goalkeeper=True)),
        when(
            "ball is dead", ball_dead(), KeepDistance(goalkeeper=True), CoverAngle(speed_factor=speed_factor)
        ),
        goalkeeper(speed_factor=speed_factor),
    )
    return GoRound("as in 2026-11", tree)


def _penalty_kick() -> Behaviour:
    return penalty_kick(patience=1.2, dribble_speed=1.5)


def _off_the_ball() -> Behaviour:
    """Mark an opponent while the ball is in the own half and not ours, else support."""
    return first_of(
        "off the ball",
        when("mark", BallInOwnHalf(), Inverter("not ours", TeamHasBall()), MarkOpponent()),
        attack_support(),
    )
