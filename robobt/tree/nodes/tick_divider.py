"""Decorator: ticks its child less often."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.leaf import Bound
from robobt.tree.nodes.gate import Gate
from robobt.tree.nodes.timer import HasTime, Timer


class TickDivider(Gate, Bound[HasTime]):
    """Ticks its child less often and repeats the child's last status in between.

    Use it for costly work that changes slowly, such as rating every shot. Do not use it for skills that move
    the robot: commands are not repeated, so the robot would stand between ticks.

    The first tick reaches the child, and so does the first one after a running
    child was interrupted. Ticks are those that reach this node, so with ``every``
    an answer may be as old as the node has been out of use; ``seconds`` bounds its age.

    Args:
        every: tick the child once in this many ticks.
        seconds: tick the child when this much time has passed since its last tick [s].

    Raises:
        ValueError: not exactly one of both is given, or ``every`` is below 1.
    """

    def __init__(
        self, name: str, child: Behaviour, *, every: int | None = None, seconds: float | None = None
    ) -> None:
        super().__init__(name, child)
        if (every is None) is (seconds is None):
            raise ValueError("give either every (ticks) or seconds")
        if every is not None and every < 1:
            raise ValueError(f"every must be 1 or more ticks, not {every}")
        self.every = every
        self.seconds = seconds
        self._timer = None if seconds is None else Timer(seconds)
        self._repeated = 0
        self._last: Status | None = None

    def answer(self) -> Status | None:
        """Return the last status until the child is due."""
        if self._last is None:
            return None
        if self._timer is not None:
            return self._last if self._timer.runs(self.store.time) else None
        assert self.every is not None
        self._repeated += 1
        return self._last if self._repeated < self.every else None

    def update(self) -> Status:
        """Return the child's status and keep it for the ticks to come."""
        self._last = status = super().update()
        self._repeated = 0
        if self._timer is not None:
            self._timer.start(self.store.time)
        return status

    def terminate(self, new_status: Status) -> None:
        """Forget the status of an interrupted child."""
        if new_status is Status.INVALID and self.status is Status.RUNNING:
            self._last = None
