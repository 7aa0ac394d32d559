"""Groot2's projects are read, and what is of version 3 of BehaviorTree.CPP is called so."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.plays.files import contents_of, find_play, load_play
from robobt.tree import preorder
from robobt.tree.interop import TreeFileError, Vocabulary, parse_xml

VOCABULARY = Vocabulary({})

MAIN = """<?xml version="1.0" encoding="UTF-8"?>
<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <Sequence><SubTree ID="Get" where="1;2"/><HasBall/></Sequence>
  </BehaviorTree>
</root>
"""
GET = """<root BTCPP_format="4" project_name="shooting">
  <BehaviorTree ID="Get"><GoToPose target="{where}"/></BehaviorTree>
  <TreeNodesModel><SubTree ID="Get"><input_port name="where"/></SubTree></TreeNodesModel>
</root>
"""


def project(*files: str, attributes: str = 'project_name="shooting"', more: str = "") -> str:
    included = "".join(f'<include path="{file}"/>' for file in files)
    return f'<root BTCPP_format="4" {attributes}>{included}{more}</root>'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "trees").mkdir()
    (tmp_path / "main.xml").write_text(MAIN)
    (tmp_path / "trees" / "get.xml").write_text(GET)
    return tmp_path


def test_the_name_of_a_project_is_read_over() -> None:
    text = (
        '<root BTCPP_format="4" project_name="p"><BehaviorTree ID="A"><AlwaysSuccess/></BehaviorTree></root>'
    )
    assert parse_xml(text, VOCABULARY).main == "A"


@pytest.mark.parametrize("files", [("main.xml", "trees/get.xml"), ("trees/get.xml", "main.xml")])
def test_a_project_is_the_trees_of_the_files_that_it_includes(files: tuple[str, ...], folder: Path) -> None:
    model = '<TreeNodesModel><Condition ID="HasBall" editable="true"/></TreeNodesModel>'
    path = folder / "shooting.btproj"
    path.write_text(project(*files, more=model))
    nodes = [type(node).__name__ for node in preorder(load_play(path)())]
    assert nodes == ["Sequence", "GoToPose", "HasBall"]


def test_a_project_is_read_again_when_a_file_of_it_has_changed(folder: Path) -> None:
    path = folder / "shooting.btproj"
    path.write_text(project("main.xml", "trees/get.xml"))
    before = contents_of(str(path))
    assert len(preorder(find_play(str(path))())) == 3
    (folder / "main.xml").write_text(MAIN.replace("<HasBall/>", "<HasBall/><HasBall/>"))
    assert len(preorder(find_play(str(path))())) == 4
    assert contents_of(str(path)) != before


def test_a_mistake_is_told_with_the_file_and_the_line_in_which_it_stands(folder: Path) -> None:
    (folder / "trees" / "get.xml").write_text(GET.replace("GoToPose target", "GoToPose sideways"))
    (folder / "shooting.btproj").write_text(project("main.xml", "trees/get.xml"))
    with pytest.raises(TreeFileError, match=r"trees/get\.xml:2: <GoToPose> has no attribute sideways"):
        load_play(folder / "shooting.btproj")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (project("gone.xml"), r"shooting\.btproj:1: <include>: .*gone\.xml: .*[Nn]o such file"),
        (project("main.txt"), "main.txt: a project includes files whose ending is .xml"),
        (project("main.xml", "trees/get.xml", "main.xml"), r"main\.xml:3: the tree 'Main' is there twice"),
        (project("main.xml"), r"main\.xml:4: no tree or play is called 'Get'"),
        (project("main.xml", *["trees/get.xml"] * 101), "a project includes at most 100 files"),
        ('<root BTCPP_format="4"><include ros_pkg="a" path="b.xml"/></root>', "no attribute ros_pkg"),
        ('<root BTCPP_format="4"><include/></root>', "<include> needs the attribute path"),
        (project(), r"shooting\.btproj:1: the project includes no tree"),
        (project("loop.xml"), r"loop\.xml:1: <include> is not supported"),
    ],
)
def test_what_is_wrong_with_a_project_is_one_line(text: str, said: str, folder: Path) -> None:
    (folder / "loop.xml").write_text(project("loop.xml"))
    path = folder / "shooting.btproj"
    path.write_text(text)
    with pytest.raises(TreeFileError, match=said) as raised:
        load_play(path)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (
            '<SubTreePlus ID="B" __autoremap="true"/>',
            "<SubTreePlus> is a tag of .* 3; .* it is SubTree",
        ),
        (
            '<SubTree ID="B" __shared_blackboard="true"/>',
            "__shared_blackboard; .* 3; .* it is gone",
        ),
        (
            '<SubTree ID="B" __autoremap="true"/>',
            "__autoremap; .* 3; .* it is _autoremap",
        ),
        ("<SequenceStar><AlwaysSuccess/></SequenceStar>", "3; in version 4 it is SequenceWithMemory"),
        ('<Control ID="SequenceStar"><AlwaysSuccess/></Control>', "<SequenceStar> is a tag of .* 3"),
        ("<FallbackStar><AlwaysSuccess/></FallbackStar>", "3; in version 4 it is Fallback"),
        *(
            (
                f'<BlackboardCheck{kind} value_A="{{a}}" value_B="1" return_on_mismatch="FAILURE">'
                f"<AlwaysSuccess/></BlackboardCheck{kind}>",
                f"<BlackboardCheck{kind}> is a tag of .* 3; in version 4 it is a script",
            )
            for kind in ("Int", "Double", "Bool", "String")
        ),
        ("<ManualSelector><AlwaysSuccess/></ManualSelector>", "3; in version 4 there is none"),
        (
            '<Parallel success_threshold="1"><AlwaysSuccess/></Parallel>',
            "CPP 3; .* it is success_count",
        ),
        (
            '<Parallel failure_threshold="1"><AlwaysSuccess/></Parallel>',
            "CPP 3; .* it is failure_count",
        ),
        ('<Parallel threshold="1"><AlwaysSuccess/></Parallel>', "CPP 3; .* it is success_count"),
    ],
)
def test_what_is_of_version_3_says_so_and_what_it_is_now(body: str, said: str) -> None:
    with pytest.raises(TreeFileError, match=said):
        parse_xml(f'<root BTCPP_format="4"><BehaviorTree ID="A">{body}</BehaviorTree></root>', VOCABULARY)


def test_a_file_without_a_format_is_one_of_version_3() -> None:
    with pytest.raises(TreeFileError, match=r"for BehaviorTree.CPP 3 .*; robobt reads version 4: convert"):
        parse_xml('<root><BehaviorTree ID="A"><AlwaysSuccess/></BehaviorTree></root>', VOCABULARY)
