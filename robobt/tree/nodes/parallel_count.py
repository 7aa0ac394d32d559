"""Composite: ends at a number of successes or failures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel

from robobt.tree.engine import Plan, Stop, Tick, Visit, composite_stop, own_method, replan


class Counts(ParallelPolicy.Base):
    """The policy of a :class:`ParallelCount`: how many successes and failures decide."""

    def __init__(self, success_count: int, failure_count: int) -> None:
        super().__init__(synchronise=True)
        self.success_count = success_count
        self.failure_count = failure_count


class ParallelCount(Parallel):
    """Ticks all children; enough successes make it succeed, enough failures make it fail.

    Every child that has not finished is ticked at every tick, in their order; a
    child that has finished keeps its status and is not ticked again in this run.
    Then it is counted: SUCCESS when ``success_count`` children have succeeded; else
    FAILURE when ``failure_count`` have failed or too few are left to succeed; else
    RUNNING. Children still running at the end are interrupted. Without children it
    succeeds.

    BehaviorTree.CPP's ``Parallel`` has the same counts, but counts after each child,
    so that there the order of children may decide, and later ones may go unticked.

    Args:
        success_count, failure_count: how many; negative counts from the end, -1 is all
            children, -2 all but one.

    Raises:
        ValueError: a count is 0 or asks for more children than there are; when the
            children come later, at the tick.
    """

    def __init__(
        self,
        name: str,
        *,
        success_count: int = -1,
        failure_count: int = 1,
        children: Sequence[Behaviour] | None = None,
    ) -> None:
        super().__init__(name, Counts(success_count, failure_count), children)
        self.success_count = success_count
        self.failure_count = failure_count
        if children:
            self._needed(success_count)
            self._needed(failure_count)

    def tick(self) -> Iterator[Behaviour]:
        """Tick as every py_trees node does."""
        if self.status is not Status.RUNNING:
            for child in self.children:
                if child.status is not Status.INVALID:
                    child.stop(Status.INVALID)
            self.current_child = None
            self.initialise()
        for child in self.children:
            if child.status is not Status.SUCCESS and child.status is not Status.FAILURE:
                yield from child.tick()
        status = self._judge()
        if status is not Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def closures(self, visit: Visit | None) -> tuple[Tick, Stop]:
        """See :meth:`robobt.tree.engine.BringsClosures.closures`."""
        initialise = own_method(self, "initialise")
        children: list[Behaviour] = []
        plan: Plan = []
        stop_composite = composite_stop(self, visit, children, plan)

        def stop(status: Status) -> None:
            if self.children != children:
                replan(self, visit, children, plan)
            for step in plan:
                if step.child.status is Status.RUNNING:
                    step.stop(Status.INVALID)
            stop_composite(status)

        def tick() -> Status:
            if self.children != children:
                replan(self, visit, children, plan)
            if self.status is not Status.RUNNING:
                for step in plan:
                    if step.child.status is not Status.INVALID:
                        step.stop(Status.INVALID)
                self.current_child = None
                if initialise is not None:
                    initialise()
            for step in plan:
                if step.child.status is not Status.SUCCESS and step.child.status is not Status.FAILURE:
                    step.tick()
            status = self._judge()
            if status is not Status.RUNNING:
                stop(status)
            self.status = status
            if visit is not None:
                visit(self)
            return status

        return tick, stop

    def _judge(self) -> Status:
        """Return what the children amount to; set ``current_child`` to the last one that counts for it."""
        children = self.children
        self.feedback_message = ""
        if not children:
            return Status.SUCCESS
        needed = self._needed(self.success_count)
        allowed = self._needed(self.failure_count)
        succeeded = failed = 0
        success: Behaviour | None = None
        failure: Behaviour | None = None
        for child in children:
            if child.status is Status.SUCCESS:
                succeeded, success = succeeded + 1, child
            elif child.status is Status.FAILURE:
                failed, failure = failed + 1, child
        if succeeded >= needed:
            self.current_child = success
            return Status.SUCCESS
        if failed >= allowed or len(children) - failed < needed:
            self.current_child = failure
            self.feedback_message = f"{failed} of {len(children)} failed"
            return Status.FAILURE
        self.current_child = children[-1]
        return Status.RUNNING

    def _needed(self, count: int) -> int:
        total = len(self.children)
        needed = total + 1 + count if count < 0 else count
        if not 1 <= needed <= total:
            raise ValueError(f"a count of {count} does not fit {total} children")
        return needed
