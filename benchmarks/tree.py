"""How fast trees tick: beside stock py_trees, a tree of plain classes, and the process-wide blackboard."""

from __future__ import annotations

import gc
from collections.abc import Callable, Mapping, Sequence
from statistics import median
from time import process_time

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.blackboard import Client
from py_trees.common import Access, Status
from py_trees.trees import BehaviourTree

from robobt.cli import Json, print_json, say
from robobt.cli.common import errors
from robobt.tree import Leaf, TreeRunner

_S, _F, _R, _I = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID
_BRANCHES = 7
_NAMESPACE = "robobt_bench"


def bench_tree(rounds: int = 15, ticks: int = 300) -> dict[str, float]:
    """Measure a tree of 30 nodes: a selector over seven sequences of three leaves, and an idle leaf.

    Every node is visited at every tick (memory=False): the leaves of a sequence
    return SUCCESS, SUCCESS and FAILURE, the idle leaf RUNNING, and they do nothing
    else. In the store cases each of the 22 leaves also reads one entry and writes
    another one.

    The cases take turns, so that whatever else the machine does meets them all. A
    case's figure is the median of its CPU times; the ratios are of these.

    Returns:
        ``speedup_vs_py_trees``, stock ``BehaviourTree.tick`` over ``TreeRunner.tick``;
        ``ratio_to_plain_classes``, ``TreeRunner.tick`` over a hand-written tree of plain
        classes with the same lifecycle; ``store_speedup_vs_blackboard``, stock py_trees
        with blackboard clients over ``TreeRunner`` with a store; and what they are made
        of: the CPU time of each case, in microseconds a tick, under names in ``_us``.
    """
    clients: list[Client] = []
    cases: dict[str, Callable[[], object]] = {
        "py_trees_us": BehaviourTree(_tree(_Idle)).tick,
        "runner_us": TreeRunner(_tree(_IdleLeaf), None).tick,
        "plain_us": _plain_tree().tick,
        "py_trees_blackboard_us": BehaviourTree(_tree(lambda result: _OnBlackboard(result, clients))).tick,
        "runner_store_us": TreeRunner(_tree(_OnStore), _Entries()).tick,
    }
    try:
        us = medians(cases, rounds, ticks)
    finally:
        for client in clients:
            client.unregister()
    return {
        "speedup_vs_py_trees": us["py_trees_us"] / us["runner_us"],
        "ratio_to_plain_classes": us["runner_us"] / us["plain_us"],
        "store_speedup_vs_blackboard": us["py_trees_blackboard_us"] / us["runner_store_us"],
        **us,
    }


def medians(cases: dict[str, Callable[[], object]], rounds: int, calls: int) -> dict[str, float]:
    """Return the median CPU time of a call of each case [us]; the cases take turns."""
    taken: dict[str, list[float]] = {name: [] for name in cases}
    for case in cases.values():
        for _ in range(calls):
            case()
    # What is there already is not looked through before each case.
    gc.freeze()
    try:
        for _ in range(rounds):
            for name, case in cases.items():
                # One case's garbage is not collected in another one's time.
                gc.collect()
                begin = process_time()
                for _ in range(calls):
                    case()
                taken[name].append(1e6 * (process_time() - begin) / calls)
    finally:
        gc.unfreeze()
    return {name: median(times) for name, times in taken.items()}


def _tree(leaf: Callable[[Status], Behaviour]) -> Behaviour:
    branches = [
        composites.Sequence(f"branch {i}", memory=False, children=[leaf(_S), leaf(_S), leaf(_F)])
        for i in range(_BRANCHES)
    ]
    return composites.Selector("root", memory=False, children=[*branches, leaf(_R)])


class _Idle(Behaviour):
    """A leaf as py_trees' users write it."""

    def __init__(self, result: Status) -> None:
        super().__init__("idle")
        self.result = result

    def update(self) -> Status:
        return self.result


class _OnBlackboard(_Idle):
    """The same with one read and one write of the blackboard."""

    def __init__(self, result: Status, clients: list[Client]) -> None:
        super().__init__(result)
        # Keys directly in the client's namespace are the quickest to reach.
        self.blackboard = self.attach_blackboard_client(namespace=_NAMESPACE)
        self.blackboard.register_key("count", Access.READ)
        self.blackboard.register_key("last", Access.WRITE)
        if not clients:
            first = Client(name="first", namespace=_NAMESPACE)
            first.register_key("count", Access.WRITE)
            first.count = 1
            clients.append(first)
        clients.append(self.blackboard)

    def update(self) -> Status:
        self.blackboard.last = self.blackboard.count
        return self.result


