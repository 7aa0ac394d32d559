"""The base of decorators that sometimes return their own status without ticking the child."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from robobt.tree.engine import Stop, Tick, Visit, compile_node, not_a_status, own_method


class Gate(Decorator):
    """A decorator that decides at every tick whether its child is ticked.

    Override :meth:`answer`, and :meth:`update` to change the child's status. When the gate returns a final
    status, the child does not keep its own: a running child is interrupted, a finished one becomes INVALID.
    So a child with a final status was ticked. When the gate returns RUNNING, a running child stays running
    without a tick.
    """

    def answer(self) -> Status | None:
        """Return the gate's own status without ticking the child; None ticks it."""
        raise NotImplementedError(f"{type(self).__name__} does not define answer")

    def update(self) -> Status:
        """Return the gate's status once the child has been ticked; the child's own by default."""
        self.feedback_message = ""
        return self.decorated.status

    def tick(self) -> Iterator[Behaviour]:
        """Tick as every py_trees node does."""
        if self.status is not Status.RUNNING:
            self.initialise()
        child = self.decorated
        status = self.answer()
        if status is None:
            yield from child.tick()
            status = self.update()
            if status.__class__ is not Status:
                status = not_a_status(self, status)
        elif child.status is not Status.INVALID and not (child.status is status is Status.RUNNING):
            child.stop(Status.INVALID)
        if status is not Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def stop(self, new_status: Status) -> None:
        """Stop as every py_trees decorator does, except that a child that was not ticked is not stopped."""
        self.terminate(new_status)
        child = self.decorated
        if child.status is Status.RUNNING or (
            new_status is Status.INVALID and child.status is not Status.INVALID
        ):
            child.stop(Status.INVALID)
        self.status = new_status

    def closures(self, visit: Visit | None) -> tuple[Tick, Stop]:
        """See :meth:`robobt.tree.engine.BringsClosures.closures`."""
        running, invalid = Status.RUNNING, Status.INVALID
        initialise, terminate = own_method(self, "initialise"), own_method(self, "terminate")
        answer, update, child = self.answer, self.update, self.decorated
        tick_child, stop_child = compile_node(child, visit)

        def renew() -> None:
            nonlocal child, tick_child, stop_child
            tick_child, stop_child = compile_node(self.decorated, visit)
            child = self.decorated

        def tick() -> Status:
            if self.decorated is not child:
                renew()
            if initialise is not None and self.status is not running:
                initialise()
            status = answer()
            if status is None:
                tick_child()
                status = update()
                if status.__class__ is not Status:
                    status = not_a_status(self, status)
            elif child.status is not invalid and not (child.status is status is running):
                stop_child(invalid)
            if status is not running:
                stop(status)
            self.status = status
            if visit is not None:
                visit(self)
            return status

        def stop(status: Status) -> None:
            if self.decorated is not child:
                renew()
            if terminate is not None:
                terminate(status)
            if child.status is running or (status is invalid and child.status is not invalid):
                stop_child(invalid)
            self.status = status

        return tick, stop
