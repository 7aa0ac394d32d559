"""Every node's ticks, changes, statuses and time are counted, whoever ticks the tree."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from py_trees.trees import BehaviourTree

from robobt.tree import Behaviour, FastTree, Inverter, Selector, Sequence, Status, TreeRunner, bind
from robobt.tree.devtools import NodeCounts, NodeStatistics
from tests.tree.scripted import Notes, Scripted, scripted


def tree() -> Behaviour:
    """root: (guard, inner), other."""
    pair = Sequence("pair", memory=False, children=scripted(guard="SSFS", inner="RSRR"))
    return Selector("root", memory=False, children=[pair, Scripted("other", "S")])


def watch(root: Behaviour, ticks: int, clock: Callable[[], float] | None = None) -> NodeStatistics:
    statistics = NodeStatistics(root) if clock is None else NodeStatistics(root, clock)
    runner = TreeRunner(root, Notes())
    runner.show_to(statistics)
    for _ in range(ticks):
        runner.tick()
    return statistics


def named(statistics: NodeStatistics, path: str) -> NodeCounts:
    (one,) = [count for count in statistics.counts() if count.path == path]
    return one


def test_ticks_and_statuses_are_counted() -> None:
    statistics = watch(tree(), 4)
    found = {one.path: (one.ticks, one.successes, one.failures, one.runs) for one in statistics.counts()}
    assert found == {
        "root": (4, 2, 0, 2),
        "root/pair": (4, 1, 1, 2),
        "root/pair/guard": (4, 3, 1, 0),
        "root/pair/inner": (3, 1, 0, 2),
        "root/other": (1, 1, 0, 0),
    }


def test_a_transition_is_another_status_than_at_the_tick_before() -> None:
    statistics = watch(tree(), 4)
    found = {one.path.rpartition("/")[2]: one.transitions for one in statistics.counts()}
    # guard SSFS, inner RS-R, pair RSFR, root RSSR; a node that is not ticked changes nothing.
    assert found == {"guard": 2, "inner": 2, "pair": 3, "root": 2, "other": 0}


def test_a_node_never_ticked_is_there_with_zeros() -> None:
    assert named(watch(tree(), 1), "root/other") == NodeCounts("root/other")


def test_the_time_of_a_node_is_its_own_and_that_of_what_is_below() -> None:
    now = 0.0

    class Slow(Scripted):
        def on_running(self) -> Status:
            nonlocal now
            now += float(self.name)
            return super().on_running()

    inner = Sequence("inner", memory=False, children=[Slow("1", "S"), Slow("2", "S")])
    root = Sequence("root", memory=False, children=[inner, Slow("4", "S")])
    statistics = watch(root, 3, lambda: now)
    times = {one.path: (one.own_time, one.time) for one in statistics.counts()}
    assert times == {
        "root": (0.0, 21.0),
        "root/inner": (0.0, 9.0),
        "root/inner/1": (3.0, 3.0),
        "root/inner/2": (6.0, 6.0),
        "root/4": (12.0, 12.0),
    }
    assert statistics.as_table().splitlines()[1].split()[-1] == "7000000.0"


def test_what_passes_between_two_ticks_is_no_nodes_time() -> None:
    clock = iter(range(1000))
    statistics = watch(Inverter("not", Scripted("leaf", "S")), 5, lambda: float(next(clock)))
    assert [one.own_time for one in statistics.counts()] == [5.0, 5.0]


@pytest.mark.parametrize("kind", [BehaviourTree, FastTree])
def test_as_a_visitor_of_py_trees_it_counts_the_same(kind: type[BehaviourTree]) -> None:
    root = tree()
    bind(root, Notes())
    statistics = NodeStatistics(root, lambda: 0.0)
    behaviours = kind(root)
    behaviours.visitors.append(statistics)
    for _ in range(4):
        behaviours.tick()
    assert statistics.counts() == watch(tree(), 4, lambda: 0.0).counts()


def test_statuses_add_up_to_ticks_whatever_the_scripts() -> None:
    rng = random.Random(1)
    leaves = [Scripted(str(i), "".join(rng.choices("SFR", k=200))) for i in range(5)]
    root = Selector("root", memory=False, children=[*leaves[:2], Sequence("s", True, leaves[2:])])
    counts = watch(root, 200).counts()
    assert all(one.ticks == one.successes + one.failures + one.runs for one in counts)
    assert counts[0].ticks == 200


def test_a_node_that_raises_spoils_nothing() -> None:
    statistics = watch(Scripted("leaf", "S!S"), 3)
    assert named(statistics, "leaf").ticks == 2


def test_reset_forgets() -> None:
    statistics = watch(tree(), 4)
    statistics.reset()
    assert {one.ticks for one in statistics.counts()} == {0}


def test_the_table_has_a_line_a_node_indented_as_the_tree() -> None:
    table = watch(tree(), 4, lambda: 0.0).as_table().splitlines()
    assert [line[:9].rstrip() for line in table] == [
        "node",
        "root",
        "  pair",
        "    guard",
        "    inner",
        "  other",
    ]
    assert table[3].split() == ["guard", "4", "2", "75.0", "%", "25.0", "%", "0.0", "%", "0.0"]
    assert watch(tree(), 0).as_table().splitlines()[1].split() == ["root", "0", "0", "-", "-", "-", "-"]
    assert len({len(line) for line in table}) == 1
