"""Condition: an opponent is about to take the ball."""

from __future__ import annotations

from math import hypot

from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class UnderPressure(Condition):
    """SUCCESS while an opponent's centre is within ``distance`` of the ball.

    Args:
        distance: from the opponent's centre to the ball [m].
    """

    distance: float = 0.3

    def on_running(self) -> Status:
        """Look for one."""
        x, y = self.ball.position
        for robot in self.frame.opponents:
            if hypot(robot.x - x, robot.y - y) <= self.distance:
                return self.succeed(f"{robot.id} is near")
        return self.fail("no opponent is near")
