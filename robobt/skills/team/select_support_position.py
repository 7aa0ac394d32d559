"""Where to wait for a pass."""

from __future__ import annotations

from math import radians

import numpy as np

from robobt.skills.base import skill
from robobt.skills.team.best_field_position import static_value
from robobt.skills.team.field_search import FieldSearch
from robobt.skills.team.position_grid import GridArray, PositionGrid, lane_shadow, shot_path

_WIDEST = radians(70.0)


@skill
class SelectSupportPosition(FieldSearch):
    """Write the best place in the opponent's half to support the attack to ``target``.

    A place is the better the fewer of these faults it has, and among equals the
    nearer to the goal, straight before it, and to the robot:

    * opponents standing together hide the goal from it;
    * an opponent stands in the lane from the ball to it;
    * it lies between the ball and the goal, in the way of a shot;
    * a team-mate is nearer than ``mate_distance``: a fault in part, the more the nearer.

    The opponent's defence area is out of bounds. Source: RoboBulls' published code
    (AttackSupport), where one fault is as bad as many.

    Args:
        mate_distance: room to leave to every team-mate [m].
        lane_clearance: an opponent nearer to the lane from the ball is in it [m].
        shot_room: room to leave beside either post for a shot, narrowing towards the ball [m].
        travel: cost of one metre from where the robot is.
        spacing: of the points considered [m].
        every: time from one look to the next [s]; in between the target stands.
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
        """Rate as the class describes."""
        frame, me, ball = self.frame, self.me, self.ball.position
        value = static_value(grid, _WIDEST) - self.travel * grid.distance_from(me.position)
        regions = [lane_shadow(ball, opponent, self.lane_clearance) for opponent in frame.opponents]
        regions.append(shot_path(frame.field, ball, self.shot_room))
        faults = grid.count_regions(regions)
        for rows, hidden in grid.goal_hidden(frame.opponents, extra=0.1):
            # Bytes, because adding truth values to floats costs several times as much.
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
