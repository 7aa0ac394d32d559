"""Is this robot the next at the ball after its team's attacker, with the opponents in possession?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.skills.tactics.agree import agree
from robobt.tree import Status


@skill
class IsSecondToBall(Condition):
    """Succeeds while the opponents are in possession and only the team's attacker can be at the ball sooner.

    The robots of a team share one plan, which says who attacks and which team is in possession.
    """

    reads = ("team",)
    writes = ("team",)

    def on_running(self) -> Status:
        """Compare the times of the robots without the attacker."""
        team = self.store.team
        plan = agree(self.frame, team)
        if plan.ours:
            return self.fail("the team is in possession")
        rest = [(time, number) for number, time in plan.own_times.items() if number != team.attacker]
        return self.succeed() if min(rest, default=(0.0, -1))[1] == self.me.id else self.fail("another is")
