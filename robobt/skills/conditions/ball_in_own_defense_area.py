"""Is the ball in the own defence area?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.rules import in_own_defense_area


@skill
class BallInOwnDefenseArea(Condition):
    """Succeeds while the ball's centre is in the own defence area.

    Args:
        margin: how much the area is grown at its front and sides [m].
    """

    margin: float = 0.0

    def on_running(self) -> Status:
        """Look where the ball is."""
        if in_own_defense_area(self.frame.field, self.ball.x, self.ball.y, self.margin):
            return self.succeed()
        return self.fail("the ball is not in the own defence area")
