"""Ticks any py_trees tree without generators, many times faster, to the same effect.

py_trees ticks by yielding every node through every level, builds log strings
nobody reads, and makes a new generator at every stop. :func:`compile_tree` walks
a tree once and makes, for every node whose class ticks and stops as py_trees'
own classes do, a pair of closures that do the same to the node: the same order
of visits, the same ``initialise``, ``update`` and ``terminate`` calls with the
same arguments, the same ``status``, ``current_child`` and feedback. All state
stays on the nodes, so ``tip()``, ``display`` and ``stop()`` work as ever, and
ticks of both kinds may be mixed. A node whose class has a ``tick`` or ``stop``
of its own is ticked through them, unless the class that defines them brings its
own closures, see :class:`BringsClosures`.

What differs: the attribute ``iterator`` of a node is not renewed, and nothing
is logged at debug level.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from typing import Any, Literal, Protocol, TypeAlias, cast

from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Selector, Sequence
from py_trees.decorators import Decorator, EternalGuard, OneShot
from py_trees.trees import BehaviourTree

from robobt.tree.leaf import Leaf, no_status

_log = logging.getLogger(__name__)

Tick: TypeAlias = Callable[[], Status]
Stop: TypeAlias = Callable[[Status], None]
Visit: TypeAlias = Callable[[Behaviour], None]
_Make: TypeAlias = Callable[[Any, Visit | None], tuple[Tick, Stop]]

_S, _F, _R, _I = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID


def compile_tree(root: Behaviour, visit: Visit | None = None) -> Tick:
    """A function that ticks the tree once and returns the root's status.

    Children may be added, removed and replaced between ticks; which of its
    methods a node has must not change.

    Args:
        visit: called with every node as it has been ticked, in py_trees' order.
    """
    return compile_node(root, visit)[0]


class BringsClosures(Protocol):
    """What a class with a ``tick`` of its own offers to be ticked without its generator."""

    def closures(self, visit: Visit | None) -> tuple[Tick, Stop]:
        """Functions that do to this node what its ``tick`` and its ``stop`` do.

        Children are compiled by :func:`compile_node`. A subclass that overrides
        ``tick`` or ``stop`` without ``closures`` is ticked through its generator.

        Args:
            visit: to be called with this node whenever it has been ticked; the
                closures of its children do the same for them.
        """


class Marks:
    """A :data:`Visit` that need only be told of some nodes, so that all others lose no time over it.

    Which nodes a tick reaches and what they have afterwards follows from what the leaves
    return, as long as every node on the way is of a known kind. So a tick at which each
    leaf returned what it did when it was ticked last has left the tree as it was, but for
    what nodes say.

    Args:
        nodes: the nodes that are asked for.

    Attributes:
        nodes: those.
        seen: nodes that have been ticked, in py_trees' order, every one of ``nodes`` among
            them; for its owner to clear.
        changed: whether statuses, words or the nodes that are ticked may be other than after
            the tick before; for its owner to set to False after a tick.
        words: unless ``changed``, the nodes that said something else than at the tick before,
            which is all that is new; for its owner to clear.
    """

    def __init__(self, nodes: Iterable[Behaviour]) -> None:
        self.nodes = list(nodes)
        self._asked = {id(node) for node in self.nodes}
        self.seen: list[Behaviour] = []
        self._note = self.seen.append
        self.changed = True
        self.words: list[Behaviour] = []

    def __call__(self, node: Behaviour) -> None:
        """``node`` has been ticked."""
        self._note(node)

    def of(self, node: Behaviour) -> Visit | None:
        """What to call with this node; None when it is not asked for."""
        return self._note if id(node) in self._asked else None

    def whenever(self, tick: Tick) -> Tick:
        """``tick`` of a node of which nobody knows what follows from what."""

        def changing() -> Status:
            self.changed = True
            return tick()

        return changing


class FastTree(BehaviourTree):
    """A py_trees ``BehaviourTree`` ticked by :func:`compile_tree`; visitors and handlers as ever.

    When a node raises, the tree is abandoned and the visitors are finalised before the
    exception goes on.
    """

    def __init__(self, root: Behaviour) -> None:
        super().__init__(root)
        self._compiled: Tick | None = None
        self._compiled_for: tuple[Behaviour, bool] | None = None

    def tick(
        self,
        pre_tick_handler: Callable[[BehaviourTree], None] | None = None,
        post_tick_handler: Callable[[BehaviourTree], None] | None = None,
    ) -> None:
        """As :meth:`py_trees.trees.BehaviourTree.tick`."""
        if pre_tick_handler is not None:
            pre_tick_handler(self)
        for handler in self.pre_tick_handlers:
            handler(self)
        for visitor in self.visitors:
            visitor.initialise()
        wanted = (self.root, any(not visitor.full for visitor in self.visitors))
        if self._compiled is None or self._compiled_for != wanted:
            self._compiled = compile_tree(self.root, self._visit if wanted[1] else None)
            self._compiled_for = wanted
        try:
            self._compiled()
        except BaseException:
            # Ctrl-C as well: whoever goes on after it finds a tree at rest.
            abandon(self.root)
            for visitor in self.visitors:
                visitor.finalise()
            raise
        full = [visitor for visitor in self.visitors if visitor.full]
        if full:
            for node in self.root.iterate():
                for visitor in full:
                    node.visit(visitor)
        for visitor in self.visitors:
            visitor.finalise()
        for handler in self.post_tick_handlers:
            handler(self)
        if post_tick_handler is not None:
            post_tick_handler(self)
        self.count += 1

    def _visit(self, node: Behaviour) -> None:
        for visitor in self.visitors:
            if not visitor.full:
                node.visit(visitor)


def abandon(root: Behaviour) -> None:
    """Bring a tree that an exception left half-ticked to rest: every node is INVALID afterwards.

    Nodes that were running are stopped, so they hear of their interruption; what
    they raise then is logged and keeps no other node from being stopped.
    """
    # Children first, as composites stop; each is asked for itself, for a half-ticked
    # parent does not know that its child runs.
    for node in root.iterate():
        if node.status is _R:
            try:
                node.stop(_I)
            except (Exception, SystemExit):
                _log.warning("%r raised again while its tree was being stopped", node.name, exc_info=True)
        node.status = _I


def compile_node(node: Behaviour, visit: Visit | None) -> tuple[Tick, Stop]:
    """Functions that tick and stop this node and everything below it."""
    make = _known_as(node)
    tick, stop = make(node, visit)
    if isinstance(visit, Marks) and not _followed(node, make):
        return visit.whenever(tick), stop
    return tick, stop


def _followed(node: Behaviour, make: _Make) -> bool:
    """Whether its closures tell :class:`Marks` whatever else than its children decides about a node."""
    if make is _sequence or make is _selector:
        return own_method(node, "initialise") is own_method(node, "terminate") is None
    return make is _leaf or make is _decorator


def _marks(visit: Visit | None) -> Marks | None:
    return visit if isinstance(visit, Marks) else None


def _shown(node: Behaviour, visit: Visit | None) -> Visit | None:
    return visit.of(node) if isinstance(visit, Marks) else visit


def _known_as(node: Behaviour) -> _Make:
    """What makes the closures of such a node."""
    cls = type(node)
    if not (_has_method_of(cls, node, "tick") and _has_method_of(cls, node, "stop")):
        return _as_it_is
    for tick, stop, make in _KNOWN:
        if cls.tick is tick and cls.stop is stop:
            return make
    return _as_it_brings if _brings_closures(cls) else _as_it_is


def _brings_closures(cls: type[Behaviour]) -> bool:
    """Whether the closures the class offers are those of its own ``tick`` and ``stop``."""
    for base in cls.__mro__:
        if "closures" in vars(base):
            return cls.tick is base.tick and cls.stop is base.stop  # type: ignore[attr-defined]
    return False


class Step:
    """One child in a composite's plan.

    Attributes:
        child: the child.
        tick, stop: its closures.
        update: set for a leaf of which nothing else is to be called, so that a
            composite may spare itself the closures.
        status, said: what that leaf returned and said last, as far as anybody asks for it.
    """

    __slots__ = ("child", "said", "status", "stop", "tick", "update")

    def __init__(self, child: Behaviour, visit: Visit | None, parent: Behaviour) -> None:
        self.child = child
        self.tick, self.stop = compile_node(child, visit)
        if type(parent).tick in _LEAVES_AT and _known_as(child) is _as_it_is:
            tick = _until(child, visit, *_LEAVES_AT[type(parent).tick])
            self.tick = visit.whenever(tick) if isinstance(visit, Marks) else tick
        self.update: Tick | None = None
        self.status: Status | None = None
        self.said: str | None = None
        if _shown(child, visit) is None and _known_as(child) is _leaf:
            initialise, update, terminate = _lifecycle(child)
            self.update = update if initialise is terminate is None else None


Plan: TypeAlias = list[Step]


def _as_it_is(node: Behaviour, visit: Visit | None) -> tuple[Tick, Stop]:
    """A node with a way of its own: ticked through its own generator."""

    def tick() -> Status:
        for ticked in node.tick():
            if visit is not None:
                visit(ticked)
        return node.status

    def stop(status: Status) -> None:
        node.stop(status)

    return tick, stop


def _until(child: Behaviour, visit: Visit | None, ends: tuple[Status, ...], otherwise: Status) -> Tick:
    """The tick of a child with a way of its own, left as py_trees' sequences and selectors leave it.

    They look at the child each time it yields itself. What its generator does after
    they have seen enough does not happen, and one that never shows a status they
    wait for has let them pass.
    """

    def tick() -> Status:
        for ticked in child.tick():
            if visit is not None:
                visit(ticked)
            if ticked is child and child.status in ends:
                return child.status
        return otherwise

    return tick


_LEAVES_AT: dict[Any, tuple[tuple[Status, ...], Status]] = {
    Sequence.tick: ((_F, _R, _I), _S),
    Selector.tick: ((_S, _R), _F),
}
"""The statuses of a child upon which a composite goes no further, and what counts when none of them comes."""


def _as_it_brings(node: Behaviour, visit: Visit | None) -> tuple[Tick, Stop]:
    return cast(BringsClosures, node).closures(visit)


def _leaf(node: Behaviour, visit: Visit | None) -> tuple[Tick, Stop]:
    initialise, update, terminate = _lifecycle(node)
    marks, visit = _marks(visit), _shown(node, visit)
    last: Status | None = None
    said: str | None = None

    def tick() -> Status:
        nonlocal last, said
        if initialise is not None and node.status is not _R:
            initialise()
        status = update()
        if status.__class__ is not Status:
            status = not_a_status(node, status)
        if terminate is not None and status is not _R:
            terminate(status)
        node.status = status
        if marks is not None:
            now = node.feedback_message
            if status is not last:
                marks.changed = True
                last, said = status, now if now.__class__ is str else None
            elif now is not said and (now.__class__ is not str or now != said):
                marks.words.append(node)
                said = now if now.__class__ is str else None
        if visit is not None:
            visit(node)
        return status

    def stop(status: Status) -> None:
        if terminate is not None:
            terminate(status)
        node.status = status

    return tick, stop


def _lifecycle(node: Behaviour) -> tuple[Any, Any, Any]:
    """A leaf's ``initialise``, ``update`` and ``terminate``, None where one does nothing.

    Those of :class:`Leaf` only call its own lifecycle, which is called directly
    instead as far as the leaf defines it.
    """
    initialise, update, terminate = own_method(node, "initialise"), node.update, own_method(node, "terminate")
    if isinstance(node, Leaf):
        if _inherits(node, "initialise"):
            initialise = None if _inherits(node, "on_start") else node.on_start
        if _inherits(node, "update"):
            update = node.on_running
        if _inherits(node, "terminate") and _inherits(node, "on_done") and _inherits(node, "on_interrupt"):
            terminate = None
    return initialise, update, terminate


def _inherits(leaf: Leaf[Any], method: str) -> bool:
    """Whether the leaf has this method from :class:`Leaf` itself."""
    return _has_method_of(Leaf, leaf, method)


def _decorator(node: Any, visit: Visit | None) -> tuple[Tick, Stop]:
    marks, show = _marks(visit), _shown(node, visit)
    initialise, terminate = own_method(node, "initialise"), own_method(node, "terminate")
    decorated: Behaviour = node.decorated
    tick_child, stop_child = compile_node(decorated, visit)
    last: Status | None = None
    said: str | None = None

    def renew() -> None:
        nonlocal decorated, tick_child, stop_child
        decorated = node.decorated
        tick_child, stop_child = compile_node(decorated, visit)
        if marks is not None:
            marks.changed = True

    def tick() -> Status:
        nonlocal last, said
        if initialise is not None and node.status is not _R:
            initialise()
        if node.decorated is not decorated:
            renew()
        tick_child()
        status: Status = node.update()
        if status.__class__ is not Status:
            status = not_a_status(node, status)
        if status is not _R:
            stop(status)
        node.status = status
        if marks is not None:
            now = node.feedback_message
            if status is not last:
                marks.changed = True
                last, said = status, now if now.__class__ is str else None
            elif now is not said and (now.__class__ is not str or now != said):
                marks.words.append(node)
                said = now if now.__class__ is str else None
        if show is not None:
            show(node)
        return status

    def stop(status: Status) -> None:
        if terminate is not None:
            terminate(status)
        if node.decorated is not decorated:
            renew()
        if status is _I:
            stop_child(_I)
        if decorated.status is _R:
            stop_child(_I)
        node.status = status

    return tick, stop


def _eternal_guard(node: Any, visit: Visit | None) -> tuple[Tick, Stop]:
    show = _shown(node, visit)
    tick_guarded, stop = _decorator(node, visit)

    def tick() -> Status:
        result = node.condition()
        if isinstance(result, Status):
            result = result is not _F
        elif not isinstance(result, bool):
            raise RuntimeError(f"conditional check must return 'bool' or 'common.Status' [{type(result)}]")
        if result:
            return tick_guarded()
        stop(_F)
        if show is not None:
            show(node)
        return _F

    return tick, stop


def _one_shot(node: Any, visit: Visit | None) -> tuple[Tick, Stop]:
    show = _shown(node, visit)
    tick_child, stop = _decorator(node, visit)
    initialise = own_method(node, "initialise")

    def tick() -> Status:
        if not node.final_status:
            return tick_child()
        if initialise is not None and node.status is not _R:
            initialise()
        status: Status = node.update()
        if status.__class__ is not Status:
            status = not_a_status(node, status)
        if status is not _R:
            stop(status)
        node.status = status
        if show is not None:
            show(node)
        return status

    return tick, stop


def _sequence(node: Any, visit: Visit | None) -> tuple[Tick, Stop]:
    marks, show = _marks(visit), _shown(node, visit)
    initialise, terminate = own_method(node, "initialise"), own_method(node, "terminate")
    children: list[Behaviour] = []
    plan: Plan = []
    stop = composite_stop(node, visit, children, plan)
    began = 0

    def tick() -> Status:
        nonlocal began
        if node.children != children:
            replan(node, visit, children, plan)
        start = 0
        if node.status is not _R:
            node.current_child = children[0] if children else None
            for step in plan:
                child = step.child
                if child.status is not _I:
                    if step.update is None:
                        step.stop(_I)
                    else:
                        child.status = _I
            if initialise is not None:
                initialise()
        elif node.memory and node.current_child is not None:
            start = children.index(node.current_child)
        if start != began:
            began = start
            if marks is not None:
                marks.changed = True
        status = _S
        for step in plan[start:] if start else plan:
            node.current_child = child = step.child
            update = step.update
            if update is None:
                status = step.tick()
            else:
                status = update()
                if status.__class__ is not Status:
                    status = not_a_status(child, status)
                child.status = status
                if marks is not None:
                    said = child.feedback_message
                    if status is not step.status:
                        marks.changed = True
                        step.status, step.said = status, said if said.__class__ is str else None
                    elif said is not step.said and (said.__class__ is not str or said != step.said):
                        # A text made anew is often the same; of anything else nobody knows what != does.
                        marks.words.append(child)
                        step.said = said if said.__class__ is str else None
            if status is not _S:
                if not node.memory and child is not children[-1]:
                    for later in plan[children.index(child) + 1 :]:
                        if later.child.status is not _I:
                            later.stop(_I)
                break
        if not children:
            node.current_child = None
        if status is _I:
            stop(status)
        else:
            if terminate is not None and status is not _R:
                terminate(status)
            node.status = status
        if show is not None:
            show(node)
        return status

    return tick, stop


def _selector(node: Any, visit: Visit | None) -> tuple[Tick, Stop]:
    marks, show = _marks(visit), _shown(node, visit)
    initialise = own_method(node, "initialise")
    children: list[Behaviour] = []
    plan: Plan = []
    stop = composite_stop(node, visit, children, plan)
    began = 0

    def tick() -> Status:
        nonlocal began
        if node.children != children:
            replan(node, visit, children, plan)
        if node.status is not _R:
            node.current_child = children[0] if children else None
            if initialise is not None:
                initialise()
        start = 0
        if node.memory and children:
            assert node.current_child is not None, f"the running child of {node.name!r} has been removed"
            start = children.index(node.current_child)
            for step in plan[:start]:
                if step.child.status is not _I:
                    step.stop(_I)
        if start != began:
            began = start
            if marks is not None:
                marks.changed = True
        previous = node.current_child
        for step in plan[start:] if start else plan:
            child = step.child
            update = step.update
            if update is None:
                status = step.tick()
            else:
                status = update()
                if status.__class__ is not Status:
                    status = not_a_status(child, status)
                child.status = status
                if marks is not None:
                    said = child.feedback_message
                    if status is not step.status:
                        marks.changed = True
                        step.status, step.said = status, said if said.__class__ is str else None
                    elif said is not step.said and (said.__class__ is not str or said != step.said):
                        # A text made anew is often the same; of anything else nobody knows what != does.
                        marks.words.append(child)
                        step.said = said if said.__class__ is str else None
            if status is _R or status is _S:
                node.current_child = child
                if previous is not child:
                    # The child that got its way interrupts whatever ran at a lower priority.
                    for later in plan[children.index(child) + 1 :]:
                        if later.child.status is not _I:
                            later.stop(_I)
                if status is _S:
                    stop(status)
                else:
                    node.status = status
                break
        else:
            status = _F
            if not children:
                node.current_child = None
            stop(_F)
            node.current_child = children[-1] if children else None
        if show is not None:
            show(node)
        return status

    return tick, stop


def _parallel(node: Any, visit: Visit | None) -> tuple[Tick, Stop]:
    show = _shown(node, visit)
    initialise = own_method(node, "initialise")
    children: list[Behaviour] = []
    plan: Plan = []
    stop_composite = composite_stop(node, visit, children, plan)

    def stop(status: Status) -> None:
        if node.children != children:
            replan(node, visit, children, plan)
        for step in plan:
            if step.child.status is _R:
                step.stop(_I)
        stop_composite(status)

    def tick() -> Status:
        if node.children != children:
            replan(node, visit, children, plan)
        policy = node.policy
        if isinstance(policy, ParallelPolicy.SuccessOnSelected):
            node.validate_policy_configuration()
        if node.status is not _R:
            for step in plan:
                if step.child.status is not _I:
                    step.stop(_I)
            node.current_child = None
            if initialise is not None:
                initialise()
        if not children:
            node.current_child = None
            stop(_S)
            status = _S
        else:
            synchronise = policy.synchronise
            for step in plan:
                if not (synchronise and step.child.status is _S):
                    step.tick()
            status = _parallel_status(node, children, policy)
            if status is not _R:
                stop(status)
            node.status = status
        if show is not None:
            show(node)
        return status

    return tick, stop


def _parallel_status(node: Any, children: list[Behaviour], policy: Any) -> Status:
    """What a Parallel's children amount to; sets ``current_child`` to the one that decided."""
    node.current_child = children[-1]
    for child in children:
        if child.status is _F:
            node.current_child = child
            return _F
    if isinstance(policy, ParallelPolicy.SuccessOnAll):
        return _S if all(child.status is _S for child in children) else _R
    if isinstance(policy, ParallelPolicy.SuccessOnOne):
        for child in reversed(children):
            if child.status is _S:
                node.current_child = child
                return _S
        return _R
    if isinstance(policy, ParallelPolicy.SuccessOnSelected):
        if all(child.status is _S for child in policy.children):
            node.current_child = policy.children[-1]
            return _S
        return _R
    raise RuntimeError(f"this parallel has been configured with an unrecognised policy [{type(policy)}]")


