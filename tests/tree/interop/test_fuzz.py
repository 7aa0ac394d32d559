"""Tree files mutated at random give a tree or one line that says what is wrong; never anything else."""

from __future__ import annotations

import copy
import random
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from robobt.config.yaml import parse_marked
from robobt.plays import PLAYS
from robobt.plays.files import VOCABULARY as PLAYS_VOCABULARY
from robobt.plays.files import tree_yaml
from robobt.tree import Behaviour
from robobt.tree.interop import (
    TreeFile,
    TreeFileError,
    Vocabulary,
    build_tree,
    describe_tree,
    parse_xml,
    parse_yaml,
    try_build,
    write_xml,
    write_yaml,
)
from tests.tree.interop.differences import tree_differences
from tests.tree.tutorial_nodes import VOCABULARY as TUTORIAL_VOCABULARY

EVERYTHING = """
play: all
description: Everything that a file can say.
params:
  speed: 1.0
  place: {type: int, default: 0}
  far: {type: float | none, default: null}
trees:
  part:
    params: {again: true, name: {type: shot rater}}
    tree: {Sequence: {name: part, memory: $again, children: [HasBall, {SelectShot: {rater: $name}}]}}
tree:
  Selector:
    name: all
    memory: false
    children:
      - Wall: {place: $place, size: 2}
      - GoToPose: {target: [1, 2.5], limits: {max_speed: $speed}, heading: $far}
      - SubTree: {tree: part, params: {name: open_angle, again: false}}
      - Timeout: {name: in time, seconds: 2, child: {Repeat: {name: twice, num_success: 2, child: Stop}}}
      - ParallelCount: {name: both, success_count: 1, children: [Stop, {IsRestart: {kind: penalty}}]}
      - RefereeSwitch: {name: phases, cases: {halt | stop: Stop, play: Wall}, otherwise: Stop}
      - SubTree: {tree: refereed_goalkeeper}
      - {SelectShot: {rater: {name: gaussian, spacing: 0.03}, name: "a \\"name\\""}}
"""

YAML_SEEDS = [
    EVERYTHING,
    *[tree_yaml(PLAYS[name](), name) for name in ("attack_support", "refereed_goalkeeper")],
]
YAML_DATA = {text: parse_marked(text, "seed").plain() for text in YAML_SEEDS}
XML_SEEDS = [path.read_text() for path in sorted((Path(__file__).parent / "data").glob("*.xml"))]

# Pieces that mean something to YAML, to XML, to numbers or to the files' own languages.
PIECES = [
    *"{}[]<>&*!|:-#\"'$%@`,=?/\\ \n\t\r\x00\x85",
    *[
        "---\n",
        "- ",
        ": ",
        "<<: ",
        "!!python/object:os.system ",
        "&a ",
        "*a",
        "$",
        "$$",
        "$speed",
    ],
    *["null", "~", "true", "no", ".inf", "-.nan", "1e999", "0x10", "1_000", "9" * 400, "1:30", "2020-01-01"],
    *[
        "<!--",
        "-->",
        "<![CDATA[",
        "]]>",
        "<!DOCTYPE a>",
        "<!ENTITY a 'b'>",
        "&lol;",
        "&#0;",
        "&#x41;",
        "<?x?>",
    ],
    *[
        "{x}",
        "{=}",
        "{@x}",
        "json:",
        "json:{}",
        "json:[",
        ";",
        "1;2",
        " | ",
        "ID",
        "name",
        "SubTree",
        "children",
    ],
    *["é", "\u2028", "\ufeff", "\ud800", "😀", "cases", "play", "tree", "params", "memory"],
]

VALUES: list[Any] = [
    *[None, True, False, 0, -1, 2, 10**30, 0.5, -2.5, 1e308, float("inf"), float("nan")],
    *[
        "",
        " ",
        "word",
        "$speed",
        "$nothing",
        "$$",
        "\x00",
        "a\nb",
        "x" * 5000,
    ],
    *["Stop", "SubTree", "halt | stop", "{target}", "{x}", "json:[1]", "1;2;3", "true", "-1", "penalty"],
    *[
        [],
        [None],
        [1, 2],
        ["Stop"],
        {},
        {"Stop": None},
        {"a": {}},
        {"tree": "part"},
    ],
]


