"""Condition: the selected pass has been there for a while."""

from __future__ import annotations

from dataclasses import field

from robobt.skills.base import Condition, skill
from robobt.skills.debounce import Debounce
from robobt.skills.store import Pass
from robobt.tree import Status


@skill
class PassIsSteady(Condition):
    """SUCCESS while the store's ``pass_`` is there and no flicker; else FAILURE, and it is None.

    In a short gap the last pass is put back into the store. To be ticked every
    tick after :class:`SelectPass`.

    Source: RoboBulls' published code, AttackMain, whose times are 0.9 s.

    Args:
        rise: how long there must be a pass before it counts [s].
        fall: longest gap in a pass that has stood as long [s].
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
        """Weigh what was selected in this tick."""
        pass_ = self.store.pass_
        if pass_ is not None:
            self._last = pass_
        if not self._steady.update(pass_ is not None, self.frame.time):
            self.store.pass_ = None
            return self.fail("no pass for long enough")
        if self._last is None:
            return self.fail("no pass yet")
        self.store.pass_ = self._last
        return self.succeed()
