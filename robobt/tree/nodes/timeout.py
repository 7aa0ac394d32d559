"""Decorator: a child that has to finish in time."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.leaf import Bound
from robobt.tree.nodes.gate import Gate
from robobt.tree.nodes.timer import HasTime, Timer


class Timeout(Gate, Bound[HasTime]):
    """FAILURE, and its child is interrupted, once the child has run for too long.

    The child is not ticked any more at that tick, so it leaves no command behind.
    It is ticked at least once.

    Args:
        seconds: how long the child may run, from its first tick [s].
    """

    def __init__(self, name: str, child: Behaviour, *, seconds: float) -> None:
        super().__init__(name, child)
        self.seconds = seconds
        self._timer = Timer(seconds)
        self._reason = f"not done within {seconds:g} s"

    def initialise(self) -> None:
        """Start the time."""
        self._timer.start(self.store.time)

    def answer(self) -> Status | None:
        """Return FAILURE when the time is up."""
        if self.decorated.status is Status.RUNNING and not self._timer.runs(self.store.time):
            self.feedback_message = self._reason
            return Status.FAILURE
        return None
