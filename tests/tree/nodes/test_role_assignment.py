from __future__ import annotations

from itertools import permutations
from math import inf, nan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.tree.nodes import assign_roles

COSTS = st.lists(
    st.lists(st.one_of(st.integers(-20, 20).map(float), st.just(inf)), min_size=3, max_size=3),
    min_size=1,
    max_size=4,
)


def named(costs: list[list[float]]) -> dict[int, dict[str, float]]:
    return {number: dict(zip("xyz", row, strict=True)) for number, row in enumerate(costs)}


def by_trying(costs: dict[int, dict[str, float]]) -> tuple[int, float]:
    """The most roles that can be filled, and the least that costs."""
    slots: list[str | None] = [*"xyz", *[None] * len(costs)]
    best = (0, 0.0)
    for order in permutations(slots, len(costs)):
        chosen = [costs[number][role] for number, role in enumerate(order) if role is not None]
        chosen = [cost for cost in chosen if cost != inf]
        best = min(best, (-len(chosen), sum(chosen)))
    return -best[0], best[1]


@settings(deadline=None)  # The first call imports scipy.
@given(COSTS)
def test_most_roles_are_filled_for_the_least_cost(costs: list[list[float]]) -> None:
    table = named(costs)
    found = assign_roles(table, {}, margin=0.0)
    assert len(set(found.values())) == len(found)
    filled, least = by_trying(table)
    assert len(found) == filled
    assert sum(table[number][role] for number, role in found.items()) == least


@settings(deadline=None)
@given(COSTS, COSTS, st.integers(0, 30))
def test_an_assignment_changes_only_for_more_than_the_margin(
    before: list[list[float]], after: list[list[float]], margin: int
) -> None:
    current = assign_roles(named(before), {}, margin=0.0)
    table = named(after)
    found = assign_roles(table, current, margin=margin)
    least = assign_roles(table, {}, margin=0.0)
    total = sum(table[number][role] for number, role in found.items())
    gain = total - sum(table[number][role] for number, role in least.items())
    assert len(found) == len(least)
    assert 0.0 <= gain <= margin
    if found != least:
        assert found == {n: role for n, role in current.items() if table.get(n, {}).get(role, inf) != inf}


def test_small_gains_do_not_add_up_to_a_change() -> None:
    current = {1: "x", 2: "y"}
    for _ in range(10):
        found = assign_roles({1: {"x": 1.2, "y": 1.0}, 2: {"x": 1.0, "y": 1.2}}, current, margin=0.5)
        assert found == current


def test_a_player_or_role_that_is_gone_does_not_matter() -> None:
    costs = {1: {"x": 1.0, "y": 2.0}, 2: {"x": 5.0, "y": 5.0}}
    assert assign_roles(costs, {3: "x", 1: "goalkeeper"}, margin=100.0) == {1: "x", 2: "y"}


def test_a_newcomer_with_a_free_role_gets_it_whatever_the_margin() -> None:
    costs = {1: {"x": 1.0, "y": 9.0}, 2: {"x": 1.0, "y": 9.0}}
    assert assign_roles(costs, {1: "x"}, margin=100.0).keys() == {1, 2}


def test_a_role_nobody_can_play_stays_open() -> None:
    assert assign_roles({1: {"x": inf}, 2: {}}, {}, margin=0.0) == {}
    assert assign_roles({1: {"x": inf, "y": 1.0}, 2: {"x": inf, "y": 2.0}}, {}, margin=0.0) == {1: "y"}
    assert assign_roles({}, {1: "x"}, margin=0.0) == {}


def test_a_role_a_player_can_play_no_more_is_taken_from_it() -> None:
    costs = {1: {"x": inf, "y": 1.0}, 2: {"x": 1.0, "y": 1.0}}
    assert assign_roles(costs, {1: "x", 2: "y"}, margin=100.0) == {1: "y", 2: "x"}


def test_what_is_no_cost_is_an_error() -> None:
    with pytest.raises(ValueError, match="the cost of x for 1 is nan"):
        assign_roles({1: {"x": nan}}, {}, margin=0.0)
    with pytest.raises(ValueError, match="the cost of x for 1 is -inf"):
        assign_roles({1: {"x": -inf}}, {}, margin=0.0)
    with pytest.raises(ValueError, match="margin must be 0 or more, not -1"):
        assign_roles({}, {}, margin=-1.0)
