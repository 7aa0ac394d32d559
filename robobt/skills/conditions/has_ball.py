"""Does this robot have the ball?"""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.skills.possession import has_ball
from robobt.tree import Status


@skill
class HasBall(Skill):
    """Succeeds while the robot has the ball in or right before its mouth."""

    def on_running(self) -> Status:
        """Ask the sensor and the geometry."""
        return self.succeed() if has_ball(self.me, self.ball) else self.fail("it does not have the ball")
