"""Composite: one of several children, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import StrEnum
from typing import ClassVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite

from robobt.tree.engine import (
    FAILURE,
    INVALID,
    RUNNING,
    Plan,
    Stop,
    Tick,
    Visit,
    composite_stop,
    marks_of,
    own_method,
    register,
    replan,
    shown,
)


class Switch(Composite):
    """Ticks the child of the present case, and only that one. The base of switches; define :meth:`case`.

    Has the status of that child; FAILURE, with the case as its reason, when there
    is no child for it. The case is evaluated in every tick. When it changes, the child of the old case is
    interrupted before that of the new one is ticked.

    Args:
        cases: a child for each case; one child may serve several cases.
        otherwise: the child for every other case.

    Raises:
        ValueError: the switch has a :attr:`kind` and a case is none of its values; the message lists them.
    """

    kind: ClassVar[type[StrEnum] | None] = None
    """What the cases are, where they are known beforehand."""

    def __init__(
        self, name: str, cases: Mapping[str, Behaviour], *, otherwise: Behaviour | None = None
    ) -> None:
        if self.kind is not None:
            known = [each.value for each in self.kind]
            for case in cases:
                if case not in known:
                    what = self.kind.__name__.lower()
                    raise ValueError(f"{case!r} is no {what}; there are {', '.join(known)}")
        children = list(dict.fromkeys([*cases.values(), *([] if otherwise is None else [otherwise])]))
        super().__init__(name, children)
        # By place, so that a child that is replaced is replaced in its cases too.
        self._places = {case: children.index(child) for case, child in cases.items()}
        self._otherwise = None if otherwise is None else children.index(otherwise)

    def case(self) -> str:
        """Return the present case."""
        raise NotImplementedError(f"{type(self).__name__} does not define case")

    @property
    def cases(self) -> dict[str, Behaviour]:
        """The child of each case, in the order they were given."""
        return {case: self.children[place] for case, place in self._places.items()}

    @property
    def otherwise(self) -> Behaviour | None:
        """The child for every other case."""
        return None if self._otherwise is None else self.children[self._otherwise]

    def tick(self) -> Iterator[Behaviour]:
        """Tick as every py_trees node does."""
        if self.status is not Status.RUNNING:
            self.initialise()
        chosen = self._choose()
        for place, child in enumerate(self.children):
            if place != chosen and child.status is not Status.INVALID:
                child.stop(Status.INVALID)
        if chosen is None:
            self.current_child = None
            self.stop(Status.FAILURE)
        else:
            self.current_child = child = self.children[chosen]
            yield from child.tick()
            if child.status is Status.RUNNING:
                self.status = child.status
            else:
                self.stop(child.status)
        yield self

    def closures(self, visit: Visit | None) -> tuple[Tick, Stop]:
        """See :meth:`robobt.tree.engine.BringsClosures.closures`."""
        marks, show = marks_of(visit), shown(self, visit)
        initialise = own_method(self, "initialise")
        children: list[Behaviour] = []
        plan: Plan = []
        stop = composite_stop(self, visit, children, plan)
        before: int | None = None
        said: object = None

        def tick() -> Status:
            nonlocal before, said
            if self.children != children:
                replan(self, visit, children, plan)
            if initialise is not None and self.status is not RUNNING:
                initialise()
            chosen = self._choose()
            if marks is not None:
                now = self.feedback_message
                if chosen != before or (now is not said and now != said):
                    before, said = chosen, now
                    marks.change()
            step = None if chosen is None else plan[chosen]
            if step is None or step.child is not self.current_child:
                for place, other in enumerate(plan):
                    if place != chosen and other.child.status is not INVALID:
                        other.stop(INVALID)
            if step is None:
                self.current_child = None
                status = FAILURE
                stop(status)
            else:
                self.current_child = step.child
                status = step.tick()
                if status is RUNNING:
                    self.status = status
                else:
                    stop(status)
            if show is not None:
                show(self)
            return status

        return tick, stop

    def _choose(self) -> int | None:
        case = self.case()
        chosen = self._places.get(case, self._otherwise)
        self.feedback_message = case if chosen is not None else f"nothing to do in {case}"
        return chosen


def _closures(switch: Switch, visit: Visit | None) -> tuple[Tick, Stop]:
    return switch.closures(visit)


def _without_hooks(switch: Behaviour) -> bool:
    return own_method(switch, "initialise") is own_method(switch, "terminate") is None


# Only the child that is ticked keeps a status.
register(Switch, _closures, _without_hooks, lambda _: "all")
