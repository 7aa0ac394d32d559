"""Where to dribble to for a better shot."""

from __future__ import annotations

from functools import lru_cache
from math import radians

import numpy as np

from robobt.skills.base import skill
from robobt.skills.team.field_search import FieldSearch
from robobt.skills.team.position_grid import GridArray, PositionGrid

_WIDEST = radians(85.0)


@skill
class BestFieldPosition(FieldSearch):
    """Write the best place in the opponent's half to shoot from to ``target``.

    Near the goal and straight before it is good: twice the nearness (0 at a third
    of the field's length from it, 1 in it) and once the straightness (0 at 85
    degrees, 1 ahead), over three. From that goes ``travel`` a metre from the ball
    and 10 where opponents standing together hide the goal. The opponent's defence
    area is out of bounds.

    Source: RoboBulls' published code (AttackMain), whose field ends at the 3 m and
    85 degrees that here only set the scale, and shadows the space before the
    opponents too.

    Args:
        travel: cost of carrying the ball one metre.
        spacing: of the points considered [m].
        every: time from one look to the next [s]; in between the target stands.
        keep: stay with the last target while it is at most this much worse than the best.
    """

    travel: float = 0.05
    spacing: float = 0.1
    every: float = 0.2
    keep: float = 0.02

    def value(self, grid: PositionGrid) -> GridArray:
        """Rate as the class describes."""
        value = static_value(grid, _WIDEST) - self.travel * grid.distance_from(self.ball.position)
        for rows, hidden in grid.goal_hidden(self.frame.opponents, extra=0.1):
            value[rows][hidden] -= 10.0
        return value


@lru_cache(maxsize=16)
def static_value(grid: PositionGrid, widest: float) -> GridArray:
    """Rate nearness to the goal and straightness before it, (X, Y), 1 at most; -inf in the defence area.

    Made once for a grid and not to be written to.

    ``widest`` is the angle off the straight way out of the goal that is worth nothing [rad].
    """
    nearness = 1.0 - grid.goal_distance / (grid.field.length / 3.0)
    straightness = 1.0 - grid.goal_angle / widest
    value = np.where(grid.forbidden, np.float32(-np.inf), (2.0 * nearness + straightness) / 3.0)
    value.flags.writeable = False
    return value
