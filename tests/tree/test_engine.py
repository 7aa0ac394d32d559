"""The compiled tick does to a tree exactly what py_trees' own tick does."""

from __future__ import annotations

import inspect
import random
import textwrap
import time
from typing import Any

import py_trees
import pytest
from py_trees.behaviour import Behaviour
from py_trees.behaviours import Success
from py_trees.common import Status
from py_trees.composites import Selector, Sequence
from py_trees.decorators import Inverter
from py_trees.trees import BehaviourTree
from py_trees.visitors import SnapshotVisitor

from robobt.tree import TreeError, TreeRunner, bind
from robobt.tree.engine import FastTree, compile_tree, composites, dispatch, leaves, plan
from robobt.tree.nodes import CommittingSelector, Cooldown, Gate, ParallelCount, SequenceWithMemory, Switch
from robobt.tree.recording import node_ids
from robobt.tree.runner import preorder
from tests.tree.random_trees import Log, Told, random_tree

S, F, R, INVALID = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID


@pytest.fixture(autouse=True)
def _quiet_and_clean(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr("py_trees.decorators.time.monotonic", lambda: 1000.0)
    monkeypatch.setattr("py_trees.logging.Logger.error", lambda *_: None)
    yield
    py_trees.blackboard.Blackboard.clear()


class Clock:
    """A store that has nothing but the time."""

    time = 0.0


def state(root: Behaviour) -> list[Any]:
    """Everything that can be seen of a tree after a tick."""
    tip = root.tip()
    nodes = [
        (
            node.name,
            node.status,
            node.feedback_message,
            getattr(getattr(node, "current_child", None), "name", None),
        )
        for node in root.iterate()
    ]
    return [tip.name if tip is not None else None, *nodes]


def first_difference(seed: int, ticks: int) -> str | None:
    """Tick two copies of a random tree, one by each engine; where they first differ."""
    rng = random.Random(seed)
    recipe = random_tree(rng, "n")
    logs: list[Log] = [[], []]
    stock, compiled = recipe(logs[0], f"a{seed}"), recipe(logs[1], f"b{seed}")
    visits: list[Log] = [[], []]
    clock = Clock()
    bind(stock, clock)
    bind(compiled, clock)
    # A tree that nobody visits is ticked by shorter ways.
    watched = seed % 2 == 0
    tick = compile_tree(
        compiled, (lambda node: visits[1].append((node.name, node.status))) if watched else None
    )
    for count in range(ticks):
        clock.time = round(clock.time + 0.1, 9) if rng.random() < 0.97 else 0.0
        for node in stock.tick():
            if watched:
                visits[0].append((node.name, node.status))
        tick()
        if rng.random() < 0.05:
            stock.stop(INVALID)
            compiled.stop(INVALID)
        pairs = [("visits", visits), ("calls", logs), ("states", [state(stock), state(compiled)])]
        for what, (expected, found) in pairs:
            if expected != found:
                return f"seed {seed}, tick {count}, {what}: {expected} != {found}"
        for told in (*visits, *logs):
            told.clear()
    return None


@pytest.mark.integration
@pytest.mark.parametrize(
    "block", [0, *(pytest.param(block, marks=pytest.mark.slow) for block in range(1, 8))]
)
def test_random_trees_live_the_same_life(block: int) -> None:
    """25 000 ticks a block, of 1000 trees: as many as show every planted fault below."""
    for seed in range(1000 * block, 1000 * (block + 1)):
        difference = first_difference(seed, 25)
        assert difference is None, difference


MODULES = (leaves, plan, composites)

FAULTS = {
    "a restarted sequence does not reset its children": (
        "sequence_closures",
        "step.stop(INVALID)\n                    else",
        "pass\n                    else",
    ),
    "a restarted sequence does not reset its bare leaves": (
        "sequence_closures",
        "child.status = INVALID",
        "pass",
    ),
    "a bare leaf keeps its old status": ("sequence_closures", "child.status = status", "pass"),
    "a bare leaf of a selector keeps its old status": (
        "selector_closures",
        "child.status = status",
        "pass",
    ),
    "a reactive sequence leaves later siblings running": (
        "sequence_closures",
        "if not node.memory and",
        "if False and",
    ),
    "a selector does not interrupt lower priorities": (
        "selector_closures",
        "if previous is not child:",
        "if False:",
    ),
    "a selector forgets its place": (
        "selector_closures",
        "if node.memory and children:",
        "if False:",
    ),
    "a parallel leaves children running": (
        "_parallel",
        "if step.child.status is RUNNING:",
        "if False:",
    ),
    "a parallel ignores synchronise": (
        "_parallel",
        "if not (synchronise and step.child.status is SUCCESS):",
        "if True:",
    ),
    "a decorator does not stop its child": (
        "decorator_closures",
        "if decorated.status is RUNNING:",
        "if False:",
    ),
    "a leaf is not terminated": (
        "leaf_closures",
        "if terminate is not None and status is not RUNNING:",
        "if False:",
    ),
    "a leaf is initialised at every tick": (
        "leaf_closures",
        "if initialise is not None and node.status is not RUNNING:",
        "if initialise is not None:",
    ),
    "a leaf's start is forgotten": ("lifecycle", '_inherits(node, "on_start")', "True"),
    "a leaf's end is forgotten": ("lifecycle", 'and _inherits(node, "on_done")', ""),
    "a leaf's interruption is forgotten": ("lifecycle", 'and _inherits(node, "on_interrupt")', ""),
    "a leaf's own initialise is forgotten": ("lifecycle", '_inherits(node, "initialise")', "True"),
    "a leaf's own terminate is forgotten": ("lifecycle", '_inherits(node, "terminate") and', ""),
    "a guard is not checked": ("_eternal_guard", "if result:", "if True:"),
    "a generator is ticked to its end": ("_until", "child.status in ends", "False"),
    "an unseen child counts by its status": ("_until", "return otherwise", "return child.status"),
}


@pytest.mark.integration
@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_caught(fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    function, old, new = FAULTS[fault]
    module = next(module for module in MODULES if hasattr(module, function))
    sound = getattr(module, function)
    source = inspect.getsource(sound)
    assert source.count(old) >= 1
    scope = dict(vars(module))
    exec(source.replace(old, new), scope)
    faulty = scope[function]
    known = [known._replace(make=faulty) if known.make is sound else known for known in dispatch._KNOWN_NODES]
    monkeypatch.setattr(dispatch, "_KNOWN_NODES", known)
    for user in MODULES:
        if hasattr(user, function):
            monkeypatch.setattr(user, function, faulty)
    assert any(first_difference(seed, 25) is not None for seed in range(1000))


NODE_FAULTS: dict[str, tuple[Any, str, str]] = {
    "a gate does not reset a child it answers for": (Gate, "elif child.status is not invalid", "elif False"),
    "a gate leaves its child running": (Gate, "if child.status is running or (", "if False and ("),
    "a gate ticks its child all the same": (Gate, "status = answer()", "status = answer() and None"),
    "a gate is initialised at every tick": (Gate, "and self.status is not running", ""),
    "a selector keeps no commitment": (CommittingSelector, "if kept is None", "if True"),
    "a committing selector lets others run on": (
        CommittingSelector,
        "for other in order",
        "for other in [] and order",
    ),
    "a parallel ticks what has finished": (
        ParallelCount,
        "if step.child.status is not Status.SUCCESS and step.child.status is not Status.FAILURE:",
        "if True:",
    ),
    "a count leaves children running": (
        ParallelCount,
        "if step.child.status is Status.RUNNING:",
        "if False:",
    ),
    "a sequence forgets its place": (SequenceWithMemory, "plan[self.place :]", "plan"),
    "a sequence keeps its place for ever": (SequenceWithMemory, "self.place = 0", "pass"),
    "a switch lets the old case run on": (Switch, "if place != chosen", "if False"),
}


@pytest.mark.integration
@pytest.mark.parametrize("fault", NODE_FAULTS)
def test_a_fault_planted_in_a_node_is_caught(fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    cls, old, new = NODE_FAULTS[fault]
    source = textwrap.dedent(inspect.getsource(cls.closures))
    assert source.count(old) == 1
    scope = dict(vars(inspect.getmodule(cls)))
    exec(source.replace(old, new), scope)
    monkeypatch.setattr(cls, "closures", scope["closures"])
    assert any(first_difference(seed, 25) is not None for seed in range(1000))


def test_a_class_with_a_tick_of_its_own_over_closures_is_ticked_through_it() -> None:
    class Counted(SequenceWithMemory):
        ticks = 0

        def tick(self) -> Any:
            self.ticks += 1
            yield from super().tick()

    root = Counted("root", [Told("a", [S], [])])
    compile_tree(root)()
    assert root.ticks == 1


def test_children_may_come_and_go_between_ticks() -> None:
    logs: list[Log] = [[], []]
    roots = [Selector("root", memory=False, children=[Told("a", [F], log)]) for log in logs]
    tick = compile_tree(roots[1])

    def both() -> None:
        roots[0].tick_once()
        tick()
        assert logs[0] == logs[1]
        assert state(roots[0]) == state(roots[1])

    both()
    for root, log in zip(roots, logs, strict=True):
        root.add_child(Told("b", [R], log))
    both()
    for root, log in zip(roots, logs, strict=True):
        root.prepend_child(Told("c", [R, F], log))
    both()
    both()
    for root in roots:
        root.remove_child(root.children[0])
    both()


@pytest.mark.parametrize("make", [Inverter, lambda name, child: Cooldown(name, child, seconds=0.0)])
def test_a_decorators_child_may_be_replaced_between_ticks(make: Any) -> None:
    logs: list[Log] = [[], []]
    roots = [make("root", Told("a", [R], log)) for log in logs]
    for root in roots:
        bind(root, Clock())
    tick = compile_tree(roots[1])
    for script in ([R], [S], [F]):
        roots[0].tick_once()
        tick()
        assert logs[0] == logs[1]
        assert state(roots[0]) == state(roots[1])
        for root, log in zip(roots, logs, strict=True):
            replacement = Told("b", script, log)
            replacement.parent = root
            root.decorated = root.children[0] = replacement
    for root in roots:
        root.stop(INVALID)
    assert logs[0] == logs[1]


def test_a_selector_whose_running_child_is_gone_fails_as_in_py_trees() -> None:
    for ticked_by in (lambda root: root.tick_once(), lambda root: compile_tree(root)()):
        root = Selector("root", memory=True, children=[Told("a", [R], []), Told("b", [S], [])])
        ticked_by(root)
        root.remove_child(root.children[0])
        with pytest.raises(AssertionError):
            ticked_by(root)


def test_visitors_handlers_and_count_work_as_in_py_trees() -> None:
    def build(kind: type[BehaviourTree]) -> tuple[BehaviourTree, SnapshotVisitor, list[str]]:
        log: Log = []
        root = Selector(
            "root",
            memory=False,
            children=[
                Sequence("s", memory=False, children=[Told("a", [S], log), Told("b", [F, R], log)]),
                Told("c", [R], log),
            ],
        )
        tree, seen, calls = kind(root), SnapshotVisitor(), []
        tree.visitors.append(seen)
        tree.add_pre_tick_handler(lambda _: calls.append("pre"))
        tree.add_post_tick_handler(lambda _: calls.append("post"))
        return tree, seen, calls

    (stock, stock_seen, stock_calls), (fast, fast_seen, fast_calls) = build(BehaviourTree), build(FastTree)
    for _ in range(4):
        stock.tick()
        fast.tick()
        names = [{node.id: node.name for node in tree.root.iterate()} for tree in (stock, fast)]
        seen = [
            {names[i][key]: status for key, status in visitor.visited.items()}
            for i, visitor in enumerate((stock_seen, fast_seen))
        ]
        assert seen[0] == seen[1]
        assert py_trees.display.unicode_tree(fast.root, show_status=True) == py_trees.display.unicode_tree(
            stock.root, show_status=True
        )
    assert stock_calls == fast_calls
    assert stock.count == fast.count == 4


def test_an_interrupted_tree_stops_tick_tocking() -> None:
    tree = FastTree(Told("a", [R], []))
    tree.add_post_tick_handler(lambda t: t.interrupt() if t.count >= 2 else None)
    tree.tick_tock(period_ms=1, number_of_iterations=50)
    assert tree.count == 3


def test_an_exception_comes_through_as_it_is() -> None:
    class Bad(Behaviour):
        def update(self) -> Status:
            raise KeyError("x")

    with pytest.raises(KeyError):
        compile_tree(Sequence("s", memory=False, children=[Bad("bad")]))()


@pytest.mark.integration
@pytest.mark.parametrize("depth", [200, 201, 500, 20_000])
def test_a_tree_that_is_too_deep_is_told_so(depth: int) -> None:
    root: Behaviour = Success("leaf")
    for number in range(depth - 1):
        root = Sequence(f"level {number}", memory=False, children=[root])
    if depth == 200:
        assert TreeRunner(root, None).tick() is Status.SUCCESS
        return
    with pytest.raises(TreeError, match="may be 200 nodes deep, and this one is deeper"):
        TreeRunner(root, None)
    # Else the interpreter frees them one inside the other.
    while root.children:
        root = root.children.pop()
        root.parent = None


@pytest.mark.integration
def test_many_siblings_of_one_name_are_told_apart_in_no_time() -> None:
    nodes = [Success("same") for _ in range(20_000)]
    root = Sequence("root", memory=False, children=nodes)
    before = time.process_time()
    ids = node_ids(preorder(root))
    assert time.process_time() - before < 2.0
    assert [path for _, path in ids[1:4]] == ["root/same", "root/same#2", "root/same#3"]
    assert len({path for _, path in ids}) == 20_001
