"""Is the ball in the own half?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class BallInOwnHalf(Condition):
    """Succeeds while the ball is on the own side of the line at ``x``.

    Args:
        x: where the own side ends [m]; 0 is the half-way line.
    """

    x: float = 0.0

    def on_running(self) -> Status:
        """Compare the ball's x."""
        return self.succeed() if self.ball.x < self.x else self.fail("the ball is on their side")
