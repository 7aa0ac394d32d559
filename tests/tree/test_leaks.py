"""Trees come and go, as when matches are played by the thousand, and nothing of them stays."""

from __future__ import annotations

import gc
import sys

import pytest
from py_trees.blackboard import Blackboard
from py_trees.common import ParallelPolicy

from robobt.tree import Behaviour, Inverter, Parallel, Repeat, Selector, Sequence, TreeRunner
from robobt.tree.nodes import CommitFor, CommittingSelector, Cooldown, ParallelCount, TickDivider, Timeout
from tests.tree.scripted import Notes, Scripted


def build() -> Behaviour:
    """About 30 nodes, of the package and of py_trees."""
    branches: list[Behaviour] = []
    for number in range(3):
        scripts = {"a": "SF", "b": "RS", "c": "SR"}
        leaves = [Scripted(f"{number}{letter}", script) for letter, script in scripts.items()]
        branches.append(Sequence(f"{number}s", memory=bool(number % 2), children=leaves))
        branches.append(Cooldown(f"{number}c", Scripted(f"{number}d", "FS"), seconds=0.1))
    policy = ParallelPolicy.SuccessOnAll()
    return Selector(
        "root",
        memory=False,
        children=[
            Inverter("i", Timeout("t", Repeat("r", Scripted("x", "SRS"), 2), seconds=0.3)),
            ParallelCount("p", children=[TickDivider("n", Scripted("y", "RF"), every=2), Scripted("z", "F")]),
            CommittingSelector("k", [CommitFor("f", branch, seconds=0.2) for branch in branches]),
            Parallel("q", policy, [Scripted("u", "R"), Scripted("v", "R")]),
        ],
    )


def live_and_die(count: int) -> None:
    for _ in range(count):
        store = Notes()
        runner = TreeRunner(build(), store)
        for tick in range(3):
            store.time = 0.1 * tick
            runner.tick()


@pytest.mark.integration
def test_hundreds_of_trees_leave_nothing_behind() -> None:
    live_and_die(20)
    gc.collect()
    keys, clients = dict(Blackboard.storage), set(Blackboard.clients)
    objects, blocks = len(gc.get_objects()), sys.getallocatedblocks()
    live_and_die(300)
    gc.collect()
    # A single tree is some 300 objects; a few come and go with whatever else lives in the process.
    assert len(gc.get_objects()) - objects < 100
    assert sys.getallocatedblocks() - blocks < 1000
    assert (keys, clients) == (Blackboard.storage, set(Blackboard.clients))
