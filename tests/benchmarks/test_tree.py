"""What the benchmark ticks is what it says it ticks. Times are not looked at."""

from __future__ import annotations

from typing import Any

from py_trees.blackboard import Blackboard
from py_trees.common import Status
from py_trees.trees import BehaviourTree
from py_trees.visitors import SnapshotVisitor

from benchmarks import tree as bench
from robobt.tree import TreeRunner, preorder


def test_it_measures_all_cases_and_leaves_nothing_on_the_blackboard() -> None:
    before = (dict(Blackboard.storage), set(Blackboard.clients), set(Blackboard.metadata))
    figures = bench.bench_tree(rounds=1, ticks=20)
    assert set(figures) == {
        "speedup_vs_py_trees",
        "ratio_to_plain_classes",
        "store_speedup_vs_blackboard",
        "py_trees_us",
        "runner_us",
        "plain_us",
        "py_trees_blackboard_us",
        "runner_store_us",
    }
    assert all(figure > 0.0 for figure in figures.values())
    assert before == (Blackboard.storage, set(Blackboard.clients), set(Blackboard.metadata))


def test_the_tree_has_30_nodes_that_are_all_visited_at_every_tick() -> None:
    root = bench._tree(bench._Idle)
    tree, visitor = BehaviourTree(root), SnapshotVisitor()
    tree.add_visitor(visitor)
    for _ in range(3):
        tree.tick()
        assert len(visitor.visited) == 30
        assert sorted({status.value for status in visitor.visited.values()}) == [
            "FAILURE",
            "RUNNING",
            "SUCCESS",
        ]


def plain_nodes(node: Any) -> list[Any]:
    return [node] + [below for child in getattr(node, "children", []) for below in plain_nodes(child)]


def test_all_cases_come_to_the_same_statuses() -> None:
    stock = bench._tree(bench._Idle)
    ours = bench._tree(bench._IdleLeaf)
    plain = bench._plain_tree()
    tick = TreeRunner(ours, None).tick
    for _ in range(3):
        stock.tick_once()
        tick()
        plain.tick()
        statuses = [node.status for node in preorder(stock)]
        assert statuses == [node.status for node in preorder(ours)]
        assert statuses == [node.status for node in plain_nodes(plain)]
        assert statuses.count(Status.INVALID) == 0


def test_a_plain_leaf_lives_as_a_py_trees_leaf_does() -> None:
    calls: list[Any] = []

    class Told(bench._PlainIdle):
        def initialise(self) -> None:
            calls.append("initialise")

        def terminate(self, new_status: Status) -> None:
            calls.append(new_status)

    root = bench._PlainSequence([Told(Status.SUCCESS), bench._PlainIdle(Status.FAILURE)])
    root.tick()
    root.tick()
    once = ["initialise", Status.SUCCESS]
    assert calls == [*once, Status.INVALID, *once]


def test_the_store_and_the_blackboard_are_read_and_written() -> None:
    entries = bench._Entries()
    entries.count = 5
    TreeRunner(bench._OnStore(Status.SUCCESS), entries).tick()
    assert entries.last == 5
    clients: list[Any] = []
    try:
        leaf = bench._OnBlackboard(Status.SUCCESS, clients)
        leaf.tick_once()
        assert Blackboard.storage["/robobt_bench/last"] == Blackboard.storage["/robobt_bench/count"] == 1
    finally:
        for client in clients:
            client.unregister()