def composite_stop(node: Any, visit: Visit | None, children: list[Behaviour], plan: Plan) -> Stop:
    """What ``Composite.stop`` does; ``children`` and ``plan`` are those that :func:`replan` keeps."""
    terminate = own_method(node, "terminate")

    def stop(status: Status) -> None:
        if status is _I:
            node.current_child = None
            if node.children != children:
                replan(node, visit, children, plan)
            for step in plan:
                if step.child.status is not _I:
                    step.stop(_I)
        if terminate is not None:
            terminate(status)
        node.status = status

    return stop


def replan(node: Behaviour, visit: Visit | None, children: list[Behaviour], plan: Plan) -> None:
    """Bring a composite's closures up to its children; in place, for the closures share them."""
    known = {step.child.id: step for step in plan}
    if isinstance(visit, Marks):
        visit.changed = True
    children[:] = node.children
    plan[:] = [known.get(child.id) or Step(child, visit, node) for child in children]


def ticked_children(node: Behaviour) -> Literal["all", "first", "some"]:
    """Which children a tick of this node reaches, as far as they have a status after it.

    "all": all of them. "first": those up to the first that succeeded or runs. "some":
    their statuses do not tell, for a child may keep that of an earlier tick, or one
    with a way of its own may show another than it had when its parent looked.
    """
    make = _known_as(node)
    if any(_known_as(child) is _as_it_is for child in node.children):
        return "some"
    if make is _decorator or (make is _sequence and not node.memory):  # type: ignore[attr-defined]
        return "all"
    if make is _selector and not node.memory:  # type: ignore[attr-defined]
        return "first"
    return "some"


