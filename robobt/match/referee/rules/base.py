"""The base of every rule."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import ClassVar

from robobt.match.referee.events import Detail, EventKind, RefereeEvent
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.state import RobotId

AGAIN = 2.0
"""Time after which a continued or repeated offence is reported again [s]. Source: AutoReferee."""


class Rule(ABC):
    """A rule that the referee checks, with the state that it needs.

    Attributes:
        phases: phases in which it is checked.
    """

    phases: ClassVar[frozenset[PlayPhase]]

    def enter(self, _: RefereeScene) -> None:
        """Reset its state, because one of its phases begins with this frame."""
        return

    @abstractmethod
    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Check the present frame, in one of its phases; return the events."""


class RepeatLimit:
    """Lets a report through once, and again :data:`AGAIN` seconds later."""

    def __init__(self) -> None:
        self._last: dict[object, float] = {}

    def ready(self, key: object, time: float) -> bool:
        """Return whether ``key`` may be reported now, and note that it was."""
        last = self._last.get(key)
        if last is not None and time - last < AGAIN:
            return False
        self._last[key] = time
        return True


def event(
    scene: RefereeScene, kind: EventKind, robot: RobotId | None, at: Point | None = None, **details: Detail
) -> RefereeEvent:
    """Return an event caused by a robot at a place, by default the ball's."""
    team = None if robot is None else robot.team
    return team_event(scene, kind, team, robot, at, **details)


def team_event(
    scene: RefereeScene,
    kind: EventKind,
    team: Team | None,
    robot: RobotId | None = None,
    at: Point | None = None,
    **details: Detail,
) -> RefereeEvent:
    """Return an event caused by a team and, if known, a robot."""
    x, y = scene.frame.ball.position if at is None else at
    return RefereeEvent(scene.time, kind, team, robot, x, y, details)
