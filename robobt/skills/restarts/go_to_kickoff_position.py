"""Line up for a kick-off."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.state import ROBOT_RADIUS

_CENTRE_CIRCLE_GAP = 0.1


@skill
class GoToKickoffPosition(Skill):
    """Line up in the own half outside the centre circle, spread over the field's width.

    The robots that go for the ball in open play share the line in order of their numbers; the robot that
    takes the kick-off is left out. Never ends by itself.

    Args:
        spread: share of the field's width that the line covers.
        spare_mates: drive gently near team-mates, and face the ball only roughly.
    """

    reads = ("team",)

    spread: float = 0.6
    spare_mates: bool = False

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame, me, team = self.frame, self.me, self.store.team
        field = frame.field
        taker = team.attacker if frame.game.restart_team is frame.team else None
        line = sorted({*team.attackers, me.id} - {taker})
        share = (line.index(me.id) + 0.5) / len(line) - 0.5
        x = -(field.center_radius + 2.0 * ROBOT_RADIUS + _CENTRE_CIRCLE_GAP)
        target = (x, -share * self.spread * field.width)
        gently = self.spare_mates
        self.drive_to(target, (0.0, 0.0), thereabouts=gently, spare_mates=gently)
        return self.run("lining up")
