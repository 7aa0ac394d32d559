"""Pull the ball back towards the own goal."""

from __future__ import annotations

from math import cos, radians, sin

from robobt.motion.dribbling import dribbling_limits
from robobt.motion.path_planner import travel
from robobt.motion.pilot import drive
from robobt.skills.ball.pick_up_ball import grab
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.sketch import Sketch
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState

_IN_LINE = radians(25.0)
_STANDOFF_DISTANCE = ROBOT_RADIUS + BALL_RADIUS + 0.05
_GRAB_DISTANCE = 0.3
_GRAB_SPEED = 0.4
_FETCHING_SPEED = 0.5
"""Speed when driving backwards with the ball [m/s]."""

_PULL_TURN = 1.0
"""Turning rate when driving backwards with the ball, if the dribbler holds it so in the curve [rad/s]."""

_PULL_ACCELERATION = 0.8
"""Deceleration when driving backwards with the ball in the dribbler [m/s^2]."""

_STEADY_DISTANCE = 0.2
"""Distance from the place within which the robot no longer turns with the ball [m]."""


def pull(
    frame: Frame,
    me: RobotState,
    held: bool,
    place: Point,
    free: RobotLimits,
    speed: float,
    *,
    placing: bool,
    sketch: Sketch,
) -> tuple[RobotCommand, str]:
    """Take the ball from the side of ``place`` and drive backwards to there, for one tick.

    This frees a ball at a wall or behind a line, because the robot never has to get behind it. The robot may
    enter its own defence area, and both defence areas while it is ``placing`` the ball for the referee.

    Args:
        frame: what is on the field.
        me: the robot.
        held: whether it has the ball.
        place: target of the robot's centre with the ball [m].
        free: how to drive without the ball.
        speed: top speed with it [m/s].
        placing: whether it may enter the opponents' defence area.
        sketch: takes the planned way.

    Returns:
        The command, and what the robot is about to do.
    """
    ball = frame.ball.position
    if held:
        pulling = dribbling_limits(
            max_speed=speed,
            max_turn=min(_PULL_TURN, me.limits.hold_acceleration / speed),
            max_acceleration=min(_PULL_ACCELERATION, me.limits.holds_straight),
        )
        near = distance(me.position, place) < _STEADY_DISTANCE
        heading = me.heading if near else direction(place, me.position)
        command = drive(me, place, heading, pulling, frame.period)
        command.dribbler = True
        return command, "pulling it"
    outwards = direction(place, ball)
    off_line = abs(wrap_angle(direction(me.position, ball) - outwards))
    if off_line < _IN_LINE and distance(me.position, ball) < _GRAB_DISTANCE:
        return grab(me, frame.ball, _GRAB_SPEED, frame.period), "taking it"
    behind: Point = (
        ball[0] - _STANDOFF_DISTANCE * cos(outwards),
        ball[1] - _STANDOFF_DISTANCE * sin(outwards),
    )
    way = travel(
        frame, me, behind, outwards, free, avoid_ball=True, goalkeeper=True, placing=placing, sketch=sketch
    )
    return way, "going behind it"


@skill
class FetchBall(DrivingSkill):
    """Take the ball from the side of the own goal and drive backwards with it, to in front of the goal.

    SUCCESS when the ball lies within 0.3 m of the place.

    Source: the three steps are those of RoboBulls' published code, DribbleBack.

    Args:
        limits: how to drive without the ball; None for the robot's own.
        speed_factor: factor on the top speed without the ball.
        before_goal: distance of that place from the goal's centre [m].
    """

    before_goal: float = 0.15

    def on_running(self) -> Status:
        """Go behind the ball, then up to it, then back with it."""
        place = (self.before_goal - self.frame.field.half_length, 0.0)
        if distance(self.ball.position, place) < 0.3:
            return self.succeed("the ball is back")
        self.store.command, doing = pull(
            self.frame,
            self.me,
            self.me.ball_contact,
            place,
            self.drive_limits,
            _FETCHING_SPEED,
            placing=False,
            sketch=self.draw,
        )
        return self.run(doing)
