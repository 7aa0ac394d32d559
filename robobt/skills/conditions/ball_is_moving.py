"""Does the ball move?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class BallIsMoving(Condition):
    """Succeeds while the ball is faster than ``speed``.

    Args:
        speed: below this it counts as resting [m/s].
    """

    speed: float = 0.2

    def on_running(self) -> Status:
        """Compare the ball's speed."""
        return self.succeed() if self.ball.speed > self.speed else self.fail("the ball rests")
