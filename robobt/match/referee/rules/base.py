"""What every rule is made of."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import ClassVar

from robobt.match.referee.events import Detail, EventKind, RefereeEvent
from robobt.match.referee.scene import Phase, Scene
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.state import RobotId

AGAIN = 2.0
"""An offence that goes on, or is repeated, is reported again after this long. Source: AutoReferee [s]."""


class Rule(ABC):
    """Something that the referee looks out for; it keeps what it has to remember.

    Attributes:
        phases: in which phases it looks.
    """

    phases: ClassVar[frozenset[Phase]]

    def enter(self, _: Scene) -> None:
        """Forget what does not outlast the change: one of its phases begins with this frame."""
        return

    @abstractmethod
    def check(self, scene: Scene) -> Iterable[RefereeEvent]:
        """Look at the present frame, in one of its phases; return what happened."""


class Cooldown:
    """Lets something through once, and again :data:`AGAIN` seconds later."""

    def __init__(self, pause: float = AGAIN) -> None:
        self._pause = pause
        self._last: dict[object, float] = {}

    def ready(self, key: object, time: float) -> bool:
        """Return whether ``key`` has not been let through lately; it counts as let through now."""
        last = self._last.get(key)
        if last is not None and time - last < self._pause:
            return False
        self._last[key] = time
        return True


def event(
    scene: Scene, kind: EventKind, robot: RobotId | None, at: Point | None = None, **details: Detail
) -> RefereeEvent:
    """Return an event of a robot's team at a place, by default the ball's."""
    team = None if robot is None else robot.team
    return team_event(scene, kind, team, robot, at, **details)


def team_event(
    scene: Scene,
    kind: EventKind,
    team: Team | None,
    robot: RobotId | None = None,
    at: Point | None = None,
    **details: Detail,
) -> RefereeEvent:
    """Return an event of a team, by a robot where that is known."""
    x, y = scene.frame.ball.position if at is None else at
    return RefereeEvent(scene.time, kind, team, robot, x, y, details)
