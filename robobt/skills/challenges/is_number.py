"""Is this the robot of that number?"""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class IsNumber(Condition):
    """Succeeds for the robot with this number.

    Args:
        number: the robot's number.
    """

    number: int = 0

    def on_running(self) -> Status:
        """Compare the number."""
        return self.succeed() if self.me.id == self.number else self.fail(f"it is number {self.me.id}")
