"""Counts the ticks, statuses and time of each node of a tree."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import perf_counter

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.visitors import VisitorBase

from robobt.tree.walk import node_path, preorder


@dataclass(slots=True)
class NodeCounts:
    """The counts of one node.

    Attributes:
        path: path of the node.
        ticks: number of ticks.
        transitions: number of ticks with another status than at the last tick.
        successes, failures: number of ticks with this status.
        runs: number of ticks after which it was running.
        last: the status of its last tick, None before the first.
        own_time: total time from the end of the node ticked before it to its own end [s]: all the time of a
            leaf, and the time of a control node after its last child.
        time: its own time plus that of all nodes below it [s].
    """

    path: str
    ticks: int = 0
    transitions: int = 0
    successes: int = 0
    failures: int = 0
    runs: int = 0
    last: Status | None = None
    own_time: float = 0.0
    time: float = 0.0


class NodeStatistics(VisitorBase):
    """A py_trees visitor that counts ticks, statuses and time of every node of a tree.

    For :meth:`TreeRunner.show_to <robobt.tree.runner.TreeRunner.show_to>`, or among the
    ``visitors`` of a ``FastTree`` or a py_trees ``BehaviourTree``.

    Args:
        root: the tree.
        clock: clock for measuring [s]. The default includes other work of the machine; ``time.thread_time``
            does not, but takes as long as a small leaf.
    """

    def __init__(self, root: Behaviour, clock: Callable[[], float] = perf_counter) -> None:
        super().__init__(full=False)
        self.root = root
        self.reset()
        self._clock = clock
        self._last = 0.0

    def reset(self) -> None:
        """Forget everything."""
        self._counts: dict[Behaviour, NodeCounts] = {}

    def initialise(self) -> None:
        """Begin a tick of the tree."""
        self._last = self._clock()

    def run(self, behaviour: Behaviour) -> None:
        """Count a node that has been ticked."""
        count = self._counts.get(behaviour)
        if count is None:
            count = self._counts[behaviour] = NodeCounts(node_path(behaviour))
        status = behaviour.status
        if status is not count.last:
            if count.last is not None:
                count.transitions += 1
            count.last = status
        if status is Status.SUCCESS:
            count.successes += 1
        elif status is Status.FAILURE:
            count.failures += 1
        elif status is Status.RUNNING:
            count.runs += 1
        count.ticks += 1
        now = self._clock()
        count.own_time += now - self._last
        self._last = now

    def counts(self) -> list[NodeCounts]:
        """Return the counts of each node that is in the tree now, parents first."""
        return [self._of(node) for node in preorder(self.root)]

    def as_table(self) -> str:
        """Return the counts as text: a line for each node, with statuses as shares of its ticks."""
        nodes = preorder(self.root)
        names = ["  " * _depth(node, self.root) + node.name for node in nodes]
        width = max(map(len, [*names, "node"]))
        heads = ("ticks", "changes", "success", "failure", "running", "us/tick")
        lines = [f"{'node':{width}}  " + " ".join(f"{head:>8}" for head in heads)]
        for name, one in zip(names, self.counts(), strict=True):
            shares = [_share(part, one.ticks) for part in (one.successes, one.failures, one.runs)]
            mean = f"{1e6 * one.time / one.ticks:.1f}" if one.ticks else "-"
            cells = [str(one.ticks), str(one.transitions), *shares, mean]
            lines.append(f"{name:{width}}  " + " ".join(f"{cell:>8}" for cell in cells))
        return "\n".join(lines)

    def _of(self, node: Behaviour) -> NodeCounts:
        own = self._counts.get(node) or NodeCounts(node_path(node))
        below = [self._counts[one].own_time for one in preorder(node) if one in self._counts]
        return replace(own, time=sum(below))


def _depth(node: Behaviour, root: Behaviour) -> int:
    depth = 0
    while node is not root and node.parent is not None:
        node, depth = node.parent, depth + 1
    return depth


def _share(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f} %" if whole else "-"
