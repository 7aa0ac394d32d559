"""Decorator: a pause after its child has finished."""

from __future__ import annotations

from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.leaf import Bound
from robobt.tree.nodes.gate import Gate
from robobt.tree.nodes.timer import HasTime, Timer


class Cooldown(Gate, Bound[HasTime]):
    """FAILURE, without ticking its child, for a while after the child has finished.

    Use it for actions that should not be retried at once: a pass that has just failed, a kick that has just
    been taken. An interrupted child has not finished and may continue at its next tick; an interruption does
    not shorten the pause either.

    Args:
        seconds: length of the pause, from the tick at which the child finished [s].
        after: which end of the child is followed by a pause.
    """

    def __init__(
        self,
        name: str,
        child: Behaviour,
        *,
        seconds: float,
        after: Literal["either", "success", "failure"] = "either",
    ) -> None:
        super().__init__(name, child)
        if after not in _ENDS:
            raise ValueError(f"after must be one of {', '.join(_ENDS)}, not {after!r}")
        self.seconds = seconds
        self.after = after
        self._pause = Timer(seconds)
        self._reason = ""

    def answer(self) -> Status | None:
        """Return FAILURE during the pause."""
        if self._pause.runs(self.store.time):
            self.feedback_message = self._reason
            return Status.FAILURE
        return None

    def update(self) -> Status:
        """Return the child's status; an end begins the pause."""
        status = super().update()
        if status in _ENDS[self.after]:
            self._pause.start(self.store.time)
            self._reason = f"pauses until {self._pause.until:.2f} s"
        return status


_ENDS = {
    "either": (Status.SUCCESS, Status.FAILURE),
    "success": (Status.SUCCESS,),
    "failure": (Status.FAILURE,),
}
