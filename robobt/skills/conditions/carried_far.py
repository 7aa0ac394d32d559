"""Condition: this robot has carried the ball nearly as far as the rules allow."""

from __future__ import annotations

from dataclasses import field
from math import hypot, inf

from robobt.motion.dribbling import holds_weakly
from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.geometry import Point
from robobt.world.records import Ball
from robobt.world.rules import KEPT_GAP, has_ball, keeps_ball, touches
from robobt.world.state import RobotId

LETTING_GO = 0.15
"""Time that a robot needs to release the ball [s]."""

_AWAY, _PAUSE = 0.15, 0.3
"""A ball that a weak dribbler loses is its own again within this time, and a pause as short as this one does
not end its carry [s]."""


@skill
class CarriedFar(Condition):
    """SUCCESS while the robot has the ball and has carried it ``limit`` or farther.

    The distance is the straight line from where it got the ball, as referees measure it; they allow 1 m. The
    count ends when another robot touches the ball or when the robot no longer keeps it
    (:func:`robobt.world.rules.keeps_ball`), so the distance that the ball rolls while the robot brakes away
    from it counts too. Tick it in every tick; a pause resets the count.

    A weak dribbler (:func:`~robobt.motion.dribbling.holds_weakly`) often loses the ball for a moment, or only
    seems to where frames are predicted, and a ball that it lets go rolls before the robot. There the count
    ends when the ball has been away for 0.15 s, a pause of up to 0.3 s does not reset it, and the distance
    until the robot no longer keeps the ball is added.

    Args:
        limit: carried distance from which it succeeds [m].
    """

    limit: float = 0.8
    _start: Point | None = field(default=None, init=False)
    _seen: float = field(default=-inf, init=False)
    _kept: float = field(default=-inf, init=False)
    _way: float = field(default=0.0, init=False)

    def on_running(self) -> Status:
        """Measure."""
        frame, ball, me = self.frame, self.ball, self.me
        weak = holds_weakly(me.limits)
        if not 0.0 <= frame.time - self._seen < (_PAUSE if weak else 2.5 * frame.period):
            self._start, self._kept = None, -inf
        self._seen = frame.time
        touched = frame.last_touch
        if touched is not None and touched != RobotId(frame.team, me.id):
            self._start = None
            return self.fail("another robot has touched it")
        if keeps_ball(me, ball):
            self._kept = frame.time
        elif not weak or frame.time - self._kept >= _AWAY:
            self._start = None
        if self._start is None and self._kept < frame.time:
            return self.fail("it has no ball")
        if self._start is None:
            if not (touches(me, ball) or has_ball(me, ball)):
                return self.fail("it has no ball yet")
            self._start = ball.position
            self._way = 0.0
        if self._kept == frame.time:
            self._way = way_carried(ball, *self._start) + (KEPT_GAP if weak else 0.0)
        if self._way < self.limit:
            return self.fail(f"{self._way:.2f} m")
        return self.succeed(f"{self._way:.2f} m")


@compilable
def way_carried(ball: Ball, x: float, y: float) -> float:
    """Return how far from (x, y) the ball will have been carried when the robot has let it go [m]."""
    return hypot(ball.x - x, ball.y - y) + LETTING_GO * hypot(ball.vx, ball.vy)
