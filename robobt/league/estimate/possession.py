"""Who touches, has or carries the ball, judged by positions and break-beam sensors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import cos, hypot, inf, sin

from robobt.league.estimate.ball_track import BallMotion
from robobt.league.estimate.robot_track import RobotMotion
from robobt.sim.robot_settings import BodySettings
from robobt.world.geometry import to_robot_frame
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, RobotId

_MOUTH_SLACK = 0.004
"""Addition to the depth at which the ball counts as in the mouth, for the estimate's error [m]."""

_HOLD_SLACK, _HOLD_SPEED = 0.012, 0.5
"""A ball this close to the mouth and this slow relative to it is carried [m, m/s]."""

_PARTED = 0.03
"""Robots that hold one ball have parted when it would be this far apart from itself: one has lost it [m]."""

_SEEN_TOUCH_GAP = 0.006
"""Gap between hull and ball that counts as a touch [m]."""

_PUSH_GAP = 0.05
"""Gap between hull and ball within which the robot may change the ball's motion [m]."""

_FEEDBACK_REACH = 0.05
"""A robot's break-beam sensor is trusted while the ball is seen this close to its mouth [m]."""

_BOUNCES_FOR = 0.07
"""A sensor may be silent for this long while the ball bounces on the dribbler [s]."""

_HIDDEN_REACH = 0.3
"""A robot whose sensor reports a ball that no camera sees has it, if it may be so far from the mouth [m]."""

_OVERLAP = 0.01
"""A ball that no camera sees is not believed this deep in a hull: a robot has pushed it on [m]."""


@dataclass(slots=True)
class CarriedBall:
    """A robot that carries the ball, and the ball's place in that robot's frame [m]."""

    robot: RobotId
    ahead: float
    aside: float

    def ball(self, m: RobotMotion) -> BallMotion:
        """Return the motion of the carried ball, given that of the robot."""
        c, s = cos(m.heading), sin(m.heading)
        dx, dy = c * self.ahead - s * self.aside, s * self.ahead + c * self.aside
        return BallMotion(m.x + dx, m.y + dy, m.vx - m.omega * dy, m.vy + m.omega * dx)


