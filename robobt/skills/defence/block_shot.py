"""Get between the ball and the point it would go to."""

from __future__ import annotations

from dataclasses import field
from math import cos, sin, sqrt

from robobt.motion.ball_watch import BallWatch
from robobt.motion.pilot import drive, stop_time
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.ball_model import time_for
from robobt.world.compiled import compilable
from robobt.world.geometry import Point, closest_point_on_segment, direction, distance
from robobt.world.limits import RobotLimits

_SLOW = 0.5
"""The robot does not dive for a slower ball [m/s]."""

_THERE = 0.04
"""A robot this near to the line stops the ball with its front [m]."""


@skill
class BlockShot(DrivingSkill):
    """Drive to the nearest point of the line from the ball to the store's ``target``, facing the ball.

    Never ends by itself; FAILURE without a target. Avoids nothing: there is no
    time to. A robot that cannot stop on the line before the ball is there does
    not try to: it dives, that is, it drives through.

    Source: RoboBulls' published code, Goalie, which always brakes.

    Args:
        limits: how to drive; None for the robot's own.
        speed: factor on the top speed.
        dribbler: whether to catch the ball with the dribbler.
        dive: whether it may drive through.
        offset: how far beside the line it takes its place, to the left as the ball flies [m].
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
        me, ball = self.me, self.ball
        place = closest_point_on_segment(me.position, ball.position, target)
        if self.offset != 0.0:
            course = direction(ball.position, target)
            place = (place[0] - self.offset * sin(course), place[1] + self.offset * cos(course))
        limits = self.drive_limits
        final_speed = self._dive_speed(place, limits) if self.dive else 0.0
        facing = direction(me.position, ball.position)
        self.store.command = drive(me, place, facing, limits, self.frame.period, final_speed)
        self.store.command.dribbler = self.dribbler
        return self.run("diving" if final_speed > 0.0 else "to the line of the shot")

    def _dive_speed(self, place: Point, limits: RobotLimits) -> float:
        """Return the least speed at ``place`` with which the robot is there before the ball [m/s]."""
        me, ball, model = self.me, self.ball, self.frame.ball_model
        return dive_speed(
            me.position,
            (me.vx, me.vy),
            place,
            ball.position,
            ball.speed,
            self._watch.rolling_speed(self.frame),
            limits.max_speed,
            limits.acceleration,
            limits.braking,
            model.slide_deceleration,
            model.roll_deceleration,
        )


@compilable
def dive_speed(
    here: Point,
    velocity: Point,
    place: Point,
    ball: Point,
    speed: float,
    rolling: float,
    top: float,
    acceleration: float,
    braking: float,
    slide: float,
    roll: float,
) -> float:
    """Return the least speed at ``place`` with which a robot is there before the ball [m/s].

    Args:
        here: where the robot is [m].
        velocity: its velocity [m/s].
        place: where it is to be [m].
        ball: where the ball is [m].
        speed: of the ball [m/s].
        rolling: below which the ball rolls [m/s].
        top: how fast the robot drives at most [m/s].
        acceleration: how fast it speeds up [m/s^2].
        braking: how fast it slows down [m/s^2].
        slide: deceleration of the ball while it slides [m/s^2].
        roll: the same while it rolls [m/s^2].
    """
    gap = distance(here, place)
    if speed < _SLOW or gap < _THERE:
        return 0.0
    time = time_for(distance(ball, place), speed, rolling, slide, roll)
    towards = (velocity[0] * (place[0] - here[0]) + velocity[1] * (place[1] - here[1])) / gap
    least, most = 0.0, top
    if _in_time_braking(gap - _THERE, towards, time, braking) or (
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
