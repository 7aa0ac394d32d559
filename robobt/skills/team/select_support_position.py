"""Where to wait for a pass."""

from __future__ import annotations

from math import radians

import numpy as np

from robobt.skills.base import skill
from robobt.skills.team.best_field_position import static_value
from robobt.skills.team.field_search import FieldSearch
from robobt.skills.team.position_grid import GridArray, PositionGrid, lane_shadow, shot_path

_WIDEST_SUPPORT_ANGLE = radians(70.0)


@skill
class SelectSupportPosition(FieldSearch):
    """Write the best place in the opponent's half to support the attack to ``target``.

    The best place has the fewest of these faults; among equals it is near the goal, straight in front of it,
    and near the robot:

    * opponents standing together hide the goal from it;
    * an opponent stands in the lane from the ball to the place;
    * it is between the ball and the goal, in the way of a shot;
    * a team-mate is nearer than ``mate_distance``: a partial fault that grows as the team-mate gets nearer.

    The opponent's defence area is excluded. Source: RoboBulls' published code (AttackSupport), where one
    fault is as bad as several.

    Args:
        mate_distance: distance to keep from every team-mate [m].
        lane_clearance: an opponent closer to the lane from the ball than this blocks it [m].
        shot_room: width to leave free beside either post for a shot, narrowing towards the ball [m].
        travel: cost of one metre from the robot.
        spacing: distance between the points considered [m].
        every: time between two searches [s]; in between the target is kept.
        keep: stay with the last target while it is at most this much worse than the best.
    """

    mate_distance: float = 2.0
    lane_clearance: float = 0.275
    shot_room: float = 0.6
    travel: float = 0.05
    spacing: float = 0.1
    every: float = 0.2
    keep: float = 0.05

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.mate_distance > 0.0:
            raise ValueError(f"mate_distance must be positive, not {self.mate_distance}")

    def value(self, grid: PositionGrid) -> GridArray:
        """Rate the points as the class describes."""
        frame, me, ball = self.frame, self.me, self.ball.position
        value = static_value(grid, _WIDEST_SUPPORT_ANGLE) - self.travel * grid.distance_from(me.position)
        regions = [lane_shadow(ball, opponent, self.lane_clearance) for opponent in frame.opponents]
        regions.append(shot_path(frame.field, ball, self.shot_room))
        faults = grid.count_regions(regions)
        for rows, hidden in grid.goal_hidden(frame.opponents, extra=0.1):
            # Bytes, because adding booleans to floats takes several times as long.
            faults[rows] += hidden.view(np.uint8)
        value -= faults
        room = self.mate_distance
        for mate in frame.teammates(me.id):
            rows = grid.rows(mate.x - room, mate.x + room)
            if rows.start < rows.stop:
                along = 1.0 - np.square((grid.x[rows] - mate.x) / room)
                near = along - np.square((grid.y - mate.y) / room)
                value[rows] -= np.maximum(near, 0.0, out=near)
        return value
