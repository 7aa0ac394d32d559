"""Lack of progress, and too many robots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import inf

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import RepeatLimit, Rule, team_event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import Team
from robobt.world.geometry import Point, distance

_RUNNING = 2.0
"""Time in play before robots are counted [s]. Source: game controller."""

_TIME_TO_LEAVE = 10.0
"""Playing time for a robot to leave after a card [s]. Source: SSL rules."""


class NoProgress(Rule):
    """The ball must move by ``way`` [m] within ``limit`` [s]."""

    phases = frozenset({PlayPhase.PLAY})

    def __init__(self, limit: float, way: float) -> None:
        self._limit, self._way = limit, way
        self._place: Point = (0.0, 0.0)
        self._since = 0.0

    def enter(self, scene: RefereeScene) -> None:
        """Measure from where the ball comes into play."""
        self._place, self._since = scene.frame.ball.position, scene.time

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report it, and again after the same time."""
        ball, time = scene.frame.ball.position, scene.time
        if distance(ball, self._place) > self._way:
            self._place, self._since = ball, time
        elif time - self._since > self._limit:
            stuck, self._since = time - self._since, time
            return (team_event(scene, EventKind.NO_PROGRESS_IN_GAME, None, time=stuck),)
        return ()


class TooManyRobots(Rule):
    """A team may not have too many robots on the field ten seconds of play after its last card."""

    phases = frozenset({PlayPhase.KICK, PlayPhase.PLAY})

    def __init__(self) -> None:
        self._most: tuple[int | None, int | None] = (None, None)
        self._cards: dict[Team, list[float]] = {Team.BLUE: [], Team.YELLOW: []}
        self._played = 0.0
        self._again = RepeatLimit()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a team every two seconds: its opponents may want play to go on."""
        self._played += scene.frame.period
        blue, yellow = scene.game.blue.max_robots, scene.game.yellow.max_robots
        frame = scene.frame
        if (
            (blue, yellow) == self._most
            and len(frame.own) <= _any(blue)
            and len(frame.opponents) <= _any(yellow)
        ):
            return ()
        return self._count(scene, {Team.BLUE: blue, Team.YELLOW: yellow})

    def _count(self, scene: RefereeScene, allowed: Mapping[Team, int | None]) -> Iterator[RefereeEvent]:
        before = dict(zip(allowed, self._most, strict=True))
        self._most = allowed[Team.BLUE], allowed[Team.YELLOW]
        for team, most in allowed.items():
            if most is None:
                continue
            robots, cards, was = scene.team(team), self._cards[team], before[team]
            if was is not None:
                cards += [self._played] * (was - most)
            if len(robots) <= most or scene.elapsed < _RUNNING:
                continue
            recent = [card for card in cards if self._played - card < _TIME_TO_LEAVE]
            if len(robots) > most + len(recent) and self._again.ready(team, scene.time):
                yield team_event(
                    scene,
                    EventKind.TOO_MANY_ROBOTS,
                    team,
                    num_robots_allowed=most,
                    num_robots_on_field=len(robots),
                    ball_location=scene.frame.ball.position,
                )


def _any(most: int | None) -> float:
    return inf if most is None else most
