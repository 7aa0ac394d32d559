"""A tree as an SVG picture, with or without the statuses of its last tick; notebooks show trees so."""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from html import escape

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.drawing import NodeDescription, describe, printable

_ROW_SPACING, _BOX_HEIGHT, _BOX_GAP, _PICTURE_EDGE = 44.0, 34.0, 34.0, 12.0
_NARROW, _WIDE = frozenset("fijlrtI.,:;|'!()[]{} "), frozenset("mwMW→⇉▤◇")
_BORDER_COLOURS = {
    Status.SUCCESS: "#1f9d5b",
    Status.FAILURE: "#dd4b41",
    Status.RUNNING: "#2f7df0",
    Status.INVALID: "#c5cdd5",
}


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
    left = [_PICTURE_EDGE]
    for width in layers:
        left.append(left[-1] + width + _BOX_GAP)
    total = left[-1] - _BOX_GAP + _PICTURE_EDGE
    height = rows * _ROW_SPACING + 2 * _PICTURE_EDGE - (_ROW_SPACING - _BOX_HEIGHT)
    parts = [
        f'<svg class="bt" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total:g} {height:g}" '
        f'width="{total:g}" height="{height:g}" role="img">',
        f"<title>{_xml(root.name)}</title>",
        f"<style>{_SHEET}</style>",
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


_TREE_STYLE = """
text{font:500 13px system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif;fill:#17212b}
text.r{font-size:10.5px;font-weight:400;fill:#667380}
tspan{font-weight:700;fill:#2f62d9}
path{fill:none;stroke:#b7c1cb;stroke-width:1.3}
rect{fill:#fff;stroke:#c3ccd5;stroke-width:1.2}
rect.composite{fill:#eef3fd;stroke:#a9bfee}
rect.decorator{fill:#f5effc;stroke:#c9b3e6}
@media(prefers-color-scheme:dark){
text{fill:#e5ecf2}
text.r{fill:#8f9ca9}
tspan{fill:#8fb4ff}
path{stroke:#45525e}
rect{fill:#1c252e;stroke:#3a4753}
rect.composite{fill:#1a2740;stroke:#3b5488}
rect.decorator{fill:#2a2138;stroke:#5c4780}
}
"""
# Within a page or a notebook a style sheet holds for all of it.
_SHEET = re.sub(r"(?m)^(?=[a-z])", ".bt ", _TREE_STYLE).replace("\n", "")


def _place(node: Behaviour, layer: int, row: int, boxes: list[_Box]) -> int:
    """Place a subtree from ``row`` on and return the row after it; parents stand amid their children."""
    box = _Box(node, describe(node), layer)
    texts = _text_width(box.shown.title, 7.7), _text_width(box.shown.remark, 6.8)
    box.width = 22.0 + max(texts)
    boxes.append(box)
    after = row
    for child in node.children:
        below = len(boxes)
        after = _place(child, layer + 1, after, boxes)
        box.children.append(boxes[below])
    if not box.children:
        after = row + 1
        box.y = _PICTURE_EDGE + row * _ROW_SPACING + _BOX_HEIGHT / 2
    else:
        box.y = (box.children[0].y + box.children[-1].y) / 2
    return after


def _svg_box(box: _Box, x: float, statuses: bool) -> str:
    shown, status = box.shown, box.node.status
    top = box.y - _BOX_HEIGHT / 2
    radius = _BOX_HEIGHT / 2 if shown.kind == "leaf" else 7
    # As a style: an attribute would be weaker than the style sheet.
    ticked = statuses and status is not Status.INVALID
    colour = f' style="stroke:{_BORDER_COLOURS[status]};stroke-width:2.4"' if ticked else ""
    faint = ' opacity="0.5"' if statuses and not ticked else ""
    base = box.y - 1.5 if shown.remark else box.y + 4.5
    glyph = f"<tspan>{_xml(shown.glyph)}</tspan> " if shown.glyph else ""
    name = _xml(shown.title.removeprefix(f"{shown.glyph} "))
    remark = f'<text class="r" x="{x + 11:g}" y="{box.y + 11:g}">{_xml(shown.remark)}</text>'
    return (
        f'<g{faint}><rect class="{shown.kind}" x="{x:g}" y="{top:g}" width="{box.width:g}" '
        f'height="{_BOX_HEIGHT:g}" rx="{radius:g}"{colour}/>'
        f'<text x="{x + 11:g}" y="{base:g}">{glyph}{name}</text>'
        f"{remark if shown.remark else ''}</g>"
    )


def _text_width(text: str, size: float) -> float:
    """Estimate the width of a text; the font is the viewer's."""
    share = {**dict.fromkeys(_NARROW, 0.6), **dict.fromkeys(_WIDE, 1.4)}
    return size * sum(share.get(letter, 1.0 if letter.isascii() else 1.5) for letter in text)


def _xml(text: str) -> str:
    return escape(printable(text))


def show_in_notebooks() -> None:
    """Let a notebook show any tree as a picture, with the statuses of its last tick once it was ticked.

    Composites are py_trees' classes, so IPython, if it runs, gets a function for showing nodes.
    """
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    if shell is not None:
        shell.display_formatter.formatters["image/svg+xml"].for_type(Behaviour, last_tick_svg)


def last_tick_svg(root: Behaviour) -> str:
    """Return the tree as a picture, with the statuses of its last tick once it was ticked."""
    return tree_svg(root, statuses=root.status is not Status.INVALID)


show_in_notebooks()
