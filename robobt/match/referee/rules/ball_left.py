"""The ball leaves the field: goals, touch line, goal line, aimless kicks."""

from __future__ import annotations

from collections.abc import Iterable

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import AGAIN, Rule, team_event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.rules import exit_point, own_side, scorer

_FROM_CENTRE = 0.2
"""A kick from closer to the half-way line than this is not aimless [m]. Source: AutoReferee."""


class BallLeft(Rule):
    """A ball fully over the line between posts and bar is a possible goal; elsewhere it is out.

    In a penalty kick the ball is also out, and the kick has failed whoever touched the ball last.

    ``aimless`` says whether a kick from the own half over the far goal line that no robot touches is its own
    event, as in division B.
    """

    phases = frozenset({PlayPhase.PLAY, PlayPhase.PENALTY})

    def __init__(self, *, aimless: bool) -> None:
        self._aimless = aimless
        self._told = False
        self._told_at = 0.0

    def enter(self, _: RefereeScene) -> None:
        """Reset, so that a ball kicked straight out is reported."""
        self._told = False

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report the ball once, as soon as it is out; a ball that bounces back is not reported again."""
        if not scene.out:
            self._told = self._told and scene.time - self._told_at < AGAIN
            return ()
        if self._told:
            return ()
        self._told, self._told_at = True, scene.time
        return (self._left(scene),)

    def _left(self, scene: RefereeScene) -> RefereeEvent:
        ball, last = scene.frame.ball, scene.touches.last
        team = None if last is None else last.team
        crossing, over_goal_line = exit_point(scene.field, scene.inside.position, ball.position)
        if scene.phase is PlayPhase.PENALTY and scorer(scene.field, scene.inside, ball) is not scene.penalty:
            reason = "the ball has left the field"
            return team_event(
                scene, EventKind.PENALTY_KICK_FAILED, scene.penalty, None, crossing, reason=reason
            )
        if not over_goal_line:
            return team_event(scene, EventKind.BALL_LEFT_FIELD_TOUCH_LINE, team, last, crossing)
        scoring = scorer(scene.field, scene.inside, ball)
        if scoring is not None:
            return self._goal(scene, scoring, crossing)
        attacker = Team.YELLOW if crossing[0] < 0.0 else Team.BLUE
        where = scene.touches.where
        from_own_half = where[0] * own_side(attacker) > _FROM_CENTRE
        if self._aimless and team is attacker and from_own_half:
            return team_event(scene, EventKind.AIMLESS_KICK, team, last, crossing, kick_location=where)
        return team_event(scene, EventKind.BALL_LEFT_FIELD_GOAL_LINE, team, last, crossing)

    def _goal(self, scene: RefereeScene, team: Team, crossing: Point) -> RefereeEvent:
        last, touches = scene.touches.last, scene.touches
        return team_event(
            scene,
            EventKind.POSSIBLE_GOAL,
            team,
            last if last is not None and last.team is team else None,
            crossing,
            kicking_team=None if last is None else last.team,
            kicking_bot=None if last is None else last.number,
            kick_location=touches.where,
            # In a penalty kick the ball's height is not limited.
            max_ball_height=None if scene.phase is PlayPhase.PENALTY else touches.highest[team],
            num_robots_by_team=len(scene.team(team)),
            last_touch_by_team=touches.times.get(team),
        )
