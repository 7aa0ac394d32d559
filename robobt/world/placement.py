"""Checks that every world makes before it puts anything anywhere."""

from __future__ import annotations

from collections.abc import Collection
from math import isfinite

from robobt.world.field import FieldGeometry
from robobt.world.protocol import Placement
from robobt.world.state import RobotId


def check_placement(placement: Placement, field: FieldGeometry, robots: Collection[RobotId] | None) -> None:
    """Check that a placement fits the field and the robots that play.

    ``robots`` are all that play; None when any robot may.

    Raises:
        ValueError: a robot lacks a pose or is not part of the world, or a coordinate
            is not finite or lies outside the walls.
    """
    if robots is not None:
        missing = [robot for robot in robots if robot not in placement.robots]
        if missing:
            raise ValueError(f"the placement has no pose for {', '.join(map(str, missing))}")
    for robot, pose in placement.robots.items():
        if robots is not None and robot not in robots:
            raise ValueError(f"{robot} is not part of this world")
        check_inside(str(robot), pose, field)
    check_inside("the ball", placement.ball, field)


def check_inside(what: str, values: tuple[float, ...], field: FieldGeometry) -> None:
    """Check that all values are finite, and that the first two, x and y, lie within the walls [m]."""
    if not all(map(isfinite, values)):
        raise ValueError(f"{what} is placed at {values}: not finite")
    outer_x, outer_y = field.outer
    x, y = values[:2]
    if abs(x) > outer_x or abs(y) > outer_y:
        raise ValueError(
            f"{what} is placed at ({x:g}, {y:g}), outside the walls at ({outer_x:g}, {outer_y:g})"
        )
