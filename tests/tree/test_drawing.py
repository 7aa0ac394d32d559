import re
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from py_trees.common import ParallelPolicy

from robobt.tree import (
    Behaviour,
    FailureIsSuccess,
    Inverter,
    Leaf,
    Parallel,
    Retry,
    Selector,
    Sequence,
    Status,
    TreeRunner,
    preorder,
)
from robobt.tree.drawing import describe, tree_dot, tree_text
from robobt.tree.svg import show_in_notebooks, tree_svg

SVG = "{http://www.w3.org/2000/svg}"


class Drive(Leaf[None]):
    def __init__(self, *, speed: float = 1.0, style: str = "own", name: str = "") -> None:
        super().__init__(name)
        self.speed, self.style = speed, style

    def on_running(self) -> Status:
        return self.run("on the way")


class HasBall(Leaf[None]):
    def on_running(self) -> Status:
        return self.fail("no ball\nnear")


class Aim(Leaf[None]):
    def __init__(self, *, at: object = None, name: str = "") -> None:
        super().__init__(name)
        self.at = at

    def on_running(self) -> Status:
        return self.succeed()


def striker() -> Selector:
    return Selector(
        "striker",
        memory=False,
        children=[
            Sequence("score", memory=True, children=[HasBall(), Aim(name="pick a corner")]),
            Drive(speed=2.5, name="run"),
        ],
    )


def ticked(root: Selector) -> Selector:
    TreeRunner(root, None).tick()
    return root


def test_the_text_is_the_tree_with_its_kinds_classes_and_changed_parameters() -> None:
    assert tree_text(striker()).splitlines() == [
        "? striker (Selector, reactive)",
        "├─ → score (Sequence, memory)",
        "│  ├─ HasBall",
        "│  └─ pick a corner (Aim)",
        "└─ run (Drive, speed=2.5)",
    ]


def test_the_text_tells_what_every_node_returned_and_said() -> None:
    assert tree_text(ticked(striker()), statuses=True).splitlines() == [
        "▶ ? striker (Selector, reactive)",
        "✗ ├─ → score (Sequence, memory)",
        "✗ │  ├─ HasBall — no ball near",
        "· │  └─ pick a corner (Aim)",
        "▶ └─ run (Drive, speed=2.5) — on the way",
    ]


@pytest.mark.parametrize(
    ("node", "kind", "glyph", "detail"),
    [
        (Sequence("a", memory=True), "composite", "→", "memory"),
        (Selector("a", memory=False), "composite", "?", "reactive"),
        (Parallel("a", policy=ParallelPolicy.SuccessOnAll()), "composite", "⇉", "all"),
        (Parallel("a", policy=ParallelPolicy.SuccessOnOne()), "composite", "⇉", "one"),
        (Inverter("a", Drive()), "decorator", "◇", ""),
        (Retry("a", Drive(), num_failures=3), "decorator", "◇", "num_failures=3"),
        (Drive(style="robobulls"), "leaf", "", "style=robobulls"),
        (Drive(), "leaf", "", ""),
    ],
)
def test_each_kind_of_node_is_described_in_its_own_words(
    node: Leaf[None], kind: str, glyph: str, detail: str
) -> None:
    told = describe(node)
    assert (told.kind, told.glyph, told.detail) == (kind, glyph, detail)


def test_parameters_are_short_and_the_same_in_every_process() -> None:
    assert describe(Aim(at=max)).detail == "at=max"
    assert describe(Aim(at=object())).detail == "at=object"
    assert len(describe(Aim(at="x" * 500)).detail) < 50


def test_a_parameter_that_cannot_be_compared_counts_as_changed() -> None:
    assert describe(Aim(at=np.zeros(2))).detail == "at=array([0., 0.])"


def test_the_picture_has_a_box_a_node_and_a_line_a_child() -> None:
    root = ElementTree.fromstring(tree_svg(striker()))
    assert len(root.findall(f".//{SVG}rect")) == 5
    assert len(root.findall(f".//{SVG}path")) == 4
    assert "".join(root.findall(f".//{SVG}text")[0].itertext()) == "? striker"


