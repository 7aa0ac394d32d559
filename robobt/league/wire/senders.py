"""Which of several senders at one port is followed."""

from __future__ import annotations

from collections.abc import Hashable
from math import inf
from typing import Generic, TypeVar

Address = tuple[str, int]
"""Host and port of a sender."""

SENDER_SILENCE = 2.0
"""Another sender is followed once the present one has been silent for this long [s]."""


_S = TypeVar("_S", bound=Hashable)


class FirstSender(Generic[_S]):
    """Follows the first of several senders, and another one once that has been silent for ``silence`` [s].

    ``sender`` is the one that is followed, None before the first.
    """

    def __init__(self, silence: float = SENDER_SILENCE) -> None:
        self.sender: _S | None = None
        self._silence, self._heard = silence, -inf

    def follows(self, sender: _S, time: float) -> bool:
        """Return whether a packet that arrived at ``time`` from ``sender`` counts [s]."""
        return sender == self.sender or self.sender is None or time - self._heard > self._silence

    def heard(self, sender: _S, time: float) -> None:
        """Take note of a packet that was used."""
        self.sender, self._heard = sender, time