class _IdleLeaf(Leaf[None]):
    """A leaf as this package's users write it."""

    def __init__(self, result: Status) -> None:
        super().__init__("idle")
        self.result = result

    def on_running(self) -> Status:
        return self.result


class _Entries:
    __slots__ = ("count", "last")

    def __init__(self) -> None:
        self.count = self.last = 1


class _OnStore(Leaf[_Entries]):
    """The same with one read and one write of the store."""

    def __init__(self, result: Status) -> None:
        super().__init__("idle")
        self.result = result

    def on_running(self) -> Status:
        self.store.last = self.store.count
        return self.result


class _Plain:
    """A node without py_trees: what one would write who needs nothing but the lifecycle."""

    def __init__(self) -> None:
        self.status = _I

    def initialise(self) -> None:
        """Begin a run."""

    def update(self) -> Status:
        """Do one tick's work."""
        return _I

    def terminate(self, new_status: Status) -> None:
        """End a run, or reset the node."""

    def tick(self) -> Status:
        if self.status is not _R:
            self.initialise()
        status = self.update()
        if status is not _R:
            self.stop(status)
        self.status = status
        return status

    def stop(self, new_status: Status) -> None:
        self.terminate(new_status)
        self.status = new_status


class _PlainIdle(_Plain):
    def __init__(self, result: Status) -> None:
        super().__init__()
        self.result = result

    def update(self) -> Status:
        return self.result


class _PlainComposite(_Plain):
    def __init__(self, children: Sequence[_Plain]) -> None:
        super().__init__()
        self.children = list(children)
        self.current_child: _Plain | None = None

    def stop(self, new_status: Status) -> None:
        if new_status is _I:
            self.current_child = None
            self.reset(0)
        self.terminate(new_status)
        self.status = new_status

    def reset(self, first: int) -> None:
        """Stop every child from the ``first`` on that has a status."""
        for child in self.children[first:]:
            if child.status is not _I:
                child.stop(_I)


class _PlainSequence(_PlainComposite):
    def tick(self) -> Status:
        if self.status is not _R:
            self.reset(0)
            self.initialise()
        for index, child in enumerate(self.children):
            self.current_child = child
            status = child.tick()
            if status is not _S:
                self.reset(index + 1)
                if status is _R:
                    self.status = status
                else:
                    self.stop(status)
                return status
        self.stop(_S)
        return _S


class _PlainSelector(_PlainComposite):
    def tick(self) -> Status:
        if self.status is not _R:
            self.initialise()
        previous = self.current_child
        for index, child in enumerate(self.children):
            status = child.tick()
            if status is not _F:
                self.current_child = child
                if previous is not child:
                    self.reset(index + 1)
                if status is _R:
                    self.status = status
                else:
                    self.stop(status)
                return status
        self.stop(_F)
        return _F


def _plain_tree() -> _Plain:
    branches = [_PlainSequence([_PlainIdle(_S), _PlainIdle(_S), _PlainIdle(_F)]) for _ in range(_BRANCHES)]
    return _PlainSelector([*branches, _PlainIdle(_R)])


def tree(as_json: Json = False) -> None:
    """Measure the trees: a tick of 30 nodes beside py_trees and beside plain classes.

    Keys of --json: speedup_vs_py_trees (against BehaviourTree.tick),
    ratio_to_plain_classes (time against a hand-written class tree with the same
    lifecycle), store_speedup_vs_blackboard (a read and a write of the store in
    every leaf, against the blackboard's), and the microseconds a tick that they
    come from. CPU time, medians.
    """

    with errors.status("measuring trees"):
        figures = bench_tree()
    print_figures(figures, as_json)


def print_figures(figures: Mapping[str, float], as_json: bool) -> None:
    """Print figures by their names, a line each, or as JSON."""
    if as_json:
        print_json(figures)
        return
    for name, figure in figures.items():
        say(f"{name.replace('_', ' '):32} {figure:8.2f}")
