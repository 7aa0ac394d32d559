"""Get between the ball and its expected target."""

from __future__ import annotations

from dataclasses import field
from math import cos, hypot, sin, sqrt

from robobt.motion.ball_watch import BallWatch
from robobt.motion.pilot import drive, stop_time
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.ball_model import time_for
from robobt.world.compiled import compilable
from robobt.world.geometry import Point, closest_point_on_segment, direction, distance
from robobt.world.records import Ball, Robot

_NO_DIVE_SPEED = 0.5
"""Slowest ball for which the robot dives [m/s]."""

_BLOCKING_DISTANCE = 0.04
"""Distance from the line within which the robot stops the ball with its front [m]."""


@skill
class BlockShot(DrivingSkill):
    """Drive to the nearest point of the line from the ball to the store's ``target``, facing the ball.

    Never ends by itself; FAILURE without a target. It avoids no obstacles, because there is no time to. A
    robot that cannot stop on the line before the ball arrives dives instead: it drives through the line
    without braking.

    Source: RoboBulls' published code, Goalie, which always brakes.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        dribbler: whether to catch the ball with the dribbler.
        dive: whether it may drive through the line without braking.
        offset: distance beside the line, to the left in the ball's direction [m].
    """

    reads = ("target",)

    dribbler: bool = True
    dive: bool = True
    offset: float = 0.0
    _watch: BallWatch = field(default_factory=BallWatch, init=False)

    def on_running(self) -> Status:
        """Drive to the line for one tick."""
        target = self.store.target
        if target is None:
            return self.fail("no target to block the way to")
        me, ball, limits, model = self.me, self.ball, self.drive_limits, self.frame.ball_model
        place = blocking_place(me, ball, target, self.offset)
        final_speed = 0.0
        if self.dive:
            slide, roll = model.slide_deceleration, model.roll_deceleration
            rolling = self._watch.rolling_speed(self.frame)
            pace = (limits.max_speed, limits.acceleration, limits.braking)
            final_speed = dive_speed(me, ball, place, rolling, pace, slide, roll)
        facing = direction(me.position, ball.position)
        self.store.command = drive(me, place, facing, limits, self.frame.period, final_speed)
        self.store.command.dribbler = self.dribbler
        return self.run("diving" if final_speed > 0.0 else "to the line of the shot")


@compilable
def blocking_place(me: Robot, ball: Ball, target: Point, offset: float) -> Point:
    """Return the nearest point of the line from the ball to ``target`` [m], or one ``offset`` beside it."""
    there = (ball.x, ball.y)
    x, y = closest_point_on_segment((me.x, me.y), there, target)
    if offset != 0.0:
        course = direction(there, target)
        x, y = x - offset * sin(course), y + offset * cos(course)
    return x, y


@compilable
def dive_speed(
    me: Robot,
    ball: Ball,
    place: Point,
    rolling: float,
    pace: tuple[float, float, float],
    slide: float,
    roll: float,
) -> float:
    """Return the lowest speed at ``place`` with which a robot arrives before the ball [m/s].

    Args:
        me: the robot.
        ball: the ball.
        place: target of the robot [m].
        rolling: speed below which the ball rolls [m/s].
        pace: top speed, acceleration and braking of the robot [m/s, m/s^2, m/s^2].
        slide: deceleration of the ball while it slides [m/s^2].
        roll: deceleration of the ball while it rolls [m/s^2].
    """
    top, acceleration, braking = pace
    here, speed = (me.x, me.y), hypot(ball.vx, ball.vy)
    gap = distance(here, place)
    if speed < _NO_DIVE_SPEED or gap < _BLOCKING_DISTANCE:
        return 0.0
    time = time_for(distance((ball.x, ball.y), place), speed, rolling, slide, roll)
    towards = (me.vx * (place[0] - here[0]) + me.vy * (place[1] - here[1])) / gap
    least, most = 0.0, top
    if _in_time_braking(gap - _BLOCKING_DISTANCE, towards, time, braking) or (
        _time_through(gap, towards, least, top, acceleration, braking) <= time
    ):
        return 0.0
    for _ in range(6):
        middle = 0.5 * (least + most)
        if _time_through(gap, towards, middle, top, acceleration, braking) <= time:
            most = middle
        else:
            least = middle
    return most


@compilable
def _time_through(
    gap: float, towards: float, final_speed: float, top: float, acceleration: float, braking: float
) -> float:
    """Compute the time to cover ``gap`` and arrive at ``final_speed`` [s]."""
    slowing = final_speed / braking
    return stop_time(gap + 0.5 * final_speed * slowing, towards, acceleration, braking, top) - slowing


@compilable
def _in_time_braking(gap: float, towards: float, time: float, braking: float) -> bool:
    """Return whether a robot that brakes from now on covers ``gap`` within ``time``."""
    left = towards * towards - 2.0 * braking * gap
    return towards > 0.0 and left >= 0.0 and towards - sqrt(left) <= braking * time
