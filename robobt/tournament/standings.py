"""The results of a tournament: ratings, figures of each entrant, and tests of each encounter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import combinations
from statistics import fmean

from robobt.config.wording import counted
from robobt.match.results.teams import TeamResult
from robobt.statistics import holm, mcnemar, mean_interval
from robobt.tournament.fixtures import Fixture
from robobt.tournament.played import PlayedMatch
from robobt.tournament.ratings import Rating, bradley_terry

FIGURES = tuple(figure.name for figure in fields(TeamResult))
"""Figures of a team whose mean a match is given for each entrant."""


@dataclass(slots=True, frozen=True)
class Standing:
    """One entrant's figures.

    Attributes:
        matches: how many it played; ``won``, ``drawn`` and ``lost`` of them.
        forfeits: matches it lost by rule, because what it plays crashed or hung.
        goals_for, goals_against: of all its matches together.
        rating: its strength, and ``low`` and ``high`` its 95 % interval [Elo].
        figures: means a match, by their names in :data:`FIGURES`.
        errors: ticks in which a robot's tree failed; ``first_error`` is the first, None without one.
    """

    matches: int
    won: int
    drawn: int
    lost: int
    forfeits: int
    goals_for: int
    goals_against: int
    rating: Rating
    figures: Mapping[str, float]
    errors: int
    first_error: str | None


@dataclass(slots=True, frozen=True)
class Encounter:
    """Two entrants against each other, seen from the first.

    Attributes:
        first, second: their names.
        matches: how many they played; the first ``won``, ``drawn`` and ``lost``.
        goals_for, goals_against: the first one's.
        lead: goals by which the first wins, a match, over the rounds that both sides of are played; None
            without one. ``low`` and ``high`` are its 95 % interval, None where rounds do not differ.
        rounds_won, rounds_lost: rounds in whose two matches the first has more, and fewer, points.
        p: of the exact test that each is as often ahead in a round, two-sided.
        holm: p corrected for the number of encounters.
    """

    first: str
    second: str
    matches: int
    won: int
    drawn: int
    lost: int
    goals_for: int
    goals_against: int
    lead: float | None
    low: float | None
    high: float | None
    rounds_won: int
    rounds_lost: int
    p: float
    holm: float


@dataclass(slots=True, frozen=True)
class Standings:
    """The results of a tournament.

    Attributes:
        matches: how many were played.
        distinct: how many of them differ from each other; the rest repeat one another.
        standings: by entrant, the best first.
        encounters: every pairing that has met.
    """

    matches: int
    distinct: int
    standings: Mapping[str, Standing]
    encounters: Sequence[Encounter]

    def remarks(self) -> list[str]:
        """Return notes for the reader: repeated matches, forfeits, failures of trees."""
        found = []
        if self.distinct < self.matches:
            found.append(
                f"only {self.distinct} of {counted(self.matches, 'match', 'matches')} differ; "
                "vary the starts or add noise, as with --set simulator.realism=friendly"
            )
        for name, one in self.standings.items():
            if one.forfeits:
                found.append(
                    f"{name}: lost {counted(one.forfeits, 'match', 'matches')} by rule; "
                    f"the first: {one.first_error}"
                )
            if one.errors:
                found.append(
                    f"{name}: trees failed in {counted(one.errors, 'tick')}; the first: {one.first_error}"
                )
        return found


def standings_of(
    matches: Sequence[PlayedMatch], names: Sequence[str], reference: str | None = None
) -> Standings:
    """Return the table of a tournament: each entrant's figures and rating, and each encounter.

    Matches that repeat another one move for move count once for ratings, intervals and
    tests: they tell nothing new.

    Args:
        matches: what was played.
        names: the entrants.
        reference: whose rating is 0; by default the mean of all ratings is.
    """
    new = distinct(matches)
    ratings = bradley_terry(
        names, [(match.blue, match.yellow, match.score(match.blue)) for match in new], reference
    )
    found = []
    for first, second in combinations(names, 2):
        met = [match for match in matches if {match.blue, match.yellow} == {first, second}]
        if met:
            found.append(_encounter(first, second, met))
    corrected = holm([encounter.p for encounter in found])
    return Standings(
        len(matches),
        len(new),
        {
            name: _standing(name, matches, ratings[name])
            for name in sorted(names, key=lambda name: -ratings[name].elo)
        },
        [replace(encounter, holm=p) for encounter, p in zip(found, corrected, strict=True)],
    )


def distinct(matches: Iterable[PlayedMatch]) -> list[PlayedMatch]:
    """Return the matches without those that repeat another one of the same sides move for move."""
    found = {(match.blue, match.yellow, match.trace or match.round): match for match in reversed([*matches])}
    return [*reversed(found.values())]


@dataclass(slots=True, frozen=True)
class Paired:
    """Two entrants compared by their matches against common opponents, from the same sides and seeds.

    Attributes:
        first, second: their names.
        opponents: the common opponents.
        rounds: of how many rounds and opponents, those that repeat another one counted once.
        lead: goals a match by which the first did better than the second; None without a round.
        low, high: its 95 % interval; None where rounds do not differ.
        ahead, behind: rounds in which the first made more points than the second, and fewer.
        p: of the exact test that each is as often ahead, two-sided.
    """

    first: str
    second: str
    opponents: Sequence[str]
    rounds: int
    lead: float | None
    low: float | None
    high: float | None
    ahead: int
    behind: int
    p: float


def paired(matches: Sequence[PlayedMatch], first: str, second: str) -> Paired:
    """Compare two entrants by their matches against others."""
    by = {match.fixture: match for match in matches}
    units: dict[tuple[str, int], list[tuple[PlayedMatch, PlayedMatch]]] = {}
    for match in matches:
        if first in (match.blue, match.yellow) and second not in (match.blue, match.yellow):
            sides = [second if name == first else name for name in (match.blue, match.yellow)]
            other = by.get(Fixture(sides[0], sides[1], match.round))
            if other is not None:
                opponent = match.yellow if match.blue == first else match.blue
                units.setdefault((opponent, match.round), []).append((match, other))
    new = {
        (opponent, *[(a.blue == first, a.trace or number, b.trace or number) for a, b in both]): both
        for (opponent, number), both in units.items()
    }
    points = [sum(a.score(first) - b.score(second) for a, b in both) for both in new.values()]
    leads = [fmean(a.lead(first) - b.lead(second) for a, b in both) for both in new.values()]
    interval = mean_interval(leads) if len(set(leads)) > 1 else None
    test = mcnemar([one > 0.0 for one in points], [one < 0.0 for one in points])
    return Paired(
        first,
        second,
        sorted({opponent for opponent, _ in units}),
        len(new),
        fmean(leads) if leads else None,
        None if interval is None else interval.low,
        None if interval is None else interval.high,
        test.only_first,
        test.only_second,
        test.p,
    )


def rounds_of(matches: Iterable[PlayedMatch], first: str, second: str) -> dict[int, list[PlayedMatch]]:
    """Return both matches of each round that two entrants have played from either side, in order."""
    met: dict[int, list[PlayedMatch]] = {}
    for match in sorted(matches, key=lambda match: (match.round, match.blue != first)):
        if {match.blue, match.yellow} == {first, second}:
            met.setdefault(match.round, []).append(match)
    return {number: pair for number, pair in met.items() if len(pair) == 2}


def _encounter(first: str, second: str, met: Sequence[PlayedMatch]) -> Encounter:
    rounds = {
        tuple([match.trace or match.round for match in pair]): pair
        for pair in rounds_of(met, first, second).values()
    }
    points = [sum(match.score(first) for match in pair) for pair in rounds.values()]
    leads = [fmean(match.lead(first) for match in pair) for pair in rounds.values()]
    interval = mean_interval(leads) if len(set(leads)) > 1 else None
    test = mcnemar([one > 1.0 for one in points], [one < 1.0 for one in points])
    results = [match.score(first) for match in met]
    return Encounter(
        first,
        second,
        len(met),
        won=results.count(1.0),
        drawn=results.count(0.5),
        lost=results.count(0.0),
        goals_for=sum(match.goals(first) for match in met),
        goals_against=sum(match.goals(second) for match in met),
        lead=fmean(leads) if leads else None,
        low=None if interval is None else interval.low,
        high=None if interval is None else interval.high,
        rounds_won=test.only_first,
        rounds_lost=test.only_second,
        p=test.p,
        holm=test.p,
    )


def _standing(name: str, matches: Sequence[PlayedMatch], rating: Rating) -> Standing:
    own = [match for match in matches if name in (match.blue, match.yellow)]
    sides = [match.side(name) for match in own]
    results = [match.score(name) for match in own]
    return Standing(
        len(own),
        won=results.count(1.0),
        drawn=results.count(0.5),
        lost=results.count(0.0),
        forfeits=sum(match.forfeited_by == name for match in own),
        goals_for=sum(match.goals(name) for match in own),
        goals_against=sum(match.goals(name) - match.lead(name) for match in own),
        rating=rating,
        figures={
            figure: fmean(getattr(side, figure) for side in sides) if sides else 0.0 for figure in FIGURES
        },
        errors=sum(side.errors for side in sides),
        first_error=next((side.first_error for side in sides if side.first_error is not None), None),
    )
