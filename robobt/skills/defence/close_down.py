"""Come out of the goal towards an attacker that is alone with the goalkeeper."""

from __future__ import annotations

from math import cos, hypot

from robobt.skills.base import skill
from robobt.skills.defence.cover_angle import bisector_foot
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.geometry import line_crossing_x
from robobt.world.rules import has_ball
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


@skill
class CloseDown(DrivingSkill):
    """Stand between the ball and our goal, far out: closer to the ball, the robot hides more of the goal.

    The robot stands on the line along which the opponent with the ball points, if that line meets the goal,
    else on the bisector of the angle between the posts. It goes as far out as ``stand_out``, but no closer to
    the ball than ``gap`` or than the point where its hull hides the whole goal. Meant for a goalkeeper
    without defenders, as in a penalty kick: it leaves its defence area. Never ends by itself; FAILURE while
    the ball is behind the goal line.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        stand_out: largest distance from the goal line [m].
        gap: least distance from the ball to the robot's centre [m].
    """

    stand_out: float = 2.0
    gap: float = 0.5

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        field, ball = self.frame.field, self.ball
        line, half_goal = -field.half_length, field.goal_width / 2
        if ball.x <= line:
            return self.fail("the ball is behind the goal line")
        foot, doing = self._aim(), "on the line of the aim"
        if foot is None or abs(foot) > half_goal:
            foot, doing = bisector_foot(ball.position, field.half_length, half_goal), "covering the angle"
        dx, dy = ball.x - line, ball.y - foot
        way = hypot(dx, dy)
        hides = (ROBOT_RADIUS + BALL_RADIUS) / half_goal * way
        out = max(min(self.stand_out, way - max(hides, self.gap)), ROBOT_RADIUS)
        place = (line + out * dx / way, foot + out * dy / way)
        self.drive_to(place, ball.position, avoid_robots=False, goalkeeper=True, thereabouts=True)
        return self.run(doing)

    def _aim(self) -> float | None:
        """Return where the opponent with the ball points on our goal line [m]; None without one."""
        ball = self.ball
        for robot in self.frame.opponents:
            if has_ball(robot, ball) and cos(robot.heading) < 0.0:
                return line_crossing_x(ball.position, robot.heading, -self.frame.field.half_length)
        return None
