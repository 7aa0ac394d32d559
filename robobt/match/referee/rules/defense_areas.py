"""The defence areas in play: only the goalkeeper may touch the ball there, for a limited time."""

from __future__ import annotations

from collections.abc import Iterable

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import RepeatLimit, Rule, event, team_event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import Team
from robobt.world.rules import area_distance, in_defense_area
from robobt.world.state import ROBOT_RADIUS

_PARTLY_INSIDE = ROBOT_RADIUS - 0.02
"""An attacker whose centre is this close to the area is partly inside [m]. Source: AutoReferee."""

_LEAST_PLAY_TIME = 0.5
"""Time in play before this is checked [s]. Source: AutoReferee."""


class DefenseAreaTouch(Rule):
    """No attacker may touch the ball while partly in the area, and no defender while fully in its own.

    Not checked while both teams touch the ball, or while an opponent touches, and may push, the defender.
    """

    phases = frozenset({PlayPhase.PLAY, PlayPhase.PENALTY})

    def __init__(self) -> None:
        self._again = RepeatLimit()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a robot every two seconds."""
        touching = scene.touches.now
        if not touching or scene.elapsed < _LEAST_PLAY_TIME:
            return
        if any(robot.team is not touching[0].team for robot in touching):
            return
        field = scene.field
        for toucher in touching:
            robot = scene.robot(toucher)
            if robot is None:
                continue
            team = toucher.team
            if in_defense_area(field, team.other, robot.x, robot.y, _PARTLY_INSIDE):
                kind = EventKind.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA
                gap = area_distance(field, team.other, robot.x, robot.y) - ROBOT_RADIUS
            elif (
                in_defense_area(field, team, robot.x, robot.y, -ROBOT_RADIUS)
                and toucher != scene.keeper(team)
                and not scene.pushed(team, robot)
            ):
                kind = EventKind.DEFENDER_IN_DEFENSE_AREA
                gap = 0.0
            else:
                continue
            if self._again.ready(toucher, scene.time):
                yield event(scene, kind, toucher, robot.position, distance=max(0.0, gap))


class KeeperHeld(Rule):
    """The ball may stay in a defence area no longer than ``limit`` [s]."""

    phases = frozenset({PlayPhase.PLAY})

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._team: Team | None = None
        self._since = 0.0

    def enter(self, _: RefereeScene) -> None:
        """Count from where the ball comes into play."""
        self._team = None

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report it, and again after the same time."""
        x, y = scene.frame.ball.position
        defender = Team.BLUE if x < 0.0 else Team.YELLOW
        if not in_defense_area(scene.field, defender, x, y):
            self._team = None
        elif defender is not self._team:
            self._team, self._since = defender, scene.time
        elif scene.time - self._since > self._limit:
            duration, self._since = scene.time - self._since, scene.time
            return (team_event(scene, EventKind.KEEPER_HELD_BALL, defender, duration=duration),)
        return ()
