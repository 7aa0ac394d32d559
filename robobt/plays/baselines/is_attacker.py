"""Condition: this robot goes for the ball."""

from __future__ import annotations

from robobt.plays.baselines.agreement import attacker, enter_attacker
from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class IsAttacker(Condition):
    """SUCCESS for the one robot of the team that goes for the ball or takes the restart.

    It is the robot with the shortest way to behind the ball, among those that tick this condition; another
    takes over when its way is clearly shorter. A kicker that may not touch the ball again yet is skipped.

    Args:
        farthest: largest x of the ball at which this robot goes for it [m]; None for any x.
    """

    reads = ("team",)
    writes = ("team",)

    farthest: float | None = None

    def on_running(self) -> Status:
        """Register this robot and check who the attacker is."""
        team, number = self.store.team, self.me.id
        enter_attacker(team, number, self.farthest)
        chosen = attacker(self.frame, team)
        if chosen == number:
            return self.succeed()
        return self.fail("nobody" if chosen is None else f"{chosen} does")
