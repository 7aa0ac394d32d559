"""Stand in the way of a rolling ball and let it come."""

from __future__ import annotations

from math import atan2, hypot

from robobt.skills.ball_model import DEFAULT_BALL, BallModel
from robobt.skills.base import Skill, skill
from robobt.skills.path_planner import allowed_target, travel
from robobt.skills.pilot import travel_time
from robobt.skills.possession import has_ball
from robobt.tree import Status
from robobt.world.geometry import Point
from robobt.world.state import BALL_RADIUS, Frame

_FRONT = 0.075 + BALL_RADIUS
"""From the robot's centre to the ball it takes [m]."""

_NEAR = 0.03
"""So far off the place the mouth still takes the ball [m]."""

_STEP = 0.2
_DRIBBLER_FROM = 1.0


@skill
class ReceiveBall(Skill):
    """Drive to the first place on the ball's way where the robot can be well before the ball, and wait there.

    The place is kept while the robot can still make it, and moves with the ball's
    line, so the robot neither runs along with the ball nor away from it. SUCCESS
    when the ball is in the mouth; FAILURE when the robot cannot get in its way,
    and while the ball is slower than ``slowest``.

    Args:
        ahead: how long before the ball it wants to be there [s].
        slowest: a slower ball is to be gone to, not waited for [m/s].
        ball: how the ball rolls.
    """

    def __init__(
        self,
        *,
        ahead: float = 0.05,
        slowest: float = 0.3,
        ball: BallModel = DEFAULT_BALL,
        name: str = "",
    ) -> None:
        super().__init__(name)
        self.ahead = ahead
        self.slowest = slowest
        self.rolling = ball
        self._place: Point | None = None

    def on_start(self) -> None:
        """Forget the last ball."""
        self._place = None

    def on_running(self) -> Status:
        """Keep the place or find one, and drive there."""
        frame, me, ball = self.frame, self.me, self.ball
        if has_ball(me, ball):
            self.store.command.dribbler = True
            return self.succeed("it has the ball")
        speed = ball.speed
        if speed < self.slowest:
            return self.fail("the ball is slow")
        ux, uy = ball.vx / speed, ball.vy / speed
        way = self._way(frame, ux, uy, speed)
        if way is None:
            return self.fail("it cannot get in the ball's way")
        self._place = place = (ball.x + way * ux, ball.y + way * uy)
        heading = atan2(ball.y - me.y, ball.x - me.x)
        # From beside or behind the ball the way there must not lead through it.
        abreast = (me.x - ball.x) * ux + (me.y - ball.y) * uy
        self.store.command = travel(frame, me, place, heading, me.limits, avoid_ball=abreast < _FRONT)
        self.store.command.dribbler = hypot(ball.x - me.x, ball.y - me.y) < _DRIBBLER_FROM
        return self.run("waiting for the ball")

    def _way(self, frame: Frame, ux: float, uy: float, speed: float) -> float | None:
        """How far along the ball's way the robot's place is [m]."""
        ball, me = frame.ball, self.me
        if self._place is not None:
            kept = (self._place[0] - ball.x) * ux + (self._place[1] - ball.y) * uy
            if kept > 0.0 and self._slack(kept, ux, uy, speed) > -self.ahead:
                return kept
        abreast = (me.x - ball.x) * ux + (me.y - ball.y) * uy
        way = max(abreast, _FRONT + 0.05)
        most = _FRONT + speed * speed / (2.0 * self.rolling.roll_deceleration)
        while way < most:
            x, y = ball.x + way * ux, ball.y + way * uy
            if not frame.field.contains(x, y):
                return None
            if self._slack(way, ux, uy, speed) >= self.ahead and allowed_target(frame, me, (x, y)) == (x, y):
                return way
            way += _STEP
        return None

    def _slack(self, way: float, ux: float, uy: float, speed: float) -> float:
        """How long before the ball the robot is at the place [s]."""
        me, ball = self.me, self.ball
        dx, dy = ball.x + way * ux - me.x, ball.y + way * uy - me.y
        gap = max(0.0, hypot(dx, dy) - _NEAR)
        towards = (me.vx * dx + me.vy * dy) / gap if gap > 0.0 else 0.0
        return (way - _FRONT) / speed - travel_time(gap, towards, me.limits)
