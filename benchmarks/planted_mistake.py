"""A field player that makes one mistake at a known time: it gives the ball to an opponent."""

from __future__ import annotations

from math import hypot

from robobt.plays import PLAYS
from robobt.plays.base import first_of, when
from robobt.plays.team_player import team_player
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.base import Condition, Skill, skill
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.store import Shot
from robobt.tree import Behaviour, Status

_LASTS = 1.5
"""How long the robot tries to make its mistake [s]."""


@skill
class IsTime(Condition):
    """Hold for a while from a time on.

    Args:
        at: when it begins [s].
    """

    at: float = 0.0

    def on_running(self) -> Status:
        """Compare the time."""
        now = 0.0 <= self.frame.time - self.at < _LASTS
        return self.succeed() if now else self.fail("not now")


@skill
class AimAtOpponent(Skill):
    """Write to ``shot`` a kick to the opponent that is nearest to the ball, other than one close by."""

    writes = ("shot",)

    def on_running(self) -> Status:
        """Choose the opponent."""
        ball = self.ball
        away = {(it.x, it.y): hypot(it.x - ball.x, it.y - ball.y) for it in self.frame.opponents}
        places = [place for place, gap in away.items() if gap > 0.5]
        if not places:
            return self.fail("nobody is there")
        self.store.shot = Shot(min(places, key=away.__getitem__), 0.2, 0.0)
        return self.succeed("to an opponent")


@PLAYS.register("mistaken_player")
def mistaken_player(*, at: float = 0.0) -> Behaviour:
    """Play as ``team_player``, but give the ball to an opponent once.

    Args:
        at: when [s].
    """
    kick = KickToTarget(take=True, kick_speed=3.0)
    return first_of("player", when("mistake", IsTime(at=at), HasBall(), AimAtOpponent(), kick), team_player())
