"""Take a ball close by into the mouth."""

from __future__ import annotations

from dataclasses import field
from math import atan2, cos, hypot, inf, pi, radians, sin

from robobt.motion.dribbling import holds_weakly, settle
from robobt.motion.pilot import command, turn_rate
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import RobotCommand
from robobt.world.compiled import compilable
from robobt.world.geometry import wrap_angle
from robobt.world.records import Ball, Robot
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState

LOST_DISTANCE = 0.3
"""A ball farther away is not picked up [m]."""


_WITHIN_MOUTH, _BEFORE_MOUTH = ROBOT_RADIUS + 0.004, radians(20.0)
"""A ball this near to the robot's centre [m] and this little off its heading [rad] lies in the mouth."""


def grab(me: RobotState, ball: BallState, speed: float, period: float) -> RobotCommand:
    """Creep onto the ball for one tick: turn to it and close in at ``speed``.

    The farther the ball is to the side, the slower the robot closes in, so that the ball meets the mouth and
    not the hull. If it is already faster and the ball lies in its mouth, a robot with a weak dribbler brakes,
    although the sensor is silent: it would push the ball on faster and faster.

    Args:
        me: the robot.
        ball: the ball.
        speed: closing speed [m/s].
        period: time until the next command [s].
    """
    if me.ball_contact or _pushes_on(me, ball, speed):
        return settle(me, period)
    bearing, vx, vy = creeping(me, ball, speed)
    omega = turn_rate(me, bearing, me.limits, period)
    chase = command(me, vx, vy, omega, me.limits, period)
    chase.dribbler = True
    return chase


def _pushes_on(me: RobotState, ball: BallState, speed: float) -> bool:
    """Return whether a robot with a weak dribbler, faster than ``speed`` [m/s], has the ball in its mouth."""
    if not holds_weakly(me.limits) or me.speed <= speed or ball.z > 0.0:
        return False
    dx, dy = ball.x - me.x, ball.y - me.y
    off = abs(wrap_angle(atan2(dy, dx) - me.heading))
    return dx * dx + dy * dy <= _WITHIN_MOUTH * _WITHIN_MOUTH and off < _BEFORE_MOUTH


@compilable
def creeping(me: Robot, ball: Ball, speed: float) -> tuple[float, float, float]:
    """Return the direction to the ball [rad] and the velocity of :func:`grab` [m/s]."""
    bearing = atan2(ball.y - me.y, ball.x - me.x)
    aside = abs(wrap_angle(bearing - me.heading))
    closing = speed * cos(min(2.0 * aside, 0.5 * pi))
    return bearing, ball.vx + closing * cos(bearing), ball.vy + closing * sin(bearing)


class Grip:
    """How long the ball has been in the mouth without a break."""

    def __init__(self) -> None:
        self._since = inf
        self._seen = -inf

    def held_for(self, frame: Frame, me: RobotState) -> float:
        """Return the seconds of unbroken contact up to this frame; negative without contact."""
        if not me.ball_contact:
            self._since = inf
            return -1.0
        if self._since == inf or not 0.0 <= frame.time - self._seen < 2.5 * frame.period:
            self._since = frame.time
        self._seen = frame.time
        return frame.time - self._since


@skill
class PickUpBall(Skill):
    """Creep onto a ball close by with the dribbler on, turning to it on the way.

    Succeeds when the ball has been in the mouth for ``settle`` seconds, fails
    when it is more than 0.3 m away.

    Source: the hand-coded state between the learned Go-To-Ball and Shoot in
    RoboBulls' published code, which creeps at 0.2 m/s.

    Args:
        speed: how much faster than the ball to drive [m/s], limited to the speed at which the robot's
            dribbler can take it; None takes that limit.
        settle: how long the ball has to stay in the mouth [s].
    """

    speed: float | None = 0.5
    settle: float = 0.05
    _grip: Grip = field(default_factory=Grip, init=False)

    def on_running(self) -> Status:
        """Creep for one tick."""
        me, ball = self.me, self.ball
        if hypot(ball.x - me.x, ball.y - me.y) > LOST_DISTANCE:
            return self.fail("the ball is too far away")
        takes = me.limits.catch_speed
        speed = takes if self.speed is None else min(self.speed, takes)
        self.store.command = grab(me, ball, speed, self.frame.period)
        if self._grip.held_for(self.frame, me) >= self.settle - 1e-9:
            return self.succeed("it has the ball")
        return self.run("creeping onto the ball")
