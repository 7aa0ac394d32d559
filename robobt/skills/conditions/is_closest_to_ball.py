"""Is this robot the nearest to the ball?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.geometry import distance


@skill
class IsClosestToBall(Condition):
    """Succeeds while no other robot of the team is nearer to the ball."""

    def on_running(self) -> Status:
        """Compare the distances."""
        frame, ball = self.frame, self.ball.position
        own = distance(self.me.position, ball)
        if any(distance(mate.position, ball) < own for mate in frame.teammates(self.me.id)):
            return self.fail("another robot is nearer to the ball")
        return self.succeed()
