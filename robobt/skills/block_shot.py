"""Get between the ball and the point it would go to."""

from __future__ import annotations

from typing import ClassVar

from robobt.skills.base import Skill, skill
from robobt.skills.pace import Pace
from robobt.skills.pilot import drive
from robobt.tree import Status
from robobt.world.geometry import closest_point_on_segment, direction
from robobt.world.limits import RobotLimits


@skill
class BlockShot(Skill):
    """Drive to the nearest point of the line from the ball to the store's ``target``, facing the ball.

    Never ends by itself; FAILURE without a target. Avoids nothing: there is no
    time to.

    Source: RoboBulls' published code, Goalie.

    Args:
        limits: how to drive; None for the robot's own.
        speed: factor on the top speed.
        dribbler: whether to catch the ball with the dribbler.
    """

    reads: ClassVar[tuple[str, ...]] = ("target",)

    def __init__(
        self,
        *,
        limits: RobotLimits | None = None,
        speed: float = 1.0,
        dribbler: bool = True,
        name: str = "",
    ) -> None:
        super().__init__(name)
        self.dribbler = dribbler
        self.pace = Pace(limits, speed)

    def on_running(self) -> Status:
        """One period on the way to the line."""
        target = self.store.target
        if target is None:
            return self.fail("no target to block the way to")
        me, ball = self.me, self.ball.position
        place = closest_point_on_segment(me.position, ball, target)
        limits = self.pace.of(me.limits)
        self.store.command = drive(me, place, direction(me.position, ball), limits, self.frame.period)
        self.store.command.dribbler = self.dribbler
        return self.run("to the line of the shot")
