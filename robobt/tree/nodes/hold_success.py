"""Decorator: holds its child's success for a while."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.leaf import Bound
from robobt.tree.nodes.gate import Gate
from robobt.tree.nodes.timer import HasTime, Timer


class HoldSuccess(Gate, Bound[HasTime]):
    """SUCCESS, without ticking its child, for a while after the child has succeeded.

    Around a guard in a reactive sequence it commits the robot to the guarded action: an open shot counts as
    open for the next 0.3 s, and the guard's entries in the store stay unchanged. Failure is not held: the
    guard is ticked in every tick until it succeeds.

    To keep higher priorities from interrupting a branch, see
    :class:`~robobt.tree.nodes.commit_for.CommitFor`.

    Args:
        seconds: how long, from the tick at which the child succeeded [s].
    """

    def __init__(self, name: str, child: Behaviour, *, seconds: float) -> None:
        super().__init__(name, child)
        self.seconds = seconds
        self._hold = Timer(seconds)
        self._remark = ""

    def answer(self) -> Status | None:
        """Return SUCCESS while it holds."""
        if self._hold.runs(self.store.time):
            self.feedback_message = self._remark
            return Status.SUCCESS
        return None

    def update(self) -> Status:
        """Return the child's status; a success is held from now on."""
        status = super().update()
        if status is Status.SUCCESS:
            self._hold.start(self.store.time)
            self._remark = f"holds until {self._hold.until:.2f} s"
        return status
