"""Condition: a resting ball on the edge of the own defence area is the goalkeeper's to fetch."""

from __future__ import annotations

from dataclasses import field

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.geometry import distance
from robobt.world.rules import in_own_defense_area
from robobt.world.state import ROBOT_RADIUS


@skill
class BallAtDefenseEdge(Condition):
    """SUCCESS from when a ball at the own defence area's edge may be fetched until it is or is lost.

    It may be fetched while it rests between a robot's diameter outside the area's
    edge and half a radius inside it, and no opponent is about as near to it as
    the own team. It is fetched when it lies a radius inside the area, lost when
    it is more than a diameter outside.

    Source: RoboBulls' published code, Goalie.

    Args:
        rest_speed: fastest ball that rests [m/s].
    """

    rest_speed: float = 0.1
    _fetching: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Look where the ball is and who is near."""
        field, ball = self.frame.field, self.ball
        near = in_own_defense_area(field, ball.x, ball.y, 2.0 * ROBOT_RADIUS) and field.contains(
            ball.x, ball.y
        )
        if self._fetching:
            self._fetching = near and not in_own_defense_area(field, ball.x, ball.y, -ROBOT_RADIUS)
        elif near and not in_own_defense_area(field, ball.x, ball.y, -0.5 * ROBOT_RADIUS):
            self._fetching = ball.speed <= self.rest_speed and self._ours()
        return self.succeed() if self._fetching else self.fail("no ball to fetch")

    def _ours(self) -> bool:
        here = self.ball.position
        if not self.frame.opponents:
            return True
        theirs = min(distance(robot.position, here) for robot in self.frame.opponents)
        return theirs - min(distance(robot.position, here) for robot in self.frame.own) > ROBOT_RADIUS
