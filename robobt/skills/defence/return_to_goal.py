"""Go home: the goalkeeper's place before the middle of our goal."""

from __future__ import annotations

from robobt.motion.pace import Pace
from robobt.motion.path_planner import travel
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import direction
from robobt.world.limits import RobotLimits


@skill
class ReturnToGoal(Skill):
    """Drive to before the goal's centre, facing the middle of the field. Never ends by itself.

    Source: RoboBulls' published code, Goalie.

    Args:
        limits: how to drive; None for the robot's own.
        speed: factor on the top speed.
        before_goal: distance from the goal line [m].
    """

    limits: RobotLimits | None = None
    speed: float = 1.0
    before_goal: float = 0.15

    def __post_init__(self) -> None:
        super().__post_init__()
        self.pace = Pace(self.limits, self.speed)

    def on_running(self) -> Status:
        """One period on the way home."""
        me = self.me
        home = (self.before_goal - self.frame.field.half_length, 0.0)
        facing = direction(home, (0.0, 0.0))
        self.store.command = travel(
            self.frame, me, home, facing, self.pace.of(me.limits), avoid_ball=True, goalkeeper=True
        )
        return self.run("home")
