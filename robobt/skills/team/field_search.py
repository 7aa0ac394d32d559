"""The base of skills that look for the best place in the opponent's half."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field
from math import inf

from robobt.skills.base import Skill
from robobt.skills.rate_limit import RateLimit
from robobt.skills.team.position_grid import GridArray, PositionGrid, position_grid
from robobt.tree import Status
from robobt.world.geometry import Point


@dataclass(kw_only=True, eq=False, repr=False)
class FieldSearch(Skill):
    """Write the grid point with the largest :meth:`value` to ``target``.

    SUCCESS, or FAILURE on a field without an allowed point. The target is kept until the next search, and
    after it while no other point is clearly better.

    Args:
        spacing: distance between grid points [m].
        every: time between two searches [s].
        keep: stay with the last target while it is at most this much worse than the best.
    """

    writes = ("target",)

    spacing: float
    every: float
    keep: float
    _target: Point | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.spacing > 0.0:
            raise ValueError(f"spacing must be positive, not {self.spacing}")
        self._look = RateLimit(self.every)

    @abstractmethod
    def value(self, grid: PositionGrid) -> GridArray:
        """Return the value of each point of ``grid``, (X, Y); -inf where no robot may go."""

    def on_running(self) -> Status:
        """Search again when ``every`` has passed."""
        if self._look.due(self.frame.time):
            self._target = self._search()
        self.store.target = self._target
        return self.fail("nowhere to go") if self._target is None else self.succeed()

    def _search(self) -> Point | None:
        grid = position_grid(self.frame.field, self.spacing)
        value = self.value(grid)
        point, most = grid.best(value)
        if most == -inf:
            return None
        if self._target is not None and grid.at(value, self._target) >= most - self.keep:
            return self._target
        return point