def stops_children(node: Behaviour) -> bool:
    """Whether a node that has no status has stopped its children as well, so that they have none."""
    make = _known_as(node)
    return any(make is entry[2] for entry in _KNOWN) or type(node).__module__.startswith("robobt.tree.nodes.")


def own_method(node: Behaviour, method: str) -> Any:
    """The node's bound method, None where it is py_trees' own that does nothing."""
    return None if _has_method_of(Behaviour, node, method) else getattr(node, method)


def _has_method_of(cls: Any, node: Behaviour, method: str) -> bool:
    """Whether this method of the node is the one that the class has, not one of a subclass or its own."""
    # Not looked up in the node's __dict__: asking for that makes CPython 3.11 build it, and
    # every attribute of the node is slower to reach from then on.
    found = getattr(node, method)
    return getattr(found, "__self__", None) is node and found.__func__ is getattr(cls, method)


def not_a_status(node: Behaviour, status: object) -> Status:
    """INVALID, after py_trees' complaint that ``update`` returned something else.

    Raises:
        TypeError: the node is a :class:`Leaf`, which has to return a status.
    """
    if isinstance(node, Leaf):
        raise no_status(status)
    node.logger.error(f"A behaviour returned an invalid status, setting to INVALID [{status}][{node.name}]")
    return _I


_KNOWN: list[tuple[Any, Any, _Make]] = [
    (Behaviour.tick, Behaviour.stop, _leaf),
    (Sequence.tick, Sequence.stop, _sequence),
    (Selector.tick, Selector.stop, _selector),
    (Parallel.tick, Parallel.stop, _parallel),
    (Decorator.tick, Decorator.stop, _decorator),
    (EternalGuard.tick, EternalGuard.stop, _eternal_guard),
    (OneShot.tick, OneShot.stop, _one_shot),
]

__all__ = [
    "BringsClosures",
    "FastTree",
    "Marks",
    "abandon",
    "compile_node",
    "compile_tree",
    "stops_children",
    "ticked_children",
]
