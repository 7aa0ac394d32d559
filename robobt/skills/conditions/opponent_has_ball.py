"""Do the opponents have the ball?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.rules import owner


@skill
class OpponentHasBall(Condition):
    """Succeeds while a robot of the other team has the ball."""

    def on_running(self) -> Status:
        """See who owns the ball."""
        holder = owner(self.frame)
        if holder is None or holder.team is self.frame.team:
            return self.fail("no opponent has the ball")
        return self.succeed()
