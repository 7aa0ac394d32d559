"""A tree on paper: as text, as SVG and as DOT, with or without the statuses of its last tick."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from html import escape
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Composite, Parallel, Selector, Sequence
from py_trees.decorators import Decorator

from robobt.tree.runner import preorder
from robobt.tree.signatures import signature_of

NodeKind = Literal["composite", "decorator", "leaf"]

_POLICIES = {
    ParallelPolicy.SuccessOnAll: "all",
    ParallelPolicy.SuccessOnOne: "one",
    ParallelPolicy.SuccessOnSelected: "selected",
}
_LONGEST_VALUE = 32
_MARKS = {Status.SUCCESS: "✓", Status.FAILURE: "✗", Status.RUNNING: "▶", Status.INVALID: "·"}
_COLOURS = {
    Status.SUCCESS: "#1f9d5b",
    Status.FAILURE: "#dd4b41",
    Status.RUNNING: "#2f7df0",
    Status.INVALID: "#c5cdd5",
}


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
            # A default repr holds an address, which would differ from run to run.
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


def tree_dot(root: Behaviour, statuses: bool = False) -> str:
    """Return the tree of ``root`` for Graphviz; ``statuses`` colours the nodes by their last tick."""
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
        colour = f', color="{_COLOURS[node.status]}", penwidth=2' if statuses else ""
        lines.append(f"  n{place} [label={label},{style} shape={shape}{colour}];")
    lines += [f"  n{places[node]} -> n{places[child]};" for node in places for child in node.children]
    return "\n".join([*lines, "}"]) + "\n"


def _dot_text(text: str) -> str:
    escaped = _printable(text).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


_ROW, _BOX, _GAP, _EDGE = 44.0, 34.0, 34.0, 12.0
_NARROW, _WIDE = frozenset("fijlrtI.,:;|'!()[]{} "), frozenset("mwMW→⇉▤◇")


@dataclass(slots=True)
class _Box:
    """A node's place in the drawing: its layer, the middle of its row and its width [px]."""

    node: Behaviour
    shown: NodeDescription
    layer: int
    y: float = 0.0
    width: float = 0.0
    children: list[_Box] = field(default_factory=list)


def tree_svg(root: Behaviour, statuses: bool = False) -> str:
    """Return the tree as a standalone SVG picture, the root on the left, light or dark as the viewer is.

    Args:
        root: the tree.
        statuses: colour each node by what it returned at the last tick.
    """
    boxes: list[_Box] = []
    rows = _place(root, 0, 0, boxes)
    layers = [0.0] * (1 + max(box.layer for box in boxes))
    for box in boxes:
        layers[box.layer] = max(layers[box.layer], box.width)
    left = [_EDGE]
    for width in layers:
        left.append(left[-1] + width + _GAP)
    total, height = left[-1] - _GAP + _EDGE, rows * _ROW + 2 * _EDGE - (_ROW - _BOX)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total:g} {height:g}" '
        f'width="{total:g}" height="{height:g}" role="img">',
        f"<title>{_xml(root.name)}</title>",
        f"<style>{_STYLE}</style>",
    ]
    for box in boxes:
        start, bend = left[box.layer] + box.width, left[box.layer] + layers[box.layer]
        for child in box.children:
            end = left[child.layer]
            middle = (bend + end) / 2
            parts.append(
                f'<path d="M{start:g} {box.y:g}H{bend:g}C{middle:g} {box.y:g} '
                f'{middle:g} {child.y:g} {end:g} {child.y:g}"/>'
            )
    for box in boxes:
        parts.append(_svg_box(box, left[box.layer], statuses))
    return "\n".join([*parts, "</svg>"]) + "\n"


_STYLE = (
    "text{font:500 13px system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif;fill:#17212b}"
    "text.r{font-size:10.5px;font-weight:400;fill:#667380}tspan{font-weight:700;fill:#2f62d9}"
    "path{fill:none;stroke:#b7c1cb;stroke-width:1.3}"
    "rect{fill:#fff;stroke:#c3ccd5;stroke-width:1.2}rect.composite{fill:#eef3fd;stroke:#a9bfee}"
    "rect.decorator{fill:#f5effc;stroke:#c9b3e6}"
    "@media(prefers-color-scheme:dark){text{fill:#e5ecf2}text.r{fill:#8f9ca9}tspan{fill:#8fb4ff}"
    "path{stroke:#45525e}rect{fill:#1c252e;stroke:#3a4753}rect.composite{fill:#1a2740;stroke:#3b5488}"
    "rect.decorator{fill:#2a2138;stroke:#5c4780}}"
)


def _place(node: Behaviour, layer: int, row: int, boxes: list[_Box]) -> int:
    """Place a subtree from ``row`` on and return the row after it; parents stand amid their children."""
    box = _Box(node, describe(node), layer)
    texts = _text_width(box.shown.title, 7.7), _text_width(box.shown.remark, 6.2)
    box.width = 22.0 + max(texts)
    boxes.append(box)
    after = row
    for child in node.children:
        below = len(boxes)
        after = _place(child, layer + 1, after, boxes)
        box.children.append(boxes[below])
    if not box.children:
        after = row + 1
        box.y = _EDGE + row * _ROW + _BOX / 2
    else:
        box.y = (box.children[0].y + box.children[-1].y) / 2
    return after


def _svg_box(box: _Box, x: float, statuses: bool) -> str:
    shown, status = box.shown, box.node.status
    top = box.y - _BOX / 2
    radius = _BOX / 2 if shown.kind == "leaf" else 7
    # As a style: an attribute would be weaker than the style sheet.
    ticked = statuses and status is not Status.INVALID
    colour = f' style="stroke:{_COLOURS[status]};stroke-width:2.4"' if ticked else ""
    faint = ' opacity="0.5"' if statuses and not ticked else ""
    base = box.y - 1.5 if shown.remark else box.y + 4.5
    glyph = f"<tspan>{_xml(shown.glyph)}</tspan> " if shown.glyph else ""
    name = _xml(shown.title.removeprefix(f"{shown.glyph} "))
    remark = f'<text class="r" x="{x + 11:g}" y="{box.y + 11:g}">{_xml(shown.remark)}</text>'
    return (
        f'<g{faint}><rect class="{shown.kind}" x="{x:g}" y="{top:g}" width="{box.width:g}" height="{_BOX:g}" '
        f'rx="{radius:g}"{colour}/><text x="{x + 11:g}" y="{base:g}">{glyph}{name}</text>'
        f"{remark if shown.remark else ''}</g>"
    )


def _text_width(text: str, size: float) -> float:
    """Estimate the width of a text; the font is the viewer's."""
    share = {**dict.fromkeys(_NARROW, 0.6), **dict.fromkeys(_WIDE, 1.4)}
    return size * sum(share.get(letter, 1.0 if letter.isascii() else 1.5) for letter in text)


def _xml(text: str) -> str:
    return escape(_printable(text))


def _printable(text: str) -> str:
    """Return the text without the characters that XML does not have."""
    return re.sub(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "\ufffd", text)
