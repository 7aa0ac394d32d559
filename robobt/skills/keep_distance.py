"""Clear the ball while the opponents or the referee have it."""

from __future__ import annotations

from math import hypot

from robobt.skills.base import Skill, skill
from robobt.skills.path_planner import STOP_DISTANCE, travel
from robobt.tree import Status
from robobt.world.geometry import Point, direction
from robobt.world.state import ROBOT_RADIUS

_MARGIN = 0.05


@skill
class KeepDistance(Skill):
    """Drive away from the ball, and from where it will be put down, until far enough from both.

    SUCCESS once the hull is at least ``distance`` away; no faster than the rules
    allow on the way.

    Args:
        distance: from the hull to the ball [m].
        goalkeeper: may stay in the own defence area.
    """

    def __init__(self, *, distance: float = STOP_DISTANCE, goalkeeper: bool = False, name: str = "") -> None:
        super().__init__(name)
        self.distance = distance
        self.goalkeeper = goalkeeper

    def on_running(self) -> Status:
        """Straight away from the nearer of the two."""
        frame, me = self.frame, self.me
        keep = self.distance + ROBOT_RADIUS + _MARGIN
        places: list[Point] = [frame.ball.position]
        if frame.game.placement is not None and not frame.game.in_play:
            places.append(frame.game.placement)
        nearest = min(places, key=lambda place: hypot(me.x - place[0], me.y - place[1]))
        dx, dy = me.x - nearest[0], me.y - nearest[1]
        gap = hypot(dx, dy)
        if gap >= keep:
            return self.succeed("far enough")
        if gap < 1e-3:
            dx, dy, gap = -1.0, 0.0, 1.0
        # Aimed farther than needed, so that the robot does not creep up to the limit.
        reach = keep + 2.0 * _MARGIN
        target = (
            _inside(frame.field.half_length, nearest[0] + dx * reach / gap),
            _inside(frame.field.half_width, nearest[1] + dy * reach / gap),
        )
        self.store.command = travel(
            frame, me, target, direction(me.position, nearest), me.limits, goalkeeper=self.goalkeeper
        )
        return self.run("clearing the ball")


def _inside(half: float, value: float) -> float:
    return min(half, max(-half, value))
