"""Where a ball will be when the next commands take effect, after robots have met it on its way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, hypot, inf, sin
from typing import NamedTuple

from robobt.world.ball_model import DEFAULT_BALL, GRAVITY, BallModel
from robobt.world.command import RobotCommand
from robobt.world.geometry import wrap_angle
from robobt.world.rules import HELD_GAP
from robobt.world.state import BALL_RADIUS, RECEIVED_HEIGHT, TOUCH_DISTANCE, BallState, RobotId, RobotState

PLACE = 0.08 + BALL_RADIUS
"""Usual distance from a robot's centre to a ball at its flat front [m]."""

_BALL_STEP = 0.005
"""Longest step of a ball that may meet a robot [s]."""

_HALF_MOUTH = 0.04
"""Half of the usual width of a mouth [m]."""

_KICK_REACH = 0.005
"""Distance beyond its usual place at which a ball is kicked: fronts differ, and cameras err [m]."""

_RETURNED = 0.3
"""Share of its speed at which a ball bounces off a robot: between a front's and a hull's in the simulator."""

_COMING = TOUCH_DISTANCE + HELD_GAP + 1e-3
"""Distance from a robot's centre to a ball that it does not have yet [m]."""

_SURE_AFTER = 0.03
"""A kick is shown from this time after it should happen, as it may happen a little later [s]."""

STAND_STILL = RobotCommand()
"""The command of a robot that got none."""


class MetBall(NamedTuple):
    """A predicted ball.

    Attributes:
        ball: where it will be.
        touched: the robot that will have held or kicked it last, None if none will after now; one that it
            only bounces off does not count.
        kept: whether that robot will have it.
    """

    ball: BallState
    touched: RobotWay | None = None
    kept: bool = False


class RobotWay(NamedTuple):
    """A robot from where it was seen to where its next command moves it.

    Attributes:
        robot: its team and number.
        before, after: the robot at these two times.
        since, until: the two times [s].
        orders: its commands, each with the time from which it is in force [s]; the oldest first.
    """

    robot: RobotId
    before: RobotState
    after: RobotState
    since: float
    until: float
    orders: Sequence[tuple[float, RobotCommand]]

    def at(self, time: float) -> RobotState:
        """Return the robot at a time [s], on the straight way between its two states."""
        before, after = self.before, self.after
        if time >= self.until or self.until <= self.since:
            return after
        share = max(0.0, (time - self.since) / (self.until - self.since))
        return replace(
            after,
            x=before.x + share * (after.x - before.x),
            y=before.y + share * (after.y - before.y),
            heading=wrap_angle(before.heading + share * wrap_angle(after.heading - before.heading)),
        )

    def order(self, time: float) -> RobotCommand:
        """Return the command in force at a time [s]."""
        found = STAND_STILL
        for since, command in self.orders:
            if since > time:
                break
            found = command
        return found


def met_ball(
    ball: BallState,
    ways: Sequence[RobotWay],
    seen: float,
    now: float,
    until: float,
    model: BallModel = DEFAULT_BALL,
    holder: RobotWay | None = None,
) -> MetBall:
    """Return a ball as it will be.

    A robot that is about to kick sends the ball off; one that does not reach it too fast takes it; it bounces
    off all else.

    Args:
        ball: as it was seen; it is taken to roll.
        ways: the robots near it.
        seen: when that was [s].
        now: until when no robot has taken it, as their sensors say, and it is known who has touched it [s].
        until: time of the ball that is returned [s].
        model: how it rolls.
        holder: the robot that has it when it was seen.
    """
    ball = replace(ball)
    near = [way for way in ways if holder is not None or _may_meet(ball, way, until - seen)]
    time, rolls, touched = seen, inf, holder
    while time < until - 1e-9:
        if holder is not None:
            order = holder.order(time)
            if order.kick_speed > 0.0 and time <= until - _SURE_AFTER:
                robot = holder.at(time)
                ball = _in_mouth(robot)
                _kick(ball, robot, order)
                rolls = model.switch_share * ball.speed
                holder = None
        dt = min(_BALL_STEP, until - time) if near else until - time
        time += dt
        if holder is not None:
            continue
        _roll(ball, dt, rolls, model)
        if ball.z >= RECEIVED_HEIGHT:
            continue
        for way in near:
            robot, order = way.at(time), way.order(time)
            if not _meet(ball, robot, order.kick_speed * cos(order.kick_angle), takes=time > now):
                continue
            if order.kick_speed > 0.0:
                if time > until - _SURE_AFTER:
                    return MetBall(_before_mouth(ball, robot, way.after), touched)
                _kick(ball, robot, order)
                rolls = model.switch_share * ball.speed
                # Who has touched it until now is known.
                touched = way if time > now else touched
            else:
                holder = touched = way
                break
    if holder is not None:
        return MetBall(_in_mouth(holder.after), holder, kept=True)
    return MetBall(ball, touched)


