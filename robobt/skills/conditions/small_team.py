"""Condition: few robots of the own team are on the field."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class SmallTeam(Condition):
    """Succeeds while the own team has few robots on the field, the goalkeeper among them.

    Args:
        most: the most robots of a small team.
    """

    most: int = 3

    def on_running(self) -> Status:
        """Count the own robots."""
        count = len(self.frame.own)
        return self.succeed() if count <= self.most else self.fail(f"we are {count}")
