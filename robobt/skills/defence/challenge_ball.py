"""Stand in the way of the opponent that has the ball."""

from __future__ import annotations

from math import cos, sin

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.rules import owner
from robobt.world.state import ROBOT_RADIUS


@skill
class ChallengeBall(Skill):
    """Stand in front of the opponent that has the ball, on the line of its heading.

    FAILURE while no opponent has the ball; otherwise it never ends by itself.

    Source: RoboBulls' published code (ChallengeBallBot), three radii beyond the ball.

    Args:
        gap: distance from the ball to the robot's centre [m].
    """

    gap: float = 3.0 * ROBOT_RADIUS

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame, ball = self.frame, self.ball
        who = owner(frame)
        if who is None or who.team is frame.team:
            return self.fail("no opponent has the ball")
        holder = next(robot for robot in frame.opponents if robot.id == who.number)
        target = (ball.x + self.gap * cos(holder.heading), ball.y + self.gap * sin(holder.heading))
        self.drive_to(target, ball.position, avoid_ball=True)
        return self.run(f"before {holder.id}")
