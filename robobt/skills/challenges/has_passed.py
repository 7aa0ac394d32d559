"""Has this robot kicked the ball away?"""

from __future__ import annotations

from dataclasses import field

from robobt.skills.base import Condition, skill
from robobt.skills.challenges.mate_has_kicked import KICKED_AWAY
from robobt.tree import Status
from robobt.world.geometry import distance


@skill
class HasPassed(Condition):
    """Succeeds once this robot has kicked the ball away."""

    _passed: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Look for a ball that has left this robot."""
        last = self.frame.last_touch
        if last is not None and last == (self.frame.team, self.me.id):
            self._passed |= distance(self.me.position, self.ball.position) > KICKED_AWAY
        return self.succeed() if self._passed else self.fail("not yet")
