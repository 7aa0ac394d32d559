"""Is this robot the nearest to the ball?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.geometry import distance


@skill
class IsClosestToBall(Condition):
    """Succeeds while no other robot of the team is nearer to the ball.

    Args:
        margin: how much nearer another robot may be while this one still counts as the closest [m].
        of_all: compare with the opponents too.
    """

    margin: float = 0.0
    of_all: bool = False

    def on_running(self) -> Status:
        """Compare the distances."""
        frame, ball = self.frame, self.ball.position
        limit = distance(self.me.position, ball) - self.margin
        rivals = frame.others(self.me.id) if self.of_all else frame.teammates(self.me.id)
        if any(distance(rival.position, ball) < limit for rival in rivals):
            return self.fail("another robot is nearer to the ball")
        return self.succeed()
