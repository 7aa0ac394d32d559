"""Condition: a team-mate that has the ball points it at this robot."""

from __future__ import annotations

from math import radians

from robobt.skills.base import Condition, skill
from robobt.skills.debounce import Debounce
from robobt.tree import Status
from robobt.world.geometry import direction, distance, wrap_angle
from robobt.world.rules import has_ball


@skill
class MateAimsAtMe(Condition):
    """SUCCESS while a team-mate with the ball faces this robot from far enough for a pass.

    Source: RoboBulls' published code, AttackSupport, which waits 0.9 s.

    Args:
        tolerance: largest angle between its heading and the direction to this robot [rad].
        nearest: least distance for a pass; a closer team-mate does not count as aiming [m].
        rise: how long the team-mate must have faced this robot [s].
    """

    tolerance: float = radians(10.0)
    nearest: float = 1.0
    rise: float = 0.2

    def __post_init__(self) -> None:
        super().__post_init__()
        self._steady = Debounce(self.rise, self.rise, on=False)

    def on_running(self) -> Status:
        """Look at the team-mate with the ball."""
        if self._steady.update(self._aimed_at(), self.frame.time):
            return self.succeed()
        return self.fail("no team-mate aims here")

    def _aimed_at(self) -> bool:
        here = self.me.position
        return any(
            has_ball(mate, self.ball)
            and distance(mate.position, here) >= self.nearest
            and abs(wrap_angle(direction(mate.position, here) - mate.heading)) <= self.tolerance
            for mate in self.frame.teammates(self.me.id)
        )
