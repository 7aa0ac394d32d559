"""The ways of several robots at once: a call of compiled code costs about as much as a way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from robobt.motion.path_planner import travel_law
from robobt.motion.scene import scene_of, trip_numbers
from robobt.motion.stadium import outside_stadium
from robobt.world.command import RobotCommand
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import LIMITS, SCENE, TRIP, limits_of, mover_records, movers_of
from robobt.world.state import Frame, RobotState

TeamWay: TypeAlias = tuple[RobotState, Point, float, float]
"""A robot, its target [m], where its mouth is to point [rad], and how far it stays from the ball [m]."""


def travel_together(
    frame: Frame, ways: Sequence[TeamWay], *, spare_mates: bool = False
) -> list[RobotCommand]:
    """Return the command of :func:`~robobt.motion.path_planner.travel` for each of a team's robots.

    Args:
        frame: what is on the field.
        ways: the robots and their targets; they drive by their own limits and avoid the ball.
        spare_mates: whether to avoid collisions with all robots, also while the ball is in play.
    """
    numbers: list[float] = []
    for me, target, heading, ball_gap in ways:
        goal = outside_stadium(frame, me, target)
        numbers += trip_numbers(me, goal, heading, avoid_ball=True, ball_gap=ball_gap)
    trips = np.array(numbers, dtype=np.float64).reshape(len(ways), -1)
    limits = [me.limits for me, _, _, _ in ways]
    # One row for all where they have the same limits.
    alike = all(each is limits[0] for each in limits)
    own = limits_of(limits[0])[None] if alike else np.stack([limits_of(each) for each in limits])
    commands = _travel_together(trips, scene_of(frame), movers_of(frame), own, spare_mates)
    return [RobotCommand(*command) for command in commands.tolist()]


@compiled
def _travel_together(
    trips_: FloatArray, scene_: FloatArray, movers_: FloatArray, own_: FloatArray, spare_mates: bool
) -> FloatArray:
    """Return each robot's velocity ahead and to the left [m/s] and turning rate [rad/s], (n, 3)."""
    trips, scene, movers = trips_.view(TRIP)[:, 0], scene_.view(SCENE)[0], mover_records(movers_)
    limits, commands = own_.view(LIMITS)[:, 0], np.empty((len(trips), 3))
    for i in range(len(trips)):
        own = limits[min(i, len(limits) - 1)]
        commands[i] = travel_law(trips[i], scene, movers, own, own, False, spare_mates)
    return commands
