"""Condition: this robot has carried the ball nearly as far as the rules allow."""

from __future__ import annotations

from dataclasses import field
from math import hypot, inf

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.geometry import Point
from robobt.world.records import Ball
from robobt.world.rules import has_ball, keeps_ball, touches
from robobt.world.state import RobotId

LETTING_GO = 0.15
"""Time that a robot needs to release the ball [s]."""


@skill
class CarriedFar(Condition):
    """SUCCESS while the robot has the ball and has carried it ``limit`` or farther.

    The distance is the straight line from where it got the ball, as referees measure it; they allow 1 m. The
    count ends when another robot touches the ball or when the robot no longer keeps it
    (:func:`robobt.world.rules.keeps_ball`), so the distance that the ball rolls while the robot brakes away
    from it counts too. Tick it in every tick; a pause resets the count.

    Args:
        limit: carried distance from which it succeeds [m].
    """

    limit: float = 0.8
    _start: Point | None = field(default=None, init=False)
    _seen: float = field(default=-inf, init=False)

    def on_running(self) -> Status:
        """Measure."""
        frame, ball = self.frame, self.ball
        paused = not 0.0 <= frame.time - self._seen < 2.5 * frame.period
        self._seen = frame.time
        touched = frame.last_touch
        if touched is not None and touched != RobotId(frame.team, self.me.id):
            self._start = None
            return self.fail("another robot has touched it")
        if not keeps_ball(self.me, ball):
            self._start = None
            return self.fail("it has no ball")
        if self._start is None or paused:
            if not (touches(self.me, ball) or has_ball(self.me, ball)):
                return self.fail("it has no ball yet")
            self._start = ball.position
        way = way_carried(ball, *self._start)
        if way < self.limit:
            return self.fail(f"{way:.2f} m")
        return self.succeed(f"{way:.2f} m")


@compilable
def way_carried(ball: Ball, x: float, y: float) -> float:
    """Return how far from (x, y) the ball will have been carried when the robot has let it go [m]."""
    return hypot(ball.x - x, ball.y - y) + LETTING_GO * hypot(ball.vx, ball.vy)
