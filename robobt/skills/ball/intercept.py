"""Meet a moving ball and take it."""

from __future__ import annotations

from dataclasses import field
from math import atan2, cos, hypot, inf, sin

from robobt.motion.ball_watch import BallWatch
from robobt.motion.dribbling import holds_weakly
from robobt.motion.path_planner import travel
from robobt.motion.pilot import roughly, travel_time
from robobt.skills.ball.pick_up_ball import Grip, grab
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.limits import RobotLimits
from robobt.world.sketch import Sketch
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, Frame, RobotState

_MEETING_DISTANCE = ROBOT_RADIUS + BALL_RADIUS - 0.015
"""Distance between the centres of robot and ball when they meet [m]; about that of a flat front."""
_SLOW_BALL_SPEED = 0.2
"""A ball slower than this is approached instead of awaited [m/s]."""
_CLOSE_RANGE = 0.2
_FACING_RANGE = 1.0
"""The robot faces a ball closer than this exactly [m]."""
_NEAR_ENOUGH = 0.15
"""Distance within which the robot counts as there [m]; without it the robot would back away from the ball
over the last centimetres."""
_NEAR_ENOUGH_WEAKLY = 0.03
"""That distance with a weak dribbler, which cannot brake a ball that the robot drives into [m]."""
_SEARCH_STEP = 0.15
_SEARCH_HORIZON = 4.0


def earliest_meeting(
    frame: Frame, me: RobotState, limits: RobotLimits, rolling: float
) -> tuple[Point, float]:
    """Find where the ball can be met soonest and when [m, s from now].

    The ball is followed along its line until the robot, by the trapezoid on the
    straight line, can stand behind it there in time; if it never can, the point
    where the ball comes to rest or leaves the field.

    The ball begins to roll at the speed ``rolling`` [m/s].
    """
    ball = frame.ball
    speed = ball.speed
    ux, uy = (ball.vx / speed, ball.vy / speed) if speed > 0.0 else (0.0, 0.0)
    most = _way_to_border(frame.field, ball, ux, uy)
    before = late = 0.0
    time = 0.0
    while True:
        way = min(most, frame.ball_model.way_in(time, speed, rolling))
        point = (ball.x + way * ux, ball.y + way * uy)
        late = _arrival(me, point, ux, uy, limits) - time
        if late <= 0.0 or way >= most or time >= _SEARCH_HORIZON:
            break
        before = time
        time += _SEARCH_STEP
    if late > 0.0:
        return (point, time)
    for _ in range(4):
        middle = 0.5 * (before + time)
        way = min(most, frame.ball_model.way_in(middle, speed, rolling))
        trial = (ball.x + way * ux, ball.y + way * uy)
        if _arrival(me, trial, ux, uy, limits) <= middle:
            time, point = middle, trial
        else:
            before = middle
    return (point, time)


def meet(
    frame: Frame,
    me: RobotState,
    limits: RobotLimits,
    rolling: float,
    *,
    goalkeeper: bool = False,
    slack: float = 0.0,
    sketch: Sketch | None = None,
) -> RobotCommand:
    """Meet the ball for one tick: drive onto its line, face it, and take it once it is near and slow.

    Args:
        frame: what is on the field.
        me: the robot.
        limits: how to drive.
        rolling: speed at which the ball begins to roll [m/s].
        goalkeeper: may enter the own defence area.
        slack: heading error allowed while the ball is still far [rad].
        sketch: takes the planned way.
    """
    ball = frame.ball
    dx, dy = ball.x - me.x, ball.y - me.y
    gap = hypot(dx, dy)
    speed = ball.speed
    heading = atan2(dy, dx)
    if gap < _CLOSE_RANGE and (speed < _SLOW_BALL_SPEED or me.ball_contact):
        return grab(me, ball, 0.5, frame.period)
    (x, y), _ = earliest_meeting(frame, me, limits, rolling)
    ux, uy = (
        (ball.vx / speed, ball.vy / speed) if speed > _SLOW_BALL_SPEED else (-cos(heading), -sin(heading))
    )
    place = (x + _MEETING_DISTANCE * ux, y + _MEETING_DISTANCE * uy)
    if gap > _FACING_RANGE:
        heading = roughly(me.heading, heading, slack)
    order = travel(frame, me, place, heading, limits, goalkeeper=goalkeeper, sketch=sketch)
    order.dribbler = gap < 1.0
    return order


@skill
class Intercept(DrivingSkill):
    """Go where a moving ball can be met soonest, face it and take it.

    Succeeds when the ball has been in the mouth for ``settle`` seconds.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        settle: how long the ball has to stay in the mouth [s].
        goalkeeper: may enter the own defence area.
    """

    settle: float = 0.05
    goalkeeper: bool = False
    _watch: BallWatch = field(default_factory=BallWatch, init=False)
    _grip: Grip = field(default_factory=Grip, init=False)

    def on_running(self) -> Status:
        """Drive one tick."""
        frame, me = self.frame, self.me
        rolling = self._watch.rolling_speed(frame)
        self.store.command = meet(
            frame, me, self.drive_limits, rolling, goalkeeper=self.goalkeeper, sketch=self.draw
        )
        if self._grip.held_for(frame, me) >= self.settle - 1e-9:
            return self.succeed("it has the ball")
        return self.run("meeting the ball")


def _arrival(me: RobotState, point: Point, ux: float, uy: float, limits: RobotLimits) -> float:
    dx, dy = point[0] + _MEETING_DISTANCE * ux - me.x, point[1] + _MEETING_DISTANCE * uy - me.y
    gap = hypot(dx, dy)
    near = _NEAR_ENOUGH_WEAKLY if holds_weakly(me.limits) else _NEAR_ENOUGH
    if gap <= near:
        return 0.0
    return travel_time(gap - near, (me.vx * dx + me.vy * dy) / gap, limits)


def _way_to_border(field: FieldGeometry, ball: BallState, ux: float, uy: float) -> float:
    """Compute how far the ball rolls along (ux, uy) until it is out of the field [m]."""
    way = inf
    if ux != 0.0:
        way = ((field.half_length if ux > 0.0 else -field.half_length) - ball.x) / ux
    if uy != 0.0:
        way = min(way, ((field.half_width if uy > 0.0 else -field.half_width) - ball.y) / uy)
    return max(0.0, way)
