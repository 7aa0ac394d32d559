"""Drive straight at a point."""

from __future__ import annotations

from robobt.motion.pilot import command
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import Point, distance


@skill
class DriveStraight(Skill):
    """Drive straight at a point at full speed, whatever is in the way.

    Args:
        target: the point [m]; None takes ``store.target``.
    """

    reads = ("target",)

    target: Point | None = None

    def on_running(self) -> Status:
        """Drive one tick."""
        me, limits = self.me, self.me.limits
        target = self.store.target if self.target is None else self.target
        if target is None:
            return self.fail("no target")
        share = limits.max_speed / max(distance(me.position, target), 1e-6)
        vx, vy = share * (target[0] - me.x), share * (target[1] - me.y)
        self.store.command = command(me, vx, vy, 0.0, limits, self.frame.period)
        return self.run("straight on")
