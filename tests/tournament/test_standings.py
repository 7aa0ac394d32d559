"""What a tournament says."""

from __future__ import annotations

import pytest

from robobt.tournament.standings import distinct, rounds_of, standings_of
from tests.tournament.made_up import played


def pair(number: int, first: tuple[int, int], second: tuple[int, int]) -> list:  # type: ignore[type-arg]
    """A round of a and b: the goals of a and b with a blue, and with a yellow."""
    return [played("a", "b", number, first), played("b", "a", number, (second[1], second[0]))]


def test_figures_are_counted_for_each_entrant_on_either_side() -> None:
    third = played("a", "b", 1, (0, 1), passes=10, passes_completed=7, errors=2)
    matches = [*pair(0, (2, 1), (3, 3)), third]
    found = standings_of(matches, ["a", "b"])
    a, b = found.standings["a"], found.standings["b"]
    assert (a.matches, a.won, a.drawn, a.lost, a.goals_for, a.goals_against) == (3, 1, 1, 1, 5, 5)
    assert (b.matches, b.won, b.drawn, b.lost) == (3, 1, 1, 1)
    assert a.figures["passes"] == pytest.approx(10 / 3)
    assert (a.errors, b.errors) == (2, 0)


def test_an_encounter_is_judged_by_rounds() -> None:
    matches = [match for number in range(6) for match in pair(number, (2, 0), (1, 1))]
    matches += pair(6, (0, 1), (0, 1)) + pair(7, (1, 0), (0, 1))
    (met,) = standings_of(matches, ["a", "b"]).encounters
    assert (met.rounds_won, met.rounds_lost) == (6, 1)
    assert met.p == pytest.approx(2 * (1 + 7) / 2**7)
    assert met.lead == pytest.approx((6 * 1.0 - 1.0 + 0.0) / 8)
    assert met.low is not None
    assert met.low < met.lead < met.high


def test_a_round_with_one_match_does_not_count_as_a_round() -> None:
    (met,) = standings_of([played("a", "b", 0, (5, 0))], ["a", "b"]).encounters
    assert (met.matches, met.rounds_won, met.lead, met.p) == (1, 0, None, 1.0)


def test_p_values_are_corrected_for_the_number_of_encounters() -> None:
    names = ["a", "b", "c"]
    matches = [match for number in range(8) for match in pair(number, (1, 0), (1, 0))]
    matches += [played("a", "c", number) for number in range(2)]
    matches += [played("b", "c", number) for number in range(2)]
    met = {(one.first, one.second): one for one in standings_of(matches, names).encounters}
    assert met["a", "b"].p == pytest.approx(2 / 2**8)
    assert met["a", "b"].holm == pytest.approx(3 * 2 / 2**8)


def test_matches_that_repeat_one_another_tell_nothing_new() -> None:
    once = [played("a", "b", 0, (1, 0), trace="x"), played("b", "a", 0, (0, 1), trace="y")]
    often = [
        played(blue, yellow, number, goals, trace=trace)
        for number in range(20)
        for blue, yellow, goals, trace in (("a", "b", (1, 0), "x"), ("b", "a", (0, 1), "y"))
    ]
    one, many = standings_of(once, ["a", "b"]), standings_of(often, ["a", "b"])
    assert (many.matches, many.distinct) == (40, 2)
    assert many.standings["a"].rating == one.standings["a"].rating
    assert (many.encounters[0].rounds_won, many.encounters[0].p) == (1, 1.0)
    assert many.encounters[0].low is None


def test_a_forfeit_is_lost_whatever_the_score() -> None:
    match = played("a", "b", 0, (3, 0), outcome="forfeit_blue", trace="")
    assert (match.forfeited_by, match.score("a"), match.score("b")) == ("a", 0.0, 1.0)
    found = standings_of([match, played("a", "b", 1, outcome="forfeit_blue", trace="")], ["a", "b"])
    assert (found.standings["a"].forfeits, found.standings["a"].lost, found.distinct) == (2, 2, 2)


def test_rounds_have_both_matches_the_first_one_blue_first() -> None:
    matches = [*reversed(pair(0, (1, 0), (0, 0))), played("b", "a", 1), played("a", "c", 0)]
    ((number, both),) = rounds_of(matches, "a", "b").items()
    assert number == 0
    assert [match.blue for match in both] == ["a", "b"]


def test_the_first_of_equal_matches_is_the_one_that_counts() -> None:
    matches = [played("a", "b", number, trace="x") for number in range(3)]
    assert [match.round for match in distinct(matches)] == [0]


def test_entrants_are_listed_the_best_first() -> None:
    matches = [played("a", "b", number, (0, 2)) for number in range(3)]
    assert list(standings_of(matches, ["a", "b"]).standings) == ["b", "a"]
