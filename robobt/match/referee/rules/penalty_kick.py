"""Failed penalty kicks."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import Rule, team_event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import Team
from robobt.world.geometry import Point, distance

_STOPPED_BALL_SPEED = 0.01
"""A ball slower than this has stopped [m/s]."""

_TURN_TIME = 0.2
"""The ball's direction is compared with its direction this long ago [s]. Source: AutoReferee."""


class PenaltyKick(Rule):
    """A penalty kick fails if defenders stop the ball or turn it by 90 degrees, or the kicker takes it back.

    A ball that leaves the field is reported by another rule; the controller ends the kick when its time is
    over.
    """

    phases = frozenset({PlayPhase.PENALTY})

    def __init__(self, in_play_distance: float) -> None:
        self._in_play = in_play_distance
        self._spot: Point = (0.0, 0.0)
        self._past: deque[tuple[float, float, float]] = deque()
        self._farthest = 0.0
        self._told = False

    def enter(self, scene: RefereeScene) -> None:
        """Begin a kick."""
        self._spot = scene.frame.ball.position
        self._past.clear()
        self._farthest = 0.0
        self._told = False

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a failure once."""
        ball, team = scene.frame.ball, scene.penalty
        if self._told or team is None or distance(ball.position, self._spot) <= self._in_play:
            return
        self._past.append((scene.time, ball.vx, ball.vy))
        while scene.time - self._past[0][0] > _TURN_TIME:
            self._past.popleft()
        last = scene.touches.last
        defended = last is not None and last.team is not team
        forward = (1.0 if team is Team.BLUE else -1.0) * (ball.x - self._spot[0])
        self._farthest = max(self._farthest, forward)
        reason = None
        if defended:
            if ball.speed < _STOPPED_BALL_SPEED:
                reason = "the defending team has stopped the ball"
            elif any(vx * ball.vx + vy * ball.vy <= 0.0 for _, vx, vy in self._past):
                reason = "the defending team has turned the ball"
        elif scene.touches.now and forward < self._farthest - self._in_play:
            reason = "the kicker takes the ball away from the goal"
        if reason is not None:
            self._told = True
            yield team_event(scene, EventKind.PENALTY_KICK_FAILED, team, reason=reason)
