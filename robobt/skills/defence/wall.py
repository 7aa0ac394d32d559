"""Stand in the wall before the own defence area."""

from __future__ import annotations

from math import inf

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.state import ROBOT_RADIUS

_AREA_GAP = 0.03
_MATE_GAP = 0.02


@skill
class Wall(Skill):
    """Stand at the edge of the own defence area where the way from the ball to the goal crosses it.

    The robots of a wall stand side by side about that point and face the ball.
    Never ends by itself.

    Source: RoboBulls' published code (Wall).

    Args:
        place: which of them this robot is, counted from 0 on the left as they look out.
        size: how many robots the wall has.
    """

    place: int = 0
    size: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 <= self.place < self.size:
            raise ValueError(f"place {self.place} is not one of a wall of {self.size}")

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame = self.frame
        edge = DefenseEdge(frame.field, ROBOT_RADIUS + _AREA_GAP)
        width = 2.0 * ROBOT_RADIUS + _MATE_GAP
        offset = (self.place - 0.5 * (self.size - 1)) * width
        spread = 0.5 * (self.size - 1) * width
        middle = edge.towards(frame.ball.position)
        middle = min(edge.length - spread, max(spread, middle))
        target = edge.point(middle + offset)
        self.drive_to(target, frame.ball.position, avoid_ball=True, thereabouts=True)
        return self.run("in the wall")


class DefenseEdge:
    """The edge of the own defence area grown by ``gap``, as one way from left to right [m].

    "Left" is +y. The way begins and ends on the goal line.
    """

    def __init__(self, field: FieldGeometry, gap: float) -> None:
        self.line = -field.half_length
        self.depth = field.defense_depth + gap
        self.half = min(field.defense_width / 2 + gap, field.half_width)
        self.length = 2.0 * self.depth + 2.0 * self.half

    def point(self, way: float) -> Point:
        """Return the point ``way`` metres along the edge."""
        if way < self.depth:
            return (self.line + way, self.half)
        if way < self.depth + 2.0 * self.half:
            return (self.line + self.depth, self.half - (way - self.depth))
        return (self.line + self.length - way, -self.half)

    def towards(self, ball: Point) -> float:
        """Return how far along the edge the line from the goal's centre to the ball leaves the area [m]."""
        dx, dy = ball[0] - self.line, ball[1]
        to_front = self.depth / dx if dx > 0.0 else inf
        to_side = self.half / abs(dy) if dy != 0.0 else inf
        if to_front <= to_side:
            if to_front == inf:
                return 0.5 * self.length
            return self.depth + self.half - to_front * dy
        x = max(0.0, to_side * dx)
        return x if dy > 0.0 else self.length - x
