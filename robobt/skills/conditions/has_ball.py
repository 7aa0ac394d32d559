"""Does this robot have the ball?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.rules import has_ball


@skill
class HasBall(Condition):
    """Succeeds while the robot has the ball in its mouth or right in front of it."""

    def on_running(self) -> Status:
        """Check the sensor and the geometry."""
        return self.succeed() if has_ball(self.me, self.ball) else self.fail("it does not have the ball")
