"""Ball placement by a team's robots."""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot, inf

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import Rule, event, team_event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.geometry import Point, distance, segment_distance
from robobt.world.rules import PLACED_DISTANCE, STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS, RobotId

SOONEST = 2.0
"""Least duration of a placement [s]. Source: SSL rules."""

OWN_GAP = 0.05
"""Least distance of robots from the ball when their free kick follows [m]. Source: SSL rules."""

AVERAGE_SMOOTHING, STILL_DISTANCE = 0.97, 0.005
"""Weight of the past in the ball's moving average, and largest distance of a resting ball from it [m].

Source: AutoReferee.
"""

LEARNT_AT = 0.01
"""Frame length of the moving average [s]."""

_PLACEMENT_WAY_DISTANCE = STOP_DISTANCE + ROBOT_RADIUS
"""Least distance of opponents' centres from the ball's way [m]. Source: SSL rules."""

_INTERFERING = 2.0
"""Time for opponents to leave the ball's way [s]. Source: SSL rules."""


class PlacementSucceeded(Rule):
    """A placement succeeds with the ball at rest within 0.15 m of its spot and robots clear of it.

    Clear means 0.05 m if the placing team's free kick follows, else 0.5 m.
    """

    phases = frozenset({PlayPhase.PLACEMENT})

    def __init__(self) -> None:
        self._mean: Point = (0.0, 0.0)
        self._start: Point = (0.0, 0.0)
        self._told = False

    def enter(self, scene: RefereeScene) -> None:
        """Begin a placement."""
        self._mean = self._start = scene.frame.ball.position
        self._told = False

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report success once."""
        ball = scene.frame.ball.position
        share = AVERAGE_SMOOTHING ** (scene.frame.period / LEARNT_AT)
        mean = self._mean = (
            share * self._mean[0] + (1.0 - share) * ball[0],
            share * self._mean[1] + (1.0 - share) * ball[1],
        )
        spot, team = scene.game.placement, scene.game.restart_team
        if self._told or spot is None or team is None or scene.elapsed < SOONEST:
            return
        precision = distance(ball, spot)
        if precision > PLACED_DISTANCE or distance(ball, mean) > STILL_DISTANCE:
            return
        own = scene.game.next_team is team
        reach = ROBOT_RADIUS + (OWN_GAP if own else STOP_DISTANCE)
        for robot in (*scene.frame.own, *scene.frame.opponents):
            if hypot(robot.x - ball[0], robot.y - ball[1]) < reach:
                return
        self._told = True
        yield team_event(
            scene,
            EventKind.PLACEMENT_SUCCEEDED,
            team,
            time_taken=scene.elapsed,
            precision=precision,
            distance=distance(self._start, spot),
        )


class PlacementInterference(Rule):
    """Opponents of the placing team must stay 0.5 m away from the line from the ball to its spot."""

    phases = frozenset({PlayPhase.PLACEMENT})

    def __init__(self) -> None:
        self._since: dict[int, float] = {}

    def enter(self, _: RefereeScene) -> None:
        """Begin a placement."""
        self._since.clear()

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a robot once while it stays."""
        placing, spot, ball = scene.game.restart_team, scene.game.placement, scene.frame.ball.position
        if placing is None or spot is None:
            return
        other = placing.other
        # Most robots are outside the rectangle around ball and spot, which is quicker to check.
        low_x, high_x = (
            min(ball[0], spot[0]) - _PLACEMENT_WAY_DISTANCE,
            max(ball[0], spot[0]) + _PLACEMENT_WAY_DISTANCE,
        )
        low_y, high_y = (
            min(ball[1], spot[1]) - _PLACEMENT_WAY_DISTANCE,
            max(ball[1], spot[1]) + _PLACEMENT_WAY_DISTANCE,
        )
        for robot in scene.team(other):
            number, x, y = robot.id, robot.x, robot.y
            if (
                not (low_x < x < high_x and low_y < y < high_y)
                or segment_distance((x, y), ball, spot) > _PLACEMENT_WAY_DISTANCE
            ):
                if self._since:
                    self._since.pop(number, None)
                continue
            since = self._since.setdefault(number, scene.time)
            if scene.time - since > _INTERFERING:
                self._since[number] = inf
                identity = RobotId(other, number)
                yield event(scene, EventKind.BOT_INTERFERED_PLACEMENT, identity, robot.position)