def mutated_bytes(rng: random.Random, text: str, others: list[str]) -> bytes:
    """A text with some bytes changed, cut, doubled or taken from another."""
    content = bytearray(text.encode())
    for _ in range(rng.choice([1, 1, 2, 3, 8, 30])):
        place = rng.randrange(len(content) + 1)
        length = rng.choice([0, 1, 1, 2, 5, 40])
        what = rng.randrange(6)
        if what == 0:
            content[place : place + length] = bytes(rng.randrange(256) for _ in range(length))
        elif what == 1:
            del content[place : place + length]
        elif what == 2:
            content[place:place] = content[place : place + length] * rng.choice([1, 2, 50])
        elif what == 3:
            other = rng.choice(others).encode()
            start = rng.randrange(len(other))
            content[place : place + length] = other[start : start + rng.choice([3, 20, 200])]
        elif what == 4 and content:
            content[place % len(content)] ^= 1 << rng.randrange(8)
        else:
            piece = rng.choice(PIECES).encode("utf-8", "surrogatepass")
            content[place : place + length] = piece * rng.choice([1, 1, 1, 60])
    return bytes(content)


def mutated_yaml(rng: random.Random, text: str, others: list[str]) -> bytes:
    """A YAML text with parts of its data changed."""
    data = copy.deepcopy(YAML_DATA[text])
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        places = list(places_in(data))
        holder, key = rng.choice(places)
        what = rng.randrange(5)
        if what == 0:
            holder[key] = copy.deepcopy(rng.choice(VALUES))
        elif what == 1:
            del holder[key]
        elif what == 2:
            other, its = rng.choice(list(places_in(copy.deepcopy(YAML_DATA[rng.choice(others)]))))
            holder[key] = other[its]
        elif what == 3 and isinstance(holder, dict):
            holder[rng.choice([*PIECES[30:], "sise", "Stop", "rater"])] = holder.pop(key)
        else:
            holder[key] = (
                [holder[key]] if rng.random() < 0.5 else {"Inverter": {"name": "i", "child": holder[key]}}
            )
        if not list(places_in(data)):
            break
    written = StringIO()
    YAML(typ="safe", pure=True).dump(data, written)
    return written.getvalue().encode("utf-8", "surrogatepass")


def places_in(data: Any) -> Any:
    """Every place in nested data, as its holder and key."""
    for key in list(data) if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ():
        yield data, key
        yield from places_in(data[key])


def mutated_xml(rng: random.Random, text: str, others: list[str]) -> bytes:
    """An XML text with elements and attributes changed."""
    root = ElementTree.fromstring(text)
    tags = [element.tag for other in others for element in ElementTree.fromstring(other).iter()]
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        elements = list(root.iter())
        element = rng.choice(elements)
        what = rng.randrange(7)
        if what == 0:
            element.tag = rng.choice([*tags, "Action", "Condition", "Control", "Script", "Selector", "x"])
        elif what == 1 and element.attrib:
            element.set(rng.choice(list(element.attrib)), f"{rng.choice(VALUES)}")
        elif what == 2 and element.attrib:
            value = element.attrib.pop(rng.choice(list(element.attrib)))
            if rng.random() < 0.5:
                element.set(
                    rng.choice(["ID", "name", "_skipIf", "_autoremap", "message", "msec", "x"]), value
                )
        elif what == 3 and len(element):
            element.remove(rng.choice(list(element)))
        elif what == 4:
            element.append(rng.choice(list(ElementTree.fromstring(rng.choice(others)).iter())))
        elif what == 5:
            element.text = rng.choice(["", "words", " \n "])
        else:
            element.append(ElementTree.Element(rng.choice(tags), {"name": "n"}))
    return ElementTree.tostring(root, encoding="unicode").encode("utf-8", "surrogatepass")


Parse = Callable[[bytes, Vocabulary, str], TreeFile]


