"""The recordings of a tournament: which are kept, and where."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from robobt.tournament.fixtures import Fixture
from robobt.tournament.played import PlayedMatch

ENDING = ".robobt.arrows"


class Keep(StrEnum):
    """Which recordings are kept."""

    WORST = "worst"
    """The first entrant's worst match against each opponent."""
    LOST = "lost"
    """The matches that the first entrant loses."""
    ALL = "all"


@dataclass(slots=True, frozen=True)
class Recordings:
    """Recordings of a tournament in a folder of their own. Every match is recorded; not all are kept.

    Attributes:
        folder: where they are.
        keep: which are kept.
        first: the entrant whose matches matter.
    """

    folder: Path
    keep: Keep
    first: str

    def path(self, fixture: Fixture) -> Path:
        """Return where a match is recorded."""
        return self.folder / f"{file_name(fixture)}{ENDING}"

    def page(self, fixture: Fixture) -> Path:
        """Return where the page of a recorded match is."""
        return self.folder / f"{file_name(fixture)}.html"

    def remove(self, fixture: Fixture) -> None:
        """Remove the recording of a match, and its page."""
        for path in (self.path(fixture), self.page(fixture)):
            path.unlink(missing_ok=True)

    def kept(self, matches: Iterable[PlayedMatch]) -> set[Fixture]:
        """Return which of the matches are to be kept."""
        if self.keep is Keep.ALL:
            return {match.fixture for match in matches}
        own = [match for match in matches if self.first in (match.blue, match.yellow)]
        if self.keep is Keep.LOST:
            return {match.fixture for match in own if match.score(self.first) == 0.0}
        worst: dict[str, PlayedMatch] = {}
        for match in sorted(own, key=self._badness):
            worst.setdefault(match.yellow if match.blue == self.first else match.blue, match)
        return {match.fixture for match in worst.values()}

    def sort_out(self, matches: Iterable[PlayedMatch]) -> None:
        """Remove the recordings of matches that are not to be kept."""
        matches = list(matches)
        for fixture in {match.fixture for match in matches} - self.kept(matches):
            self.remove(fixture)

    def _badness(self, match: PlayedMatch) -> tuple[float, int, int, bool]:
        return match.score(self.first), match.lead(self.first), match.round, match.blue != self.first


def file_name(fixture: Fixture) -> str:
    """Return a name of printable characters, not too long for a folder, that no other match has."""
    digest = hashlib.blake2b(repr(fixture).encode(), digest_size=4).hexdigest()
    sides = [re.sub(r"[^A-Za-z0-9.-]+", "_", name)[:50].strip("_.") for name in fixture[:2]]
    return f"{fixture.round:05d}_{sides[0]}_v_{sides[1]}_{digest}"
