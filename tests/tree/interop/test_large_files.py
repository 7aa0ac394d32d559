"""A small file that stands for a large tree is refused before the tree is built."""

from __future__ import annotations

from typing import ClassVar

import pytest

from robobt.tree import Behaviour, Leaf, Sequence, Status, WiringError, check_tree
from robobt.tree.interop import TreeFileError, Vocabulary, build_tree, parse_xml, parse_yaml
from robobt.tree.interop import verify as verification


class Costly(Leaf[None]):
    made: ClassVar[int] = 0

    def __init__(self, name: str = "") -> None:
        super().__init__(name)
        Costly.made += 1

    def on_running(self) -> Status:
        return self.succeed()


def costly() -> Behaviour:
    return Sequence("costly", memory=False, children=[Costly() for _ in range(49)])


def single() -> Behaviour:
    return Costly()


VOCABULARY = Vocabulary({"Costly": Costly}, {"costly": costly, "single": single})


@pytest.fixture(autouse=True)
def nothing_made() -> None:
    Costly.made = 0


def xml(leaf: str, levels: int, wide: int = 10) -> str:
    inner = [f'<SubTree ID="T{level + 1}"/>' * wide for level in range(levels - 1)] + [leaf * wide]
    trees = "".join(
        f'<BehaviorTree ID="T{level}"><Sequence>{part}</Sequence></BehaviorTree>'
        for level, part in enumerate(inner)
    )
    return f'<root BTCPP_format="4">{trees}</root>'


def yaml(leaf: str, levels: int, wide: int = 10) -> str:
    parts = [f"{{SubTree: {{tree: T{level + 1}}}}}" for level in range(levels - 1)] + [leaf]
    whole = [
        f"{{Sequence: {{name: s, memory: false, children: [{', '.join([part] * wide)}]}}}}" for part in parts
    ]
    trees = "".join(f"  T{level}:\n    tree: {part}\n" for level, part in enumerate(whole) if level)
    return f"play: T0\ntrees:\n{trees}tree: {whole[0]}\n"


LARGE = {
    "leaves in XML": (parse_xml, xml("<Costly/>", 5), 0),
    "leaves in YAML": (parse_yaml, yaml("Costly", 5), 0),
    "sub-trees in one another": (parse_xml, xml("<Costly/>", 40, 2), 0),
    # A play's nodes are known once it has been built.
    "plays": (parse_xml, xml('<SubTree ID="costly"/>', 3), 49),
    "plays in YAML": (parse_yaml, yaml("{SubTree: {tree: costly}}", 3), 49),
    "plays in a sequence": (parse_xml, xml('<SubTree ID="costly"/>', 1, 201), 49),
}


@pytest.mark.parametrize("which", LARGE)
def test_a_file_for_too_many_nodes_is_refused_before_they_are_made(which: str) -> None:
    parse, text, most = LARGE[which]
    file = parse(text, VOCABULARY)
    with pytest.raises(TreeFileError, match="the tree has more than 10000 nodes"):
        build_tree(file, VOCABULARY)
    assert Costly.made <= most


@pytest.mark.parametrize(
    ("text", "nodes"),
    [
        (xml("<Costly/>", 3), 1000),
        (xml('<SubTree ID="single"/>', 3), 1000),
        (xml('<SubTree ID="costly"/>', 1, 199), 199 * 49),
    ],
)
def test_a_file_for_many_nodes_is_built(text: str, nodes: int) -> None:
    build_tree(parse_xml(text, VOCABULARY), VOCABULARY)
    assert Costly.made == nodes


def test_trees_that_see_what_is_around_them_are_each_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[object] = []
    specs_of = verification.specs_of

    def counting(spec: object) -> object:
        looked.append(spec)
        return specs_of(spec)  # type: ignore[arg-type]

    monkeypatch.setattr(verification, "specs_of", counting)
    chain = "".join(
        f'<BehaviorTree ID="T{level}"><SubTree ID="T{level + 1}" _autoremap="true"/></BehaviorTree>'
        for level in range(80)
    )
    parse_xml(
        f'<root BTCPP_format="4">{chain}<BehaviorTree ID="T80"><Costly/></BehaviorTree></root>', VOCABULARY
    )
    assert len(looked) == 80


def test_a_deep_chain_of_many_nodes_from_python_is_refused() -> None:
    node: Behaviour = Costly()
    for _ in range(10_000):
        above = Sequence("above", memory=False)
        above.add_child(node)
        node = above
    with pytest.raises(WiringError, match="may be 200 nodes deep, and this one is deeper"):
        check_tree(node, object)
