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
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_IN_LINE = radians(25.0)
_BEHIND = ROBOT_RADIUS + BALL_RADIUS + 0.05
_NEAR = 0.3
_GRAB_SPEED = 0.4
_PULL = dribbling_limits(max_speed=0.5, max_turn=1.0, max_acceleration=0.8)
"""With the ball, backwards: what any dribbler holds."""


@skill
class FetchBall(DrivingSkill):
    """Take the ball from the side of the own goal and drive backwards with it to before the goal.

    SUCCESS when the ball lies within 0.3 m of the place.

    Source: the three steps are those of RoboBulls' published code, DribbleBack.

    Args:
        limits: how to drive without the ball; None for the robot's own.
        speed: factor on the top speed without the ball.
        before_goal: where to, in front of the goal's centre [m].
    """

    before_goal: float = 0.15

    def on_running(self) -> Status:
        """Go behind the ball, then up to it, then back with it."""
        me, ball, period = self.me, self.ball.position, self.frame.period
        place = (self.before_goal - self.frame.field.half_length, 0.0)
        if distance(ball, place) < 0.3:
            return self.succeed("the ball is back")
        facing = direction(me.position, ball)
        if me.ball_contact:
            self.store.command = drive(me, place, direction(place, me.position), _PULL, period)
            self.store.command.dribbler = True
            return self.run("pulling it back")
        outwards = direction(place, ball)
        off_line = abs(wrap_angle(facing - outwards))
        if off_line < _IN_LINE and distance(me.position, ball) < _NEAR:
            self.store.command = grab(me, self.ball, _GRAB_SPEED, period)
            return self.run("taking it")
        behind: Point = (ball[0] - _BEHIND * cos(outwards), ball[1] - _BEHIND * sin(outwards))
        limits = self.drive_limits
        self.store.command = travel(
            self.frame, me, behind, outwards, limits, avoid_ball=True, goalkeeper=True
        )
        return self.run("going behind it")
