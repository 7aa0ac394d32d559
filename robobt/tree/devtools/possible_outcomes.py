"""Which statuses a node can come to, as far as its class tells."""

from __future__ import annotations

import dis
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any, TypeAlias

from py_trees import decorators as stock
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Selector, Sequence

from robobt.tree import nodes
from robobt.tree.leaf import Leaf

Outcomes: TypeAlias = frozenset[Status]

S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING
ANY: Outcomes = frozenset((S, F, R))


def outcomes(node: Behaviour) -> Outcomes:
    """The statuses that ticks of a node can end with; all three where nothing is known.

    A leaf may say so itself in an attribute ``outcomes``. Otherwise its methods are
    searched for the statuses they name, and for ``succeed``, ``fail`` and ``run`` of
    :class:`~robobt.tree.leaf.Leaf`: a status that is never named is never returned.
    A leaf that names none, and a control node of unknown make, can come to all three.
    """
    if not node.children:
        return _of_empty(node)
    children = [outcomes(child) for child in node.children]
    kind = type(node)
    if isinstance(node, Sequence) and kind.tick in _SEQUENCES:
        return _chained(children, onward=S)
    if isinstance(node, Selector) and kind.tick in _SELECTORS:
        return _chained(children, onward=F)
    if isinstance(node, Parallel) and kind.tick is Parallel.tick:
        return _of_parallel(node, children)
    if isinstance(node, nodes.Switch) and kind.tick is nodes.Switch.tick:
        return frozenset().union(*children) | ({F} if node.otherwise is None else set())
    return _of_decorator(node, children[0])


def sets_any(leaf: Behaviour, entries: Collection[str]) -> bool:
    """Whether a leaf declares that it writes one of these entries, or its methods set attributes so named."""
    return not _names(type(leaf))[1].union(getattr(leaf, "writes", ())).isdisjoint(entries)


def _of_empty(node: Behaviour) -> Outcomes:
    if isinstance(node, Sequence | Parallel | nodes.ParallelCount):
        return frozenset((S,))
    if isinstance(node, Selector):
        return frozenset((F,))
    declared = getattr(node, "outcomes", None)
    if declared is not None:
        return frozenset(declared)
    return frozenset(_SAID[name] for name in _names(type(node))[0] if name in _SAID) or ANY


def _chained(children: list[Outcomes], onward: Status) -> Outcomes:
    """Of a sequence (``onward`` is SUCCESS) or a selector (FAILURE)."""
    found: set[Status] = set()
    for child in children:
        found |= child - {onward}
        if onward not in child:
            return frozenset(found)
    return frozenset(found | {onward})


def _of_parallel(node: Parallel, children: list[Outcomes]) -> Outcomes:
    united = frozenset().union(*children)
    if isinstance(node.policy, ParallelPolicy.SuccessOnAll):
        return united if all(S in child for child in children) else united - {S} | {R}
    return united | {R}


def _of_decorator(node: Behaviour, child: Outcomes) -> Outcomes:
    if isinstance(node, stock.Repeat) and type(node).update is stock.Repeat.update:
        return _repeated(child, node.num_success)
    if isinstance(node, stock.Retry) and type(node).update is stock.Retry.update:
        return child | {R} if F in child and node.num_failures > 1 else child
    change = _DECORATORS.get(type(node))
    return ANY if change is None else change(child)


def _repeated(child: Outcomes, times: int) -> Outcomes:
    if S not in child or times == 1:
        return child
    return child | {R} if times > 1 else child - {S} | {R}


def _becomes(changes: Mapping[Status, Status]) -> Callable[[Outcomes], Outcomes]:
    return lambda child: frozenset(changes.get(status, status) for status in child)


def _or(*more: Status) -> Callable[[Outcomes], Outcomes]:
    return lambda child: child.union(more)


@lru_cache(maxsize=512)
def _names(cls: type) -> tuple[frozenset[str], frozenset[str]]:
    """The names a class's methods look up, and those of the attributes they set."""
    read: set[str] = set()
    written: set[str] = set()
    for function in _functions(cls):
        for code in _codes(function.__code__):
            for step in dis.get_instructions(code):
                if step.opname in _LOOKS_UP:
                    read.add(step.argval)
                elif step.opname == "STORE_ATTR":
                    written.add(step.argval)
    return frozenset(read), frozenset(written)


def _functions(cls: type) -> Iterator[FunctionType]:
    """The functions a class below py_trees' base and ours is made of, and those of its module they use."""
    seen: set[FunctionType] = set()
    waiting = [
        function
        for base in cls.__mro__
        if base not in _BASES
        for member in vars(base).values()
        for function in (getattr(member, "__func__", None), getattr(member, "fget", None), member)
        if isinstance(function, FunctionType)
    ]
    while waiting:
        function = waiting.pop()
        if function in seen:
            continue
        seen.add(function)
        yield function
        for name in function.__code__.co_names:
            used = function.__globals__.get(name)
            if isinstance(used, FunctionType) and used.__module__ == function.__module__:
                waiting.append(used)


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


_LOOKS_UP = ("LOAD_ATTR", "LOAD_METHOD", "LOAD_GLOBAL")

_BASES = frozenset((*Leaf.__mro__, Behaviour, object))

_SAID = {"SUCCESS": S, "FAILURE": F, "RUNNING": R, "succeed": S, "fail": F, "run": R}

_SEQUENCES: tuple[Any, ...] = (Sequence.tick, nodes.SequenceWithMemory.tick)
_SELECTORS: tuple[Any, ...] = (Selector.tick, nodes.CommittingSelector.tick)

_DECORATORS: dict[type, Callable[[Outcomes], Outcomes]] = {
    stock.Condition: lambda _: frozenset((S, R)),
    stock.Count: _or(),
    stock.EternalGuard: _or(F),
    stock.FailureIsRunning: _becomes({F: R}),
    stock.FailureIsSuccess: _becomes({F: S}),
    stock.Inverter: _becomes({F: S, S: F}),
    stock.OneShot: _or(),
    stock.PassThrough: _or(),
    stock.RunningIsFailure: _becomes({R: F}),
    stock.RunningIsSuccess: _becomes({R: S}),
    stock.StatusToBlackboard: _or(),
    stock.SuccessIsFailure: _becomes({S: F}),
    stock.SuccessIsRunning: _becomes({S: R}),
    stock.Timeout: _or(F),
    nodes.CommitFor: _or(),
    nodes.Cooldown: _or(F),
    nodes.Delay: _or(R),
    nodes.HoldSuccess: _or(),
    nodes.TickDivider: _or(),
    nodes.Timeout: _or(F),
}
