"""Where to dribble to for a better shot."""

from __future__ import annotations

from functools import lru_cache
from math import radians

import numpy as np

from robobt.skills.base import skill
from robobt.skills.team.field_search import FieldSearch
from robobt.skills.team.position_grid import GridArray, PositionGrid

_WIDEST_DRIBBLE_ANGLE = radians(85.0)


@skill
class BestFieldPosition(FieldSearch):
    """Write the best place in the opponent's half to shoot from to ``target``.

    Places near the goal and straight in front of it are good: the score is a third of twice the nearness (0
    at a third of the field's length from the goal, 1 in it) plus the straightness (0 at 85 degrees, 1
    straight ahead). ``travel`` per metre from the ball is subtracted, and 10 where opponents standing
    together hide the goal. The opponent's defence area is excluded.

    Source: RoboBulls' published code (AttackMain). There 3 m and 85 degrees bound the field, here they only
    set the scale; and there the space in front of the opponents is shadowed too.

    Args:
        travel: cost of carrying the ball one metre.
        spacing: distance between the points considered [m].
        every: time between two searches [s]; in between the target is kept.
        keep: stay with the last target while it is at most this much worse than the best.
    """

    travel: float = 0.05
    spacing: float = 0.1
    every: float = 0.2
    keep: float = 0.02

    def value(self, grid: PositionGrid) -> GridArray:
        """Rate the points as the class describes."""
        value = static_value(grid, _WIDEST_DRIBBLE_ANGLE) - self.travel * grid.distance_from(
            self.ball.position
        )
        for rows, hidden in grid.goal_hidden(self.frame.opponents, extra=0.1):
            value[rows][hidden] -= 10.0
        return value


@lru_cache(maxsize=16)
def static_value(grid: PositionGrid, widest: float) -> GridArray:
    """Rate nearness to the goal and straightness before it, (X, Y), 1 at most; -inf in the defence area.

    The array is built once per grid and read-only.

    ``widest`` is the angle off the goal's normal at which the straightness is 0 [rad].
    """
    nearness = 1.0 - grid.goal_distance / (grid.field.length / 3.0)
    straightness = 1.0 - grid.goal_angle / widest
    value = np.where(grid.forbidden, np.float32(-np.inf), (2.0 * nearness + straightness) / 3.0)
    value.flags.writeable = False
    return value
