"""No node of a random tree ever comes to a status that ``outcomes`` says it cannot come to."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from py_trees import decorators as stock
from py_trees.common import OneShotPolicy, ParallelPolicy

from robobt.tree import Behaviour, Leaf, Parallel, Selector, Sequence, Status, TreeRunner, nodes, preorder
from robobt.tree.devtools import outcomes
from tests.tree.scripted import Notes

S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING

COMPOSITES: list[Callable[[random.Random, list[Behaviour]], Behaviour]] = [
    lambda rng, made: Sequence("sequence", rng.random() < 0.5, made),
    lambda rng, made: Selector("selector", rng.random() < 0.5, made),
    lambda rng, made: nodes.SequenceWithMemory("with memory", made),
    lambda rng, made: nodes.CommittingSelector("committing", made),
    lambda rng, made: Parallel("on all", ParallelPolicy.SuccessOnAll(rng.random() < 0.5), made),
    lambda rng, made: Parallel("on one", ParallelPolicy.SuccessOnOne(), made),
    lambda rng, made: Parallel("selected", ParallelPolicy.SuccessOnSelected(made[:1], False), made),
    lambda rng, made: nodes.ParallelCount("count", children=made),
]

DECORATORS: list[Callable[[random.Random, Behaviour], Behaviour]] = [
    *(lambda rng, made, kind=kind: kind("stock", made) for kind in (
        stock.Count,
        stock.FailureIsRunning,
        stock.FailureIsSuccess,
        stock.Inverter,
        stock.PassThrough,
        stock.RunningIsFailure,
        stock.RunningIsSuccess,
        stock.SuccessIsFailure,
        stock.SuccessIsRunning,
    )),
    lambda rng, made: stock.Condition("condition", made, rng.choice((S, F, R))),
    lambda rng, made: stock.EternalGuard("guard", made, condition=lambda: rng.random() < 0.7),
    lambda rng, made: stock.OneShot("one shot", made, rng.choice(list(OneShotPolicy))),
    lambda rng, made: stock.Repeat("repeat", made, rng.choice((-1, 1, 2, 3))),
    lambda rng, made: stock.Retry("retry", made, rng.choice((-1, 1, 2, 3))),
    lambda rng, made: nodes.Cooldown("cooldown", made, seconds=2.0),
    lambda rng, made: nodes.Delay("delay", made, seconds=2.0),
    lambda rng, made: nodes.HoldSuccess("hold", made, seconds=2.0),
    lambda rng, made: nodes.TickDivider("divider", made, every=2),
    lambda rng, made: nodes.Timeout("timeout", made, seconds=2.0),
]  # fmt: skip


class Choosing(Leaf[Notes]):
    """Comes to any of its outcomes."""

    def __init__(self, name: str, rng: random.Random) -> None:
        super().__init__(name)
        self.outcomes = frozenset(rng.sample((S, F, R), rng.randint(1, 3)))
        self.rng = rng

    def on_running(self) -> Status:
        return self.rng.choice(sorted(self.outcomes, key=str))


def random_tree(rng: random.Random, depth: int) -> Behaviour:
    kind = rng.random()
    if depth == 0 or kind < 0.15:
        return Choosing("leaf", rng)
    if kind < 0.55:
        return rng.choice(DECORATORS)(rng, random_tree(rng, depth - 1))
    return rng.choice(COMPOSITES)(rng, [random_tree(rng, depth - 1) for _ in range(rng.randint(1, 3))])


@pytest.mark.parametrize("seed", range(10))
def test_no_node_surprises(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(300):
        store = Notes()
        runner = TreeRunner(random_tree(rng, 4), store, on_error="raise")
        possible = {node: outcomes(node) | {Status.INVALID} for node in preorder(runner.root)}
        for tick in range(30):
            store.time = float(tick)
            runner.tick()
            for node, statuses in possible.items():
                assert node.status in statuses, (node, runner.root)
            if rng.random() < 0.1:
                runner.stop()


@pytest.mark.parametrize("seed", range(3))
def test_what_is_possible_is_not_overstated_for_chains_of_leaves(seed: int) -> None:
    rng = random.Random(seed)
    for kind in (Sequence, Selector):
        root = kind("chain", False, [Choosing(f"{place}", rng) for place in range(3)])
        runner = TreeRunner(root, Notes())
        assert {runner.tick() for _ in range(500)} == outcomes(root)