def _roll(ball: BallState, time: float, rolls: float, model: BallModel) -> None:
    """Move a free ball on by a time [s]; it slides until it is as slow as ``rolls`` [m/s]."""
    ball.x += ball.vx * time
    ball.y += ball.vy * time
    if ball.z > 0.0 or ball.vz > 0.0:
        ball.z = max(ball.z + (ball.vz - 0.5 * GRAVITY * time) * time, 0.0)
        ball.vz = ball.vz - GRAVITY * time if ball.z > 0.0 else 0.0
        return
    speed = ball.speed
    if speed > 0.0:
        slower = model.slide_deceleration if speed > rolls else model.roll_deceleration
        share = max(0.0, 1.0 - slower * time / speed)
        ball.vx *= share
        ball.vy *= share


def _may_meet(ball: BallState, way: RobotWay, time: float) -> bool:
    """Return whether the straight ways of ball and robot come close to each other."""
    half_x, half_y = 0.5 * ball.vx * time, 0.5 * ball.vy * time
    way_x, way_y = 0.5 * (way.after.x - way.before.x), 0.5 * (way.after.y - way.before.y)
    apart = hypot(ball.x + half_x - way.before.x - way_x, ball.y + half_y - way.before.y - way_y)
    return apart < hypot(half_x, half_y) + hypot(way_x, way_y) + TOUCH_DISTANCE


def _meet(ball: BallState, robot: RobotState, kick_speed: float, *, takes: bool) -> bool:
    """Return whether a robot kicks or takes a ball that has come to it; else the ball bounces off.

    ``kick_speed`` is along the ground [m/s], 0 if the robot is not to kick.
    """
    dx, dy = ball.x - robot.x, ball.y - robot.y
    gap = hypot(dx, dy)
    if gap >= TOUCH_DISTANCE or gap == 0.0:
        return False
    c, s = cos(robot.heading), sin(robot.heading)
    ahead, aside = c * dx + s * dy, c * dy - s * dx
    vx, vy = ball.vx - robot.vx + robot.omega * dy, ball.vy - robot.vy - robot.omega * dx
    if ahead > 0.0 and abs(aside) < _HALF_MOUTH:
        closing = -(c * vx + s * vy)
        if ahead > PLACE:
            # One that leaves fast has been kicked before.
            return kick_speed > 0.0 and ahead < PLACE + _KICK_REACH and -closing < 0.5 * kick_speed
        nx, ny, inside = c, s, PLACE - ahead
        limits = robot.limits
        taken = limits.catch_speed if limits.receive_speed is None else limits.receive_speed
        if kick_speed > 0.0 or (takes and closing <= taken):
            return True
    else:
        nx, ny, inside = dx / gap, dy / gap, TOUCH_DISTANCE - gap
        closing = -(nx * vx + ny * vy)
    ball.x += nx * inside
    ball.y += ny * inside
    if closing > 0.0:
        ball.vx += (1.0 + _RETURNED) * closing * nx
        ball.vy += (1.0 + _RETURNED) * closing * ny
    return False


def _before_mouth(ball: BallState, met: RobotState, robot: RobotState) -> BallState:
    """Return a ball that comes on, just before the robot that is about to meet it has it."""
    c, s = cos(met.heading), sin(met.heading)
    aside = c * (ball.y - met.y) - s * (ball.x - met.x)
    c, s = cos(robot.heading), sin(robot.heading)
    x, y = robot.x + c * _COMING - s * aside, robot.y + s * _COMING + c * aside
    return replace(ball, x=x, y=y)


def _in_mouth(robot: RobotState) -> BallState:
    dx, dy = PLACE * cos(robot.heading), PLACE * sin(robot.heading)
    return BallState(robot.x + dx, robot.y + dy, robot.vx - robot.omega * dy, robot.vy + robot.omega * dx)


def _kick(ball: BallState, robot: RobotState, command: RobotCommand) -> None:
    """Send the ball off along the heading; what it keeps of its motion is the robot's to say."""
    limits, c, s = robot.limits, cos(robot.heading), sin(robot.heading)
    ahead, across = c * ball.vx + s * ball.vy, c * ball.vy - s * ball.vx
    along = command.kick_speed * cos(command.kick_angle)
    along += limits.carried * ahead if ahead > 0.0 else -limits.touch_returned * ahead
    front = c * robot.vy - s * robot.vx + robot.omega * PLACE
    aside = front + limits.touch_kept * (across - front)
    ball.x, ball.y = robot.x + c * PLACE, robot.y + s * PLACE
    ball.vx, ball.vy = c * along - s * aside, s * along + c * aside
    ball.vz = command.kick_speed * sin(command.kick_angle)
