"""Candidates that play the same rounds against one team; those that are certainly worse are stopped."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from robobt.statistics import surely_negative
from robobt.tournament.fixtures import Fixture
from robobt.tournament.played import PlayedMatch
from robobt.tournament.sequential import scores_of


class Race:
    """The candidates' results so far.

    A candidate is compared with whom it plays, and with the best candidate of before in the same rounds.
    Verdicts are about rounds in their order, so that they do not depend on which match ends first.

    Args:
        against: the opponent of all candidates.
        best: scores of the best candidate of before by round; empty without one.
        error: largest probability that a comparison stops a candidate that is not worse.

    Attributes:
        stopped: after how many rounds candidates were stopped, by name.
    """

    def __init__(self, against: str, best: Mapping[int, float], error: float) -> None:
        self.stopped: dict[str, int] = {}
        self._against, self._best, self._error = against, best, error
        self._matches: dict[str, list[PlayedMatch]] = {}

    def take(self, match: PlayedMatch) -> None:
        """Take in a match of one of the candidates."""
        name = self._candidate(match.fixture)
        self._matches.setdefault(name, []).append(match)
        self.scores(name)

    def needless(self, fixture: Fixture) -> bool:
        """Return whether a match need not be played any more."""
        return self._candidate(fixture) in self.stopped

    def matches(self, name: str) -> list[PlayedMatch]:
        """Return the matches of a candidate."""
        return self._matches.get(name, [])

    def scores(self, name: str, failed: Collection[Fixture] = ()) -> dict[int, float]:
        """Return what a candidate scores, 0 to 1, by round, up to where it was stopped.

        Args:
            name: of the candidate.
            failed: matches that could not be played.
        """
        found = scores_of(self.matches(name), name, self._against, failed)
        numbers = list(found)
        paired = [place for place, number in enumerate(numbers) if number in self._best]
        worse = [
            surely_negative([2.0 * score - 1.0 for score in found.values()], self._error),
            surely_negative(
                [found[numbers[place]] - self._best[numbers[place]] for place in paired], self._error
            ),
        ]
        ends = [end for end in (worse[0], worse[1] and paired[worse[1] - 1] + 1) if end is not None]
        if ends:
            self.stopped[name] = min(ends)
        return {number: found[number] for number in numbers[: self.stopped.get(name)]}

    def _candidate(self, fixture: Fixture) -> str:
        return fixture.blue if fixture.yellow == self._against else fixture.yellow
