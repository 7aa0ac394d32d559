"""Return to the goalkeeper's place in front of the middle of our goal."""

from __future__ import annotations

from robobt.motion.path_planner import travel
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.geometry import direction


@skill
class ReturnToGoal(DrivingSkill):
    """Drive to the place in front of the goal's centre, facing the middle of the field. Never ends by itself.

    Source: RoboBulls' published code, Goalie.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        before_goal: distance from the goal line [m].
    """

    before_goal: float = 0.15

    def on_running(self) -> Status:
        """Drive home for one tick."""
        me = self.me
        home = (self.before_goal - self.frame.field.half_length, 0.0)
        facing = direction(home, (0.0, 0.0))
        self.store.command = travel(
            self.frame,
            me,
            home,
            facing,
            self.drive_limits,
            avoid_ball=True,
            goalkeeper=True,
            sketch=self.draw,
        )
        return self.run("home")
