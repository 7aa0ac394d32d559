"""Commitment to a decision for a while: a reactive selector that keeps its child."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Selector
from py_trees.decorators import Decorator

from robobt.tree.engine import Plan, Stop, Tick, Visit, composite_stop, own_method, replan
from robobt.tree.leaf import Bound
from robobt.tree.nodes.timer import HasTime, Timer


class CommitFor(Decorator, Bound[HasTime]):
    """Marks a branch of a :class:`CommittingSelector` that is kept for a while once it runs.

    It is the selector's child, or has only decorators between. It returns its child's status. Only higher
    priorities are held off: the child may finish at any time, and its own guards and nodes above the selector
    stop it as usual.

    Args:
        seconds: how long, from the first tick of a run [s].

    Raises:
        RuntimeError: at the first tick, when it is not a branch of a CommittingSelector.
    """

    def __init__(self, name: str, child: Behaviour, *, seconds: float) -> None:
        super().__init__(name, child)
        self.seconds = seconds
        self._timer = Timer(seconds)

    @property
    def committed(self) -> bool:
        """Whether it runs and has not done so for ``seconds`` yet."""
        return self.status is Status.RUNNING and self._timer.runs(self.store.time)

    def initialise(self) -> None:
        """Start the time."""
        above = self.parent
        while isinstance(above, Decorator):
            above = above.parent
        if not isinstance(above, CommittingSelector):
            raise RuntimeError("a CommitFor has to be a branch of a CommittingSelector")
        self._timer.start(self.store.time)

    def update(self) -> Status:
        """Return the child's status."""
        return self.decorated.status


class CommittingSelector(Selector):
    """A reactive selector that does not leave a committed branch.

    While its running child is committed by a :class:`CommitFor`, that child is ticked
    first, and higher priorities only when it fails, in their order, before the lower
    ones. Otherwise it is ``Selector(memory=False)``, but that no child keeps a status
    of an earlier tick: those that were not ticked are INVALID.
    """

    def __init__(self, name: str, children: Sequence[Behaviour] | None = None) -> None:
        super().__init__(name, memory=False, children=children)

    def tick(self) -> Iterator[Behaviour]:
        """Tick as every py_trees node does."""
        if self.status is not Status.RUNNING:
            self.current_child = None
            self.initialise()
        kept = self._kept()
        order = self.children if kept is None else [kept, *(c for c in self.children if c is not kept)]
        for position, child in enumerate(order):
            yield from child.tick()
            if child.status is Status.RUNNING or child.status is Status.SUCCESS:
                self.current_child = child
                for other in order[position + 1 :]:
                    if other.status is not Status.INVALID:
                        other.stop(Status.INVALID)
                if child.status is Status.SUCCESS:
                    self.stop(Status.SUCCESS)
                else:
                    self.status = Status.RUNNING
                yield self
                return
        self.stop(Status.FAILURE)
        self.current_child = self.children[-1] if self.children else None
        yield self

    def closures(self, visit: Visit | None) -> tuple[Tick, Stop]:
        """See :meth:`robobt.tree.engine.BringsClosures.closures`."""
        initialise = own_method(self, "initialise")
        children: list[Behaviour] = []
        plan: Plan = []
        stop = composite_stop(self, visit, children, plan)

        def tick() -> Status:
            if self.children != children:
                replan(self, visit, children, plan)
            if self.status is not Status.RUNNING:
                self.current_child = None
                if initialise is not None:
                    initialise()
            kept = self._kept()
            order = plan if kept is None else sorted(plan, key=lambda step: step.child is not kept)
            status = Status.FAILURE
            for position, step in enumerate(order):
                status = step.tick()
                if status is Status.RUNNING or status is Status.SUCCESS:
                    self.current_child = step.child
                    for other in order[position + 1 :]:
                        if other.child.status is not Status.INVALID:
                            other.stop(Status.INVALID)
                    if status is Status.SUCCESS:
                        stop(status)
                    else:
                        self.status = status
                    break
            else:
                status = Status.FAILURE
                stop(status)
                self.current_child = children[-1] if children else None
            if visit is not None:
                visit(self)
            return status

        return tick, stop

    def _kept(self) -> Behaviour | None:
        branch = node = self.current_child
        while isinstance(node, Decorator):
            if isinstance(node, CommitFor) and node.committed:
                return branch
            node = node.decorated
        return None
