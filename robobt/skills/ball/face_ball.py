"""Turn to the ball on the spot."""

from __future__ import annotations

from math import radians

from robobt.motion.pilot import turn_rate
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import RobotCommand
from robobt.world.geometry import direction, wrap_angle


@skill
class FaceBall(Skill):
    """Stand and turn the mouth to the ball; succeeds while it points there.

    Args:
        tolerance: angle that counts as facing the ball [rad].
        dribbler: whether the dribbler turns meanwhile.
    """

    tolerance: float = radians(3.0)
    dribbler: bool = False

    def on_running(self) -> Status:
        """Turn for one tick."""
        me = self.me
        facing = direction(me.position, self.ball.position)
        omega = turn_rate(me, facing, me.limits, self.frame.period)
        self.store.command = RobotCommand(omega=omega, dribbler=self.dribbler)
        there = abs(wrap_angle(facing - me.heading)) <= self.tolerance
        return self.succeed("facing the ball") if there else self.run("turning")