def outcome(content: bytes, parse: Parse, vocabulary: Vocabulary) -> TreeFile | TreeFileError:
    """What a text is: a file whose main tree can be built, or an error."""
    try:
        file = parse(content, vocabulary, "fuzz")
        try_build(file, vocabulary)
    except TreeFileError as error:
        return error
    return file


def check(content: bytes, parse: Parse, vocabulary: Vocabulary) -> bool:
    """Check one text; True when it is a tree."""
    found = outcome(content, parse, vocabulary)
    if isinstance(found, TreeFileError):
        said = str(found)
        assert said.startswith("fuzz:")
        assert said.isprintable()
        assert len(said) <= 600
        assert found.line is None or 1 <= found.line <= lines_in(content)
        return False
    main = found.trees[found.main]
    if all(not entry.required for entry in main.parameters.values()):
        root = build_tree(found, vocabulary)
        check_saved(root, vocabulary)
    return True


def lines_in(content: bytes) -> int:
    """At most how many lines anybody sees in a text; YAML knows rarer line ends than others."""
    ends = ("\n", "\r", "\x85", "\u2028", "\u2029")
    return 2 + sum(content.count(end.encode()) for end in ends)


def check_saved(root: Behaviour, vocabulary: Vocabulary) -> None:
    """What has been read can be written and read again."""
    text = write_yaml(describe_tree(root, vocabulary, "fuzz"))
    again = build_tree(parse_yaml(text, vocabulary), vocabulary)
    assert tree_differences(root, again, vocabulary) == []
    try:
        text = write_xml(describe_tree(root, vocabulary, "fuzz"), vocabulary)
    except ValueError:
        # Half milliseconds and control characters, which XML has not.
        return
    try:
        again = build_tree(parse_xml(text, vocabulary), vocabulary)
    except TreeFileError as error:
        # XML wants children where py_trees does without.
        assert "needs a child" in error.problem or "neither 1 or more" in error.problem  # noqa: PT017
        return
    assert tree_differences(root, again, vocabulary) == []


def run(kind: str, seed: int, count: int) -> tuple[int, int]:
    """Check so many mutated texts of a kind; how many were trees and how many errors."""
    rng = random.Random(seed)
    trees = 0
    for _ in range(count):
        if kind == "yaml":
            text = rng.choice(YAML_SEEDS)
            mutate = mutated_yaml if rng.random() < 0.5 else mutated_bytes
            trees += check(mutate(rng, text, YAML_SEEDS), parse_yaml, PLAYS_VOCABULARY)
        else:
            text = rng.choice(XML_SEEDS)
            mutate = mutated_xml if rng.random() < 0.5 else mutated_bytes
            trees += check(mutate(rng, text, XML_SEEDS), parse_xml, TUTORIAL_VOCABULARY)
    return trees, count - trees


@pytest.mark.integration
@pytest.mark.parametrize("kind", ["yaml", "xml"])
def test_mutated_files_are_trees_or_clear_errors(kind: str) -> None:
    trees, errors = run(kind, 1, 200)
    # Neither all the one nor all the other, or nothing would have been looked at.
    assert trees > 4
    assert errors > 40


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["yaml", "xml"])
@pytest.mark.parametrize("seed", range(10, 20))
def test_a_hundred_thousand_mutated_files_are_trees_or_clear_errors(kind: str, seed: int) -> None:
    trees, errors = run(kind, seed, 5000)
    assert trees > 100
    assert errors > 1000


@pytest.mark.parametrize("seed", range(len(YAML_SEEDS)))
def test_the_yaml_the_mutations_start_from_is_a_tree(seed: int) -> None:
    assert check(YAML_SEEDS[seed].encode(), parse_yaml, PLAYS_VOCABULARY)


@pytest.mark.parametrize("seed", range(len(XML_SEEDS)))
def test_the_xml_the_mutations_start_from_is_a_tree(seed: int) -> None:
    assert check(XML_SEEDS[seed].encode(), parse_xml, TUTORIAL_VOCABULARY)