def test_the_picture_colours_only_what_was_ticked() -> None:
    drawn = tree_svg(ticked(striker()), statuses=True)
    groups = ElementTree.fromstring(drawn).findall(f"{SVG}g")
    faint = ["".join(group.itertext()) for group in groups if group.get("opacity")]
    assert faint == ["pick a cornerAim"]
    assert len(re.findall("stroke:#dd4b41", drawn)) == 2


def test_boxes_stay_inside_the_picture_and_apart() -> None:
    wide = Selector("root", memory=False, children=[striker(), Sequence("s", True, [Drive(), striker()])])
    root = ElementTree.fromstring(tree_svg(wide))
    boxes = [
        [float(rect.get(key, "nan")) for key in ("x", "y", "width", "height")]
        for rect in root.findall(f".//{SVG}rect")
    ]
    total, height = float(root.get("width", "nan")), float(root.get("height", "nan"))
    assert len(boxes) == 13
    for place, (x, y, w, h) in enumerate(boxes):
        assert x >= 0
        assert y >= 0
        assert x + w <= total
        assert y + h <= height
        for u, v, w2, h2 in boxes[:place]:
            assert x >= u + w2 or u >= x + w or y >= v + h2 or v >= y + h


@settings(max_examples=60)
@given(st.text(min_size=1, max_size=40))
def test_any_name_can_be_drawn(name: str) -> None:
    root = Selector(name, memory=False, children=[Drive(name=name)])
    assert len(tree_text(root).splitlines()) >= 2
    drawn = ElementTree.fromstring(tree_svg(root))
    assert len(drawn.findall(f".//{SVG}rect")) == 2
    # Every quotation mark that is not escaped opens or closes a text, so lines have even counts.
    for line in tree_dot(root).split("\n"):
        assert len(re.findall(r'(?<!\\)(?:\\\\)*"', line)) % 2 == 0


def test_markup_in_a_name_is_text() -> None:
    drawn = tree_svg(Drive(name="<script>&</script>"))
    assert "<script>" not in drawn
    texts = ["".join(text.itertext()) for text in ElementTree.fromstring(drawn).iter(f"{SVG}text")]
    assert texts[0] == "<script>&</script>"


def test_graphviz_gets_every_node_and_edge_in_order() -> None:
    root = FailureIsSuccess("calm", striker())
    lines = tree_dot(root).splitlines()
    assert lines[0] == 'digraph "calm" {'
    assert sum("label=" in line for line in lines) == len(preorder(root))
    assert [line.strip() for line in lines if "->" in line] == [
        "n0 -> n1;",
        "n1 -> n2;",
        "n1 -> n5;",
        "n2 -> n3;",
        "n2 -> n4;",
    ]
    assert '"say \\"hi\\" \\\\ n"' in tree_dot(Drive(name='say "hi" \\ n'))


def test_a_tree_shows_itself_in_a_notebook_with_its_statuses_once_it_was_ticked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tree = Sequence("go", memory=False, children=[Drive(), HasBall()])
    shown: dict[type, Callable[[Behaviour], str]] = {}
    formatters = {"image/svg+xml": SimpleNamespace(for_type=shown.__setitem__)}
    shell = SimpleNamespace(display_formatter=SimpleNamespace(formatters=formatters))
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    show_in_notebooks()
    show = shown[Behaviour]
    assert show(tree) == tree_svg(tree)
    TreeRunner(tree, None).tick()
    assert show(tree) == tree_svg(tree, statuses=True) != tree_svg(tree)


def test_without_a_notebook_nothing_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: None))
    show_in_notebooks()
    monkeypatch.delitem(sys.modules, "IPython")
    show_in_notebooks()


def test_its_style_sheet_leaves_the_rest_of_a_page_alone() -> None:
    root = ElementTree.fromstring(tree_svg(Drive()))
    sheet = root.find(f"{SVG}style").text
    rules = re.findall(r"([^{}]+)\{[^{}]*\}", re.sub(r"@media[^{]*\{", "", sheet))
    assert len(rules) > 10
    assert all(rule.startswith(".bt ") for rule in rules)
    assert root.get("class") == "bt"
