"""Leaf: some time passes."""

from __future__ import annotations

from py_trees.common import Status

from robobt.tree.leaf import Leaf
from robobt.tree.nodes.timer import HasTime, Timer


class Wait(Leaf[HasTime]):
    """RUNNING for a while, then SUCCESS.

    Args:
        seconds: how long, from its first tick [s].
    """

    def __init__(self, name: str = "", *, seconds: float) -> None:
        super().__init__(name)
        self.seconds = seconds
        self._timer = Timer(seconds)
        self._remark = ""

    def on_start(self) -> None:
        """Start the time."""
        self._timer.start(self.store.time)
        self._remark = f"waits until {self._timer.until:.2f} s"

    def on_running(self) -> Status:
        """Look at the clock."""
        return self.run(self._remark) if self._timer.runs(self.store.time) else self.succeed()
