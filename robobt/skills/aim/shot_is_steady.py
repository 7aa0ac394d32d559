"""Condition: the selected shot has been there for a while."""

from __future__ import annotations

from dataclasses import field

from robobt.skills.base import Condition, skill
from robobt.skills.debounce import Debounce
from robobt.skills.store import Shot
from robobt.tree import Status


@skill
class ShotIsSteady(Condition):
    """SUCCESS while the store's ``shot`` is steady; else FAILURE, and ``shot`` is set to None.

    During a short gap the last shot is put back into the store. Tick it after :class:`SelectShot` in every
    tick.

    Source: RoboBulls' published code, AttackMain, whose times are 0.9 s.

    Args:
        rise: how long there must be a shot before it counts [s].
        fall: longest gap that is bridged, once the shot has been there for at least that time [s].
    """

    reads = ("shot",)
    writes = ("shot",)

    rise: float = 0.1
    fall: float = 0.2
    _last: Shot | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._steady = Debounce(self.rise, self.fall)

    def on_running(self) -> Status:
        """Debounce the shot selected in this tick."""
        shot = self.store.shot
        if shot is not None:
            self._last = shot
        if not self._steady.update(shot is not None, self.frame.time):
            self.store.shot = None
            return self.fail("no shot for long enough")
        self.store.shot = self._last
        return self.succeed()
