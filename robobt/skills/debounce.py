"""A debounced condition: its answer changes only after the new answer has held for a while."""

from __future__ import annotations


class Debounce:
    """A debounced yes-or-no answer, in simulation time.

    While off, a counter adds the time with the answer yes and subtracts the time with no; the output turns on
    when the counter reaches ``rise``. While on, it counts in the same way up to ``fall`` and turns off when
    it reaches 0. An answer that has held for long therefore survives a gap as long as ``fall``, and a new one
    survives none.

    Source: the counters of RoboBulls' published code, AttackMain, converted to times.

    ``rise`` is how long yes must outweigh no to turn it on, ``fall`` the longest gap it survives [s]; ``on``
    is the initial output.
    """

    __slots__ = ("_balance", "_first", "_last", "fall", "on", "rise")

    def __init__(self, rise: float, fall: float, *, on: bool = True) -> None:
        if not (rise >= 0.0 and fall >= 0.0):
            raise ValueError(f"rise and fall must be 0 or more seconds, not {rise} and {fall}")
        self.rise = rise
        self.fall = fall
        self.on = self._first = on
        self._balance = 0.0
        self._last: float | None = None

    def update(self, answer: bool, time: float) -> bool:
        """Take the answer at ``time`` [s] and return ``on``; a clock that runs backwards resets it."""
        if self._last is not None and time < self._last:
            self.on, self._balance, self._last = self._first, 0.0, None
        passed = 0.0 if self._last is None else time - self._last
        self._last = time
        if self.on:
            self._balance = min(self.fall, self._balance + passed) if answer else self._balance - passed
            if not answer and self._balance <= 0.0:
                self.on, self._balance = False, 0.0
        else:
            self._balance = max(0.0, self._balance + (passed if answer else -passed))
            if answer and self._balance >= self.rise:
                self.on, self._balance = True, 0.0
        return self.on
