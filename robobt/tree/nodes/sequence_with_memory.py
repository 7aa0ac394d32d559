"""Composite: a sequence that does not repeat finished steps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence as StockSequence

from robobt.tree.engine import Plan, Stop, Tick, Visit, composite_stop, own_method, replan


class SequenceWithMemory(StockSequence):
    """A sequence that keeps its place when a child fails and when it is interrupted.

    ``Sequence(memory=True)`` remembers its place only while it runs; this one
    begins again at its first child in two cases only: when all children have
    succeeded, and after :meth:`restart`. A child that failed or was interrupted is restarted. It equals
    BehaviorTree.CPP's ``SequenceWithMemory``.

    Attributes:
        place: index of the child that is ticked next.
    """

    def __init__(self, name: str, children: Sequence[Behaviour] | None = None) -> None:
        super().__init__(name, memory=True, children=children)
        self.place = 0

    def restart(self) -> None:
        """Begin at the first child at the next tick; a running child is interrupted."""
        self.stop(Status.INVALID)
        self.place = 0

    def tick(self) -> Iterator[Behaviour]:
        """Tick as every py_trees node does."""
        if self.status is not Status.RUNNING:
            for child in self.children:
                if child.status is not Status.INVALID:
                    child.stop(Status.INVALID)
            self.initialise()
        self.current_child = None
        for child in self.children[self.place :]:
            self.current_child = child
            yield from child.tick()
            if child.status is not Status.SUCCESS:
                if child.status is Status.RUNNING:
                    self.status = child.status
                else:
                    self.stop(child.status)
                yield self
                return
            self.place += 1
        self.place = 0
        self.stop(Status.SUCCESS)
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
                for step in plan:
                    if step.child.status is not Status.INVALID:
                        step.stop(Status.INVALID)
                if initialise is not None:
                    initialise()
            self.current_child = None
            status = Status.SUCCESS
            for step in plan[self.place :]:
                self.current_child = step.child
                status = step.tick()
                if status is not Status.SUCCESS:
                    if status is Status.RUNNING:
                        self.status = status
                    else:
                        stop(status)
                    break
                self.place += 1
            else:
                self.place = 0
                status = Status.SUCCESS
                stop(status)
            if visit is not None:
                visit(self)
            return status

        return tick, stop
