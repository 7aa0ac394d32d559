"""Choose a team-mate to clear the ball to."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.skills.store import Pass
from robobt.tree import Status
from robobt.world.geometry import distance, segment_distance
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, RobotState

_RECEIVED_SPEED = 1.0
_MAX_CLEARANCE_SPEED = 6.0


@skill
class SelectClearance(Skill):
    """Write to ``pass_`` the foremost team-mate that the ball can reach, and set ``shot`` to None.

    A team-mate counts if it is at least a third of the own half away from our goal line and no other robot
    stands in the lane. FAILURE without one, and ``pass_`` is None.

    Source: RoboBulls' published code, Goalie, which counts team-mates beyond
    x = -1.5 m on a 9 m field.

    Args:
        lane: half width of a lane that is free [m].
    """

    writes = ("pass_", "shot")

    lane: float = ROBOT_RADIUS + BALL_RADIUS + 0.03

    def on_running(self) -> Status:
        """Go through the team-mates from the front."""
        store, frame, ball = self.store, self.frame, self.ball.position
        store.shot = store.pass_ = None
        mates = [mate for mate in frame.teammates(self.me.id) if mate.x > -frame.field.half_length / 3]
        mates.sort(key=lambda mate: -mate.x)
        for mate in mates:
            if self._free(mate):
                speed = frame.ball_model.kick_speed(distance(ball, mate.position), _RECEIVED_SPEED)
                store.pass_ = Pass(mate.id, mate.position, min(speed, _MAX_CLEARANCE_SPEED), 1.0)
                return self.succeed(f"to {mate.id}")
        return self.fail("no team-mate can be reached")

    def _free(self, mate: RobotState) -> bool:
        ball = self.ball.position
        return all(
            segment_distance(other.position, ball, mate.position) >= self.lane
            for other in self.frame.others(self.me.id)
            if other is not mate
        )
