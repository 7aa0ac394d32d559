"""Carry the ball somewhere."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, hypot, inf

from robobt.motion.dribbling import MAX_ACCELERATION, MAX_TURN, carrying_limits
from robobt.motion.path_planner import next_waypoint
from robobt.motion.pilot import approach_speed, command, turn_rate
from robobt.skills.ball.pick_up_ball import grab
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.records import Robot
from robobt.world.rules import has_ball

_GRACE = 0.15
"""The ball counts as lost once it has been out of the mouth for this long [s]."""
SLIPPED = 0.1
"""A ball that has been out of the mouth for this long, but lies before it, is taken again [s]."""
_RULE_MARGIN = 0.1
"""Distance before the dribbling limit at which the skill gives up, so that the ball is released in time
[m]."""
_OTHER_WAY = 0.6
"""Difference in direction from which a way counts as another one [rad]."""


@dataclass(slots=True)
class Course:
    """Which way a robot carries the ball [rad], and since when [s]."""

    way: float = 0.0
    since: float = -inf


@skill
class DribbleTo(Skill):
    """Carry the ball to a point in front of the robot, round other robots, gently enough to keep it.

    Succeeds when the ball is within ``tolerance`` of the target. Fails without a
    target, when the ball is lost, and when it has been carried as far as allowed.

    Args:
        target: point to carry the ball to [m]; None takes ``store.target``.
        tolerance: distance that counts as there [m].
        max_speed: top speed with the ball [m/s].
        max_turn: turning rate with the ball [rad/s].
        max_acceleration: acceleration with the ball, in any direction [m/s^2].
        max_distance: how far the ball may be carried from where it was taken [m];
            the rules allow 1 m. None for no limit.
        keep: how long it keeps its way after the planner proposes another; otherwise two similar ways
            alternate [s].

    Raises:
        ValueError: ``keep`` is negative.
    """

    reads = ("target",)

    target: Point | None = None
    tolerance: float = 0.3
    max_speed: float = 2.0
    max_turn: float = MAX_TURN
    max_acceleration: float = MAX_ACCELERATION
    max_distance: float | None = None
    keep: float = 0.0
    _taken_at: Point | None = field(default=None, init=False)
    _last_held: float = field(default=0.0, init=False)
    _last_contact: float = field(default=0.0, init=False)
    _course: Course = field(default_factory=Course, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.keep >= 0.0:
            raise ValueError(f"keep must be 0 or more, not {self.keep}")

    def on_start(self) -> None:
        """Take the ball's current position as the start of the carry."""
        self._taken_at = None
        self._last_held = self._last_contact = self.frame.time
        self._course.since = -inf

    def on_running(self) -> Status:
        """Carry for one tick."""
        frame, me, ball = self.frame, self.me, self.ball
        target = self.store.target if self.target is None else self.target
        if target is None:
            return self.fail("no target")
        if has_ball(me, ball):
            self._last_held = frame.time
        elif frame.time - self._last_held >= _GRACE or self._taken_at is None:
            return self.fail("it does not have the ball")
        if self._taken_at is None:
            self._taken_at = ball.position
        if distance(ball.position, target) <= self.tolerance:
            self._carry(target)
            return self.succeed("the ball is there")
        if (
            self.max_distance is not None
            and distance(ball.position, self._taken_at) > self.max_distance - _RULE_MARGIN
        ):
            return self.fail("the ball has been carried as far as allowed")
        self._carry(target)
        return self.run("carrying the ball")

    def _carry(self, target: Point) -> None:
        frame, me = self.frame, self.me
        limits = carrying_limits(me.limits, self.max_speed, self.max_turn, self.max_acceleration)
        if me.ball_contact:
            self._last_contact = frame.time
        elif frame.time - self._last_contact >= SLIPPED:
            self.store.command = grab(me, self.ball, me.limits.catch_speed, frame.period)
            return
        point, speed_there = next_waypoint(frame, me, target)
        heading = steady(self._course, frame.time, direction(me.position, point), self.keep)
        pace = limits.max_speed, limits.acceleration, limits.braking
        stands = frame.period + 2.0 * me.limits.trailing_time
        vx, vy = carrying_velocity(me, point, speed_there, heading, pace, stands)
        omega = turn_rate(me, heading, limits, frame.period)
        self.store.command = command(me, vx, vy, omega, limits, frame.period)
        self.store.command.dribbler = True


@compilable
def steady(course: Course, now: float, way: float, keep: float) -> float:
    """Return the direction to face [rad]: ``way``, or the last one until ``keep`` has passed [s]."""
    if abs(wrap_angle(way - course.way)) > _OTHER_WAY and 0.0 <= now - course.since < keep:
        return course.way
    course.way, course.since = way, now
    return way


@compilable
def carrying_velocity(
    me: Robot,
    point: Point,
    speed_there: float,
    heading: float,
    pace: tuple[float, float, float],
    stands: float,
) -> Point:
    """Return the velocity with which the ball is carried to the next ``point`` of a way [m/s].

    Args:
        me: the robot, with the ball.
        point: the next point of the way [m].
        speed_there: speed allowed there [m/s].
        heading: direction the robot is to face [rad].
        pace: top speed, acceleration and braking with the ball [m/s, m/s^2, m/s^2].
        stands: duration for which a command is held [s].
    """
    top, acceleration, braking = pace
    dx, dy = point[0] - me.x, point[1] - me.y
    gap = hypot(dx, dy)
    if gap <= 0.0:
        return 0.0, 0.0
    ux, uy = dx / gap, dy / gap
    speed_there = min(speed_there, top)
    speed = approach_speed(
        gap + speed_there * speed_there / (2.0 * braking),
        ux * me.vx + uy * me.vy,
        top,
        acceleration,
        braking,
        stands,
    )
    # The ball stays only while it is pushed, so the robot turns first and drives once it faces the way.
    speed *= max(0.0, cos(wrap_angle(heading - me.heading))) ** 2
    return ux * speed, uy * speed
