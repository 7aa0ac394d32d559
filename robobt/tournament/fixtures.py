"""The fixtures: every pairing in rounds, each round once from either side with the same seed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple


class Fixture(NamedTuple):
    """One match of a tournament: the entrants by name, and the round, from 0, that fixes its seed."""

    blue: str
    yellow: str
    round: int

    def __str__(self) -> str:
        return f"{self.blue} v {self.yellow}, round {self.round}"


def pairings(names: Sequence[str], against: str | None = None) -> list[tuple[str, str]]:
    """Return the pairings: all against all, or all against the one in ``against``."""
    if against is None:
        return list(combinations(names, 2))
    return [(name, against) for name in names if name != against]


def fixtures(pairs: Sequence[tuple[str, str]], rounds: int, first: int = 0) -> Iterator[Fixture]:
    """Yield all matches, round by round so that a tournament that is stopped is nearly balanced."""
    for number in range(first, first + rounds):
        for one, other in pairs:
            yield Fixture(one, other, number)
            yield Fixture(other, one, number)
