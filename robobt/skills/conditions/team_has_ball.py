"""Does the own team have the ball?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.rules import owner


@skill
class TeamHasBall(Condition):
    """Succeeds while a robot of the own team has the ball.

    Args:
        others_only: whether this robot itself is left out.
    """

    others_only: bool = False

    def on_running(self) -> Status:
        """See who owns the ball."""
        holder = owner(self.frame)
        if holder is None:
            return self.fail("nobody has the ball")
        if holder.team is not self.frame.team:
            return self.fail("the opponents have the ball")
        if self.others_only and holder.number == self.me.id:
            return self.fail("it has the ball itself")
        return self.succeed()
