"""Stand where a pass from the mate with the ball arrives and no opponent is near."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.skills.restarts.prepare_restart import IN_OWN_HALF
from robobt.skills.tactics.agree import agree
from robobt.skills.tactics.keeping import KeepingPlaces
from robobt.tree import Status
from robobt.world.game import Restart


@skill
class ShowForPass(Skill):
    """Drive to a place where the team keeps the ball with a pass, facing the ball; never ends by itself.

    The robots without the ball share out places around it, 1.3 to 3.5 m away and apart from each other. Until
    a kick-off is taken they stay in their own half.
    """

    reads = ("team",)
    writes = ("team",)

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame, team = self.frame, self.store.team
        plan = agree(frame, team)
        places = team.shared(KeepingPlaces)
        places.follow(frame, team, plan)
        intended = plan.next_pass
        place = places.places.get(self.me.id)
        if intended is not None and intended.receiver == self.me.id:
            place = intended.target
        if place is None:
            return self.fail("no place")
        if frame.game.restart is Restart.KICKOFF:
            place = (min(place[0], -IN_OWN_HALF), place[1])
        self.drive_to(place, frame.ball.position, avoid_ball=True, thereabouts=True, spare_mates=True)
        return self.run(f"to ({place[0]:.1f}, {place[1]:.1f})")
