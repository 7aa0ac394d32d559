"""Condition: the ball rolls this robot's way."""

from __future__ import annotations

from robobt.motion.pilot import travel_time
from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.rules import has_ball
from robobt.world.state import ROBOT_RADIUS, TOUCH_DISTANCE


@skill
class BallComing(Condition):
    """SUCCESS while the ball rolls towards this robot and the robot can reach its line in time.

    FAILURE for a ball that has passed or passes too far away, which has to be chased instead, and while the
    robot has the ball.

    Args:
        slowest: least ball speed that counts as coming [m/s].
        late: how late the robot may be [s]; it then takes the ball a little farther along its line.
    """

    slowest: float = 0.4
    late: float = 0.2

    def on_running(self) -> Status:
        """Compare the ball's time to the point level with the robot with the robot's time to that point."""
        me, ball = self.me, self.ball
        speed = ball.speed
        if speed < self.slowest:
            return self.fail("the ball is slow")
        if has_ball(me, ball):
            return self.fail("it has the ball")
        dx, dy = me.x - ball.x, me.y - ball.y
        ahead = (dx * ball.vx + dy * ball.vy) / speed
        aside = (dy * ball.vx - dx * ball.vy) / speed
        if ahead < TOUCH_DISTANCE:
            return self.fail("the ball has passed")
        towards = (me.vx * ball.vy - me.vy * ball.vx) / speed * (1.0 if aside > 0.0 else -1.0)
        needed = travel_time(max(0.0, abs(aside) - ROBOT_RADIUS), towards, me.limits)
        if needed > ahead / speed + self.late:
            return self.fail("the ball passes too far off")
        return self.succeed("the ball comes")
