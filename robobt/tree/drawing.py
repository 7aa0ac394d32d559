"""Drawings of a tree: as text, with or without the statuses of its last tick, and as DOT."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Composite, Parallel, Selector, Sequence
from py_trees.decorators import Decorator

from robobt.tree.signatures import signature_of
from robobt.tree.walk import preorder

NodeKind = Literal["composite", "decorator", "leaf"]

_POLICIES = {
    ParallelPolicy.SuccessOnAll: "all",
    ParallelPolicy.SuccessOnOne: "one",
    ParallelPolicy.SuccessOnSelected: "selected",
}
_LONGEST_VALUE = 32
_MARKS = {Status.SUCCESS: "✓", Status.FAILURE: "✗", Status.RUNNING: "▶", Status.INVALID: "·"}


@dataclass(slots=True, frozen=True)
class NodeDescription:
    """A description of a node.

    Attributes:
        name: the name its author gave it.
        type: name of its class.
        kind: composite, decorator or leaf.
        glyph: the usual symbol for its kind of control: → ? ⇉ for composites, ◇ for decorators, nothing for
            leaves.
        detail: "memory" or "reactive" for sequences and selectors, the policy of a parallel,
            for the rest the parameters that differ from their defaults ("speed=1.5, style=own").
    """

    name: str
    type: str
    kind: NodeKind
    glyph: str
    detail: str

    @property
    def title(self) -> str:
        """Glyph and name, on one line."""
        name = " ".join(self.name.split())
        return f"{self.glyph} {name}" if self.glyph else name

    @property
    def remark(self) -> str:
        """The class where the name does not say it, and the detail; "" when there is neither."""
        return ", ".join(part for part in ("" if self.type == self.name else self.type, self.detail) if part)


def describe(node: Behaviour) -> NodeDescription:
    """Describe ``node`` in words, without its children."""
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
    """Return the constructor's parameters that differ from their defaults."""
    for parameter in _constructor(type(node)):
        if parameter.name in ("name", "child", "children") or not hasattr(node, parameter.name):
            continue
        value = getattr(node, parameter.name)
        if parameter.default is inspect.Parameter.empty or not _same(value, parameter.default):
            yield f"{parameter.name}={_short(value)}"


@lru_cache(maxsize=1024)
def _constructor(kind: type) -> tuple[inspect.Parameter, ...]:
    return tuple(signature_of(kind).parameters.values())


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
        try:
            text = repr(value)
        except Exception:
            text = "<"
        if text.startswith("<"):
            # A default repr contains an address, which differs between runs.
            text = getattr(value, "__name__", type(value).__name__)
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 1] + "…"


def tree_text(root: Behaviour, statuses: bool = False) -> str:
    """Return the tree as lines of text, one for each node.

    Args:
        root: the tree.
        statuses: also say what each node returned at the last tick (✓ success, ✗ failure,
            ▶ running, · not ticked) and the feedback of those that were ticked.
    """
    return "\n".join(_text_lines(root, "", "", statuses))


def _text_lines(node: Behaviour, lead: str, below: str, statuses: bool) -> Iterator[str]:
    shown = describe(node)
    line = f"{lead}{shown.title}" + (f" ({shown.remark})" if shown.remark else "")
    if statuses:
        feedback = "" if node.status is Status.INVALID else " ".join(node.feedback_message.split())
        line = f"{_MARKS[node.status]} {line}" + (f" — {feedback}" if feedback else "")
    yield line
    for child in node.children:
        last = child is node.children[-1]
        yield from _text_lines(
            child, below + ("└─ " if last else "├─ "), below + ("   " if last else "│  "), statuses
        )


def tree_dot(root: Behaviour) -> str:
    """Return the tree of ``root`` for Graphviz."""
    lines = [
        f"digraph {_dot_text(root.name)} {{",
        '  node [fontname="Helvetica", fontsize=11, style="rounded,filled", fillcolor="#ffffff"];',
        '  edge [arrowhead=none, color="#9aa5b1"];',
        "  ordering=out;",
    ]
    places: dict[Behaviour, int] = {}
    for place, node in enumerate(preorder(root)):
        places[node] = place
        shown = describe(node)
        label = _dot_text("\n".join(part for part in (shown.title, shown.remark) if part))
        shape = {"composite": "box", "decorator": "hexagon", "leaf": "ellipse"}[shown.kind]
        style = ' style="filled",' if shown.kind != "composite" else ""
        lines.append(f"  n{place} [label={label},{style} shape={shape}];")
    lines += [f"  n{places[node]} -> n{places[child]};" for node in places for child in node.children]
    return "\n".join([*lines, "}"]) + "\n"


def _dot_text(text: str) -> str:
    escaped = printable(text).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def printable(text: str) -> str:
    """Return a text without the characters that XML does not have."""
    return re.sub(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "\ufffd", text)
