"""Has a mate kicked the ball away?"""

from __future__ import annotations

from dataclasses import field

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.geometry import distance

KICKED_AWAY = 0.3
"""A ball this far from the robot that touched it last has left it [m]."""


@skill
class MateHasKicked(Condition):
    """Succeeds from the moment that a mate has kicked the ball away."""

    _kicked: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Look for a ball that has left the mate that touched it last."""
        last = self.frame.last_touch
        if last is not None and last.team is self.frame.team and last.number != self.me.id:
            mate = self.frame.robot(last.number)
            if mate is not None and distance(mate.position, self.ball.position) > KICKED_AWAY:
                self._kicked = True
        return self.succeed() if self._kicked else self.fail("no mate has kicked yet")
