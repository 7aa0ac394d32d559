"""Choose where to clear the ball to."""

from __future__ import annotations

from typing import ClassVar

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import segment_distance
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


@skill
class SelectClearance(Skill):
    """Write to ``target`` the foremost team-mate that the ball can reach, or a point upfield.

    Always SUCCESS. A team-mate counts when it is at least a third of the own half
    off our goal line and no other robot stands in the lane.

    Source: RoboBulls' published code, Goalie, which counts team-mates beyond
    x = -1.5 m on a 9 m field.

    Args:
        lane: half width of a lane that is free [m].
    """

    writes: ClassVar[tuple[str, ...]] = ("target",)

    def __init__(self, *, lane: float = ROBOT_RADIUS + BALL_RADIUS + 0.03, name: str = "") -> None:
        super().__init__(name)
        self.lane = lane

    def on_running(self) -> Status:
        """Go through the team-mates."""
        frame, ball, me = self.frame, self.ball.position, self.me
        best = None
        for mate in frame.own:
            if mate.id != me.id and mate.x > -frame.field.half_length / 3:
                if best is not None and mate.x <= best.x:
                    continue
                if all(
                    segment_distance(other.position, ball, mate.position) >= self.lane
                    for other in frame.others(me.id)
                    if other is not mate
                ):
                    best = mate
        if best is None:
            self.store.target = (frame.field.half_length * 2 / 9, 0.0)
            return self.succeed("upfield")
        self.store.target = best.position
        return self.succeed(f"to {best.id}")
