"""Condition: the selected pass has been there for a while."""

from __future__ import annotations

from dataclasses import field

from robobt.skills.base import Condition, skill
from robobt.skills.debounce import Debounce
from robobt.skills.store import Pass
from robobt.tree import Status


@skill
class PassIsSteady(Condition):
    """SUCCESS while the store's ``pass_`` is steady; else FAILURE, and ``pass_`` is set to None.

    During a short gap the last pass is put back into the store. Tick it after :class:`SelectPass` in every
    tick.

    Source: RoboBulls' published code, AttackMain, whose times are 0.9 s.

    Args:
        rise: how long there must be a pass before it counts [s].
        fall: longest gap that is bridged, once the pass has been there for at least that time [s].
    """

    reads = ("pass_",)
    writes = ("pass_",)

    rise: float = 0.1
    fall: float = 0.2
    _last: Pass | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._steady = Debounce(self.rise, self.fall)

    def on_running(self) -> Status:
        """Debounce the pass selected in this tick."""
        pass_ = self.store.pass_
        if pass_ is not None:
            self._last = pass_
        if not self._steady.update(pass_ is not None, self.frame.time):
            self.store.pass_ = None
            return self.fail("no pass for long enough")
        self.store.pass_ = self._last
        return self.succeed()
