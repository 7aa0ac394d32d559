"""Does the mouth point at the target?"""

from __future__ import annotations

from math import radians

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.geometry import Point, direction, wrap_angle


@skill
class FacesTarget(Condition):
    """Succeeds while the mouth points at the target; fails without one.

    Args:
        target: what to face [m]; None takes ``store.target``.
        tolerance: largest angle that counts as facing it [rad].
    """

    reads = ("target",)

    target: Point | None = None
    tolerance: float = radians(5.0)

    def on_running(self) -> Status:
        """Compare the heading."""
        target = self.store.target if self.target is None else self.target
        if target is None:
            return self.fail("no target")
        error = wrap_angle(direction(self.me.position, target) - self.me.heading)
        return self.succeed() if abs(error) <= self.tolerance else self.fail("it faces elsewhere")
