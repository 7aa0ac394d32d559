"""Stand still."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import RobotCommand

_STOPPED_SPEED = 0.01


@skill
class Stop(Skill):
    """Brake and stand still; running until the robot is at rest, then succeeding.

    Args:
        dribbler: whether the dribbler turns meanwhile.
    """

    dribbler: bool = False

    def on_running(self) -> Status:
        """Command zero velocity."""
        self.store.command = RobotCommand(dribbler=self.dribbler)
        me = self.me
        still = me.speed < _STOPPED_SPEED and abs(me.omega) < _STOPPED_SPEED
        return self.succeed("standing") if still else self.run("braking")
