"""Condition: the goalkeeper may fetch a resting ball at the edge of the own defence area."""

from __future__ import annotations

from dataclasses import field

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.geometry import distance
from robobt.world.records import Ball
from robobt.world.rules import in_area
from robobt.world.state import ROBOT_RADIUS


@skill
class BallAtDefenseEdge(Condition):
    """SUCCESS from when a ball at the own defence area's edge may be fetched until it is fetched or lost.

    The ball may be fetched while it rests at most a robot's diameter outside and half a radius inside the
    area's edge, and no opponent is about as close to it as the own team. It is fetched once it is a radius
    inside the area, and lost once it is more than a diameter outside.

    Source: RoboBulls' published code, Goalie.

    Args:
        rest_speed: a ball slower than this counts as resting [m/s].
    """

    rest_speed: float = 0.1
    _fetching: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Check the ball's position and the robots near it."""
        ball, field = self.ball, self.frame.field
        at_edge = is_at_edge(ball, field, self._fetching)
        self._fetching = at_edge and (self._fetching or (ball.speed <= self.rest_speed and self._ours()))
        return self.succeed() if self._fetching else self.fail("no ball to fetch")

    def _ours(self) -> bool:
        here = self.ball.position
        if not self.frame.opponents:
            return True
        theirs = min(distance(robot.position, here) for robot in self.frame.opponents)
        return is_ours(min(distance(robot.position, here) for robot in self.frame.own), theirs)


@compilable
def is_at_edge(ball: Ball, field: FieldGeometry, fetching: bool) -> bool:
    """Return whether the ball lies where it may be fetched, or still is being fetched."""
    half_length, depth, width = field.length / 2, field.defense_depth, field.defense_width
    x, y, inside = ball.x, ball.y, -ROBOT_RADIUS if fetching else -0.5 * ROBOT_RADIUS
    near = in_area(-x, y, half_length, depth, width, 2.0 * ROBOT_RADIUS)
    on_field = abs(x) <= half_length and abs(y) <= field.width / 2
    return near and on_field and not in_area(-x, y, half_length, depth, width, inside)


@compilable
def is_ours(own_way: float, their_way: float) -> bool:
    """Return whether no opponent is about as near to the ball as the own team [m, m]."""
    return their_way - own_way > ROBOT_RADIUS
