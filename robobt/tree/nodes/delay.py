"""Decorator: a child that starts later."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.leaf import Bound
from robobt.tree.nodes.gate import Gate
from robobt.tree.nodes.timer import HasTime, Timer


class Delay(Gate, Bound[HasTime]):
    """RUNNING for a while before its child is ticked for the first time in a run.

    Args:
        seconds: how long, from its own first tick [s].
    """

    def __init__(self, name: str, child: Behaviour, *, seconds: float) -> None:
        super().__init__(name, child)
        self.seconds = seconds
        self._timer = Timer(seconds)
        self._remark = ""

    def initialise(self) -> None:
        """Start the time."""
        self._timer.start(self.store.time)
        self._remark = f"waits until {self._timer.until:.2f} s"

    def answer(self) -> Status | None:
        """Return RUNNING until the time is up."""
        if self._timer.runs(self.store.time):
            self.feedback_message = self._remark
            return Status.RUNNING
        return None
