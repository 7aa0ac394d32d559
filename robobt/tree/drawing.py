"""A tree on paper: as text, as SVG and as DOT, with or without the statuses of its last tick."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy
from py_trees.composites import Composite, Parallel, Selector, Sequence
from py_trees.decorators import Decorator

NodeKind = Literal["composite", "decorator", "leaf"]

_POLICIES = {
    ParallelPolicy.SuccessOnAll: "all",
    ParallelPolicy.SuccessOnOne: "one",
    ParallelPolicy.SuccessOnSelected: "selected",
}
_LONGEST_VALUE = 32


@dataclass(slots=True, frozen=True)
class NodeDescription:
    """What a node is, in words.

    Attributes:
        name: the name its author gave it.
        type: name of its class.
        kind: composite, decorator or leaf.
        glyph: the literature's sign for its kind of control: → ? ⇉ for composites, ◇ for
            decorators, nothing for leaves.
        detail: "memory" or "reactive" for sequences and selectors, the policy of a parallel,
            for the rest the parameters that differ from their defaults ("speed=1.5, style=own").
    """

    name: str
    type: str
    kind: NodeKind
    glyph: str
    detail: str


def describe(node: Behaviour) -> NodeDescription:
    """What ``node`` is, in words; its children are not looked at."""
    name, type_name = str(node.name), type(node).__name__
    if isinstance(node, Selector | Sequence):
        glyph = "?" if isinstance(node, Selector) else "→"
        return NodeDescription(name, type_name, "composite", glyph, "memory" if node.memory else "reactive")
    if isinstance(node, Parallel):
        policy = _POLICIES.get(type(node.policy), type(node.policy).__name__)
        return NodeDescription(name, type_name, "composite", "⇉", policy)
    if isinstance(node, Composite):
        return NodeDescription(name, type_name, "composite", "▤", "")
    if isinstance(node, Decorator):
        return NodeDescription(name, type_name, "decorator", "◇", ", ".join(_parameters(node)))
    return NodeDescription(name, type_name, "leaf", "", ", ".join(_parameters(node)))


def _parameters(node: Behaviour) -> Iterator[str]:
    """The constructor's parameters that the node keeps under their own names and that were changed."""
    for parameter in list(inspect.signature(type(node).__init__).parameters.values())[1:]:
        if parameter.name in ("name", "child", "children") or not hasattr(node, parameter.name):
            continue
        value = getattr(node, parameter.name)
        if parameter.default is inspect.Parameter.empty or not _same(value, parameter.default):
            yield f"{parameter.name}={_short(value)}"


def _same(value: object, default: object) -> bool:
    # bool(): an array compares to an array, whose truth is an error.
    try:
        return value is default or bool(value == default)
    except (TypeError, ValueError):
        return False


def _short(value: object) -> str:
    if isinstance(value, str):
        text = value
    elif isinstance(value, float):
        text = f"{value:g}"
    else:
        text = repr(value)
        if text.startswith("<"):
            # A default repr holds an address, which would differ from run to run.
            text = getattr(value, "__name__", type(value).__name__)
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 1] + "…"
