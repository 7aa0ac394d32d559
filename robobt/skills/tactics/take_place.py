"""Drive to the place that the team's plan gives this robot."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.skills.tactics.agree import agree
from robobt.tree import Status

_FACING = 0.5
"""How far off the ball it looks at most: a pass takes longer than to turn by that [rad]."""


@skill
class TakePlace(Skill):
    """Drive to the place in the team's plan, facing the ball. FAILURE without one; never ends by itself."""

    reads = ("team",)
    writes = ("team",)

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame = self.frame
        place = agree(frame, self.store.team).places.get(self.me.id)
        if place is None:
            return self.fail("no place")
        self.drive_to(
            place, frame.ball.position, avoid_ball=True, thereabouts=True, slack=_FACING, spare_mates=True
        )
        return self.run(f"to ({place[0]:.1f}, {place[1]:.1f})")
