"""Distances and speeds of robots while play is stopped or restarts."""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import RepeatLimit, Rule, event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import Team
from robobt.world.rules import AREA_DISTANCE, area_distance
from robobt.world.state import ROBOT_RADIUS, RobotId

_AREA_TOLERANCE = 0.015
"""Source: AutoReferee [m]."""

POINT_TOLERANCE = 0.02
"""Tolerance of the distance that robots keep from the ball [m]. Source: AutoReferee."""

_TOO_FAST_FOR = 0.3
"""Time for which a robot must be too fast to be reported [s]. Source: AutoReferee."""


class AreaDistance(Rule):
    """Robots must keep 0.2 m from the opponents' defence area in STOP and at free kicks.

    Checked from ``grace`` [s] after play was stopped; not while an opponent touches the robot.
    """

    phases = frozenset({PlayPhase.STOP, PlayPhase.KICK})

    def __init__(self, grace: float) -> None:
        self._grace = grace
        self._again = RepeatLimit()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a team every two seconds."""
        if scene.elapsed < self._grace:
            return
        reach = AREA_DISTANCE + ROBOT_RADIUS - _AREA_TOLERANCE
        field = scene.field
        near = field.half_length - field.defense_depth - reach
        for team in Team:
            ahead = 1.0 if team is Team.BLUE else -1.0
            for robot in scene.team(team):
                if ahead * robot.x < near:
                    continue
                gap = area_distance(field, team.other, robot.x, robot.y)
                if gap < reach and not scene.pushed(team, robot) and self._again.ready(team, scene.time):
                    yield event(
                        scene,
                        EventKind.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA,
                        RobotId(team, robot.id),
                        robot.position,
                        distance=max(0.0, gap - ROBOT_RADIUS),
                        ball_location=scene.frame.ball.position,
                    )


class KickPointDistance(Rule):
    """Opponents must keep ``least`` [m] from the ball while a kick-off or free kick is taken.

    Checked from ``grace`` [s] after play was stopped.
    """

    phases = frozenset({PlayPhase.KICK})

    def __init__(self, least: float, grace: float) -> None:
        self._least, self._grace = least, grace
        self._again = RepeatLimit()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a robot every two seconds."""
        kicking, ball = scene.game.restart_team, scene.frame.ball
        if kicking is None or scene.time - scene.stopped < self._grace:
            return
        reach = self._least + ROBOT_RADIUS - POINT_TOLERANCE
        defending = kicking.other
        for robot in scene.team(defending):
            dx, dy = robot.x - ball.x, robot.y - ball.y
            if dx * dx + dy * dy < reach * reach:
                identity = RobotId(defending, robot.id)
                if self._again.ready(identity, scene.time):
                    yield event(
                        scene,
                        EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT,
                        identity,
                        robot.position,
                        distance=hypot(dx, dy) - ROBOT_RADIUS,
                    )


class StopSpeed(Rule):
    """Robots may not be faster than ``most`` [m/s] in STOP, checked from ``grace`` [s] after it began."""

    phases = frozenset({PlayPhase.STOP})

    def __init__(self, most: float, grace: float) -> None:
        self._most, self._grace = most, grace
        self._fast: dict[RobotId, float] = {}
        self._told: set[RobotId] = set()

    def enter(self, _: RefereeScene) -> None:
        """Begin a stop."""
        self._fast.clear()
        self._told.clear()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a robot once a stop."""
        if scene.elapsed < self._grace:
            return
        most = self._most * self._most
        for team in Team:
            for robot in scene.team(team):
                identity = RobotId(team, robot.id)
                if robot.vx * robot.vx + robot.vy * robot.vy <= most:
                    self._fast.pop(identity, None)
                    continue
                since = self._fast.setdefault(identity, scene.time)
                if scene.time - since > _TOO_FAST_FOR and identity not in self._told:
                    self._told.add(identity)
                    yield event(
                        scene, EventKind.BOT_TOO_FAST_IN_STOP, identity, robot.position, speed=robot.speed
                    )