class Possession:
    """Decides who has the ball.

    Attributes:
        holds: the robots that carry the ball: none, one, or several at once.
        last_touch: the robot that touched the ball last, None before the first touch.
        feedback: last report of each robot's break-beam sensor.
    """

    def __init__(self, body: BodySettings) -> None:
        self._body = body
        self.holds: list[CarriedBall] = []
        self.last_touch: RobotId | None = None
        self.feedback: dict[RobotId, bool] = {}
        self._reported: dict[RobotId, float] = {}
        self._now = -inf

    def hear(self, reports: Iterable[tuple[RobotId, bool]], time: float) -> None:
        """Take in what the sensors report at a ``time`` [s]."""
        self._now = time
        for robot, contact in reports:
            self.feedback[robot] = contact
            if contact:
                self._reported[robot] = time

    def update(self, ball: BallMotion, motions: Mapping[RobotId, RobotMotion]) -> None:
        """Update possession from the estimates at the ball's last detection."""
        self.holds = []
        reach = ROBOT_RADIUS + BALL_RADIUS + _SEEN_TOUCH_GAP
        for robot, m in motions.items():
            if hypot(ball.x - m.x, ball.y - m.y) > reach:
                continue
            self.last_touch = robot
            ahead, aside = to_robot_frame(ball.x - m.x, ball.y - m.y, m.heading)
            # The mouth's velocity at the ball.
            vx, vy = m.vx - m.omega * (ball.y - m.y), m.vy + m.omega * (ball.x - m.x)
            slow = hypot(ball.vx - vx, ball.vy - vy) < _HOLD_SPEED
            if slow and self._in_mouth(ahead, aside, _HOLD_SLACK):
                self.holds.append(CarriedBall(robot, ahead, aside))

    def carried(self, motions: Mapping[RobotId, RobotMotion]) -> BallMotion | None:
        """Return the motion of the ball given the robots' motions; None if no robot carries it.

        With several holders the mean of their predictions is used. If they part while the ball is not seen,
        the ball stays with those whose sensors report it, or with none if no sensor reports.
        """
        holders = [hold for hold in self.holds if hold.robot in motions]
        balls = [hold.ball(motions[hold.robot]) for hold in holders]
        if _apart(balls) > _PARTED:
            balls = [ball for hold, ball in zip(holders, balls, strict=True) if self.feedback.get(hold.robot)]
        if not balls or _apart(balls) > _PARTED:
            return None
        x, y, vx, vy = (
            sum(part) / len(balls)
            for part in zip(*((ball.x, ball.y, ball.vx, ball.vy) for ball in balls), strict=True)
        )
        return BallMotion(x, y, vx, vy)

    def update_unseen(self, ball: BallMotion, motions: Mapping[RobotId, RobotMotion]) -> BallMotion | None:
        """Update possession of a ball that no camera has seen for some time, by sensors and hulls.

        A robot often hides the ball that it takes, and goes on over the place where the ball was seen last.

        Args:
            ball: as it is predicted.
            motions: the robots at that time.

        Returns:
            The ball as it has to be: in the mouth of the robot whose sensor reports it, or pushed out of a
            hull; None where neither says more than the prediction.
        """
        self.holds = [hold for hold in self.holds if self._may_hold(hold.robot)]
        if self.holds:
            return None
        depth = self._body.face + BALL_RADIUS
        nearest, taker = _HIDDEN_REACH, None
        for robot, m in motions.items():
            ahead, aside = to_robot_frame(ball.x - m.x, ball.y - m.y, m.heading)
            away = hypot(ahead - depth, aside)
            if self.feedback.get(robot) and away < nearest:
                nearest, taker = away, CarriedBall(robot, depth, 0.0)
        if taker is not None:
            self.holds, self.last_touch = [taker], taker.robot
            return taker.ball(motions[taker.robot])
        for robot, m in motions.items():
            ahead, aside = to_robot_frame(ball.x - m.x, ball.y - m.y, m.heading)
            before = ahead > 0.0 and abs(aside) < self._body.mouth_width / 2
            gap = ahead - depth if before else hypot(ahead, aside) - ROBOT_RADIUS - BALL_RADIUS
            if gap > -_OVERLAP:
                continue
            out = 1.0 - gap / max(hypot(ahead, aside), BALL_RADIUS)
            pushed = (depth, aside) if before else (out * ahead, out * aside)
            return CarriedBall(robot, *pushed).ball(m)
        return None

    def has_ball(self, robot: RobotId, m: RobotMotion, ball: BallMotion) -> bool:
        """Return whether a robot has the ball, by its sensor where that is plausible."""
        ahead, aside = to_robot_frame(ball.x - m.x, ball.y - m.y, m.heading)
        reported = self.feedback.get(robot)
        if reported is not None and self._in_mouth(ahead, aside, _FEEDBACK_REACH):
            return reported or (self._may_hold(robot) and self._in_mouth(ahead, aside, _HOLD_SLACK))
        return self._in_mouth(ahead, aside, _MOUTH_SLACK)

    def _may_hold(self, robot: RobotId) -> bool:
        """Return whether the sensor reports the ball, has been silent for a moment only, or never reports."""
        if self.feedback.get(robot) is not False:
            return True
        return self._now - self._reported.get(robot, -inf) < _BOUNCES_FOR

    def _in_mouth(self, ahead: float, aside: float, slack: float) -> bool:
        body = self._body
        depth = body.face + BALL_RADIUS + body.sensor_depth + slack
        return 0.0 < ahead <= depth and abs(aside) <= body.mouth_width / 2


def _apart(balls: list[BallMotion]) -> float:
    """Return the distance from the first place to the farthest one [m]."""
    return max((hypot(ball.x - balls[0].x, ball.y - balls[0].y) for ball in balls), default=0.0)


def near_robot(ball: BallMotion, motions: Mapping[RobotId, RobotMotion]) -> bool:
    """Return whether a robot is close enough to push or kick the ball."""
    reach = ROBOT_RADIUS + BALL_RADIUS + _PUSH_GAP
    return any(hypot(ball.x - m.x, ball.y - m.y) < reach for m in motions.values())


def stop_at_robots(
    before: BallMotion, after: BallMotion, motions: Mapping[RobotId, RobotMotion]
) -> BallMotion:
    """Return a predicted ball, stopped at the first robot in its way."""
    reach = ROBOT_RADIUS + BALL_RADIUS
    dx, dy = after.x - before.x, after.y - before.y
    way = dx * dx + dy * dy
    if way < 1e-8:
        return after
    first, met = 1.0, None
    for m in motions.values():
        ox, oy = before.x - m.x, before.y - m.y
        outside = ox * ox + oy * oy - reach * reach
        along = ox * dx + oy * dy
        root = along * along - way * outside
        if outside <= 0.0 or along >= 0.0 or root < 0.0:
            continue
        share = (-along - root**0.5) / way
        if share < first:
            first, met = share, m
    if met is None:
        return after
    return BallMotion(before.x + dx * first, before.y + dy * first, met.vx, met.vy)
