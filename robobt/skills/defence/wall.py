"""Stand in the wall before the own defence area."""

from __future__ import annotations

from math import inf

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.state import ROBOT_RADIUS

GAP = ROBOT_RADIUS + 0.03
"""Distance from the defence area to the centre of a robot in the wall [m]."""

WIDTH = 2.0 * ROBOT_RADIUS + 0.02
"""Distance between neighbours in a wall [m]."""


@skill
class Wall(Skill):
    """Stand at the edge of the own defence area where the line from the ball to the goal crosses it.

    The robots of a wall stand side by side around that point and face the ball. Never ends by itself.

    Source: RoboBulls' published code (Wall).

    Args:
        place: this robot's place in the wall, counted from 0 on the left when facing the field.
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
        target = wall_place(frame.field, *frame.ball.position, self.place, self.size)
        self.drive_to(target, frame.ball.position, avoid_ball=True, thereabouts=True)
        return self.run("in the wall")


@compilable
def _edge_point(line: float, depth: float, half: float, way: float) -> Point:
    """Return the point ``way`` metres along the edge of the own defence area, from left (+y) to right [m].

    The edge begins and ends on the goal line at x = ``line``, ``half`` from the middle, and is ``depth``
    deep.
    """
    if way < depth:
        return (line + way, half)
    if way < depth + 2.0 * half:
        return (line + depth, half - (way - depth))
    return (line + (2.0 * depth + 2.0 * half) - way, -half)


@compilable
def _edge_towards(line: float, depth: float, half: float, ball_x: float, ball_y: float) -> float:
    """Return how far along the edge the line from the goal's centre to the ball leaves the area [m]."""
    dx, dy = ball_x - line, ball_y
    to_front = depth / dx if dx > 0.0 else inf
    to_side = half / abs(dy) if dy != 0.0 else inf
    if to_front <= to_side:
        if to_front == inf:
            return 0.5 * (2.0 * depth + 2.0 * half)
        return depth + half - to_front * dy
    x = max(0.0, to_side * dx)
    return x if dy > 0.0 else 2.0 * depth + 2.0 * half - x


@compilable
def wall_place(field: FieldGeometry, ball_x: float, ball_y: float, place: int, size: int) -> Point:
    """Return where a robot stands in a wall of ``size`` [m]; places count from the left, facing out."""
    depth = field.defense_depth + GAP
    half = min(field.defense_width / 2 + GAP, field.width / 2)
    spread, line = 0.5 * (size - 1) * WIDTH, -field.length / 2
    middle = _edge_towards(line, depth, half, ball_x, ball_y)
    middle = min(2.0 * depth + 2.0 * half - spread, max(spread, middle))
    return _edge_point(line, depth, half, middle + (place - 0.5 * (size - 1)) * WIDTH)
