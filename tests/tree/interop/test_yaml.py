"""Trees in YAML: built, equal to what Python builds, saved, and refused with file and line."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.plays import PLAYS
from robobt.plays.files import VOCABULARY, find_play, load_play, tree_yaml
from robobt.skills import GoToPose, IsRestart, SelectShot, Stop, Wall
from robobt.skills.aim.raters import OpenAngle
from robobt.skills.restarts.referee_switch import RefereeSwitch
from robobt.tree import Behaviour, Inverter, Leaf, Selector, Sequence, Status, nodes
from robobt.tree.by_name import ByName
from robobt.tree.interop import (
    TreeFileError,
    Vocabulary,
    build_tree,
    describe_tree,
    parse_yaml,
    write_yaml,
)
from robobt.tree.interop.vocabulary import CONTROL
from robobt.tree.nodes import Cooldown, TickDivider
from robobt.tree.parameters import parameters_of
from robobt.world.game import Restart
from robobt.world.limits import RobotLimits
from tests.tree.interop.differences import tree_differences


def build(text: str, **given: Any) -> Behaviour:
    return build_tree(parse_yaml(text, VOCABULARY, "test.yaml"), VOCABULARY, given)


def tree(node: str, params: str = "{}", **given: Any) -> Behaviour:
    return build(f"play: test\nparams: {params}\ntree: {node}\n", **given)


def same(one: Behaviour, other: Behaviour) -> bool:
    return tree_differences(one, other, VOCABULARY) == []


def problem(text: str) -> str:
    with pytest.raises(TreeFileError) as caught:
        build(text)
    assert "\n" not in str(caught.value)
    assert caught.value.file == "test.yaml"
    return str(caught.value)


def test_a_file_reads_as_the_tree_it_builds() -> None:
    root = build(
        """
        play: striker
        description: Scores, or gets the ball.
        params: {range: 4.0}
        tree:
          Selector:
            name: striker
            memory: false
            children:
              - Sequence:
                  name: score
                  memory: false
                  children:
                    - SelectShot: {max_distance: $range}
                    - KickToTarget
              - GoToBall: {name: to the ball}
        """
    )
    assert isinstance(root, Selector)
    assert [child.name for child in root.children] == ["score", "to the ball"]
    assert root.children[0].children[0].parameters()["max_distance"] == 4.0  # type: ignore[attr-defined]


def settings_of(builder: Callable[..., Behaviour]) -> list[dict[str, Any]]:
    """Sets of parameters to try: the defaults, others one by one, and others all together."""
    others = {parameter.name: other_values(parameter) for parameter in parameters_of(builder)}
    found: list[dict[str, Any]] = [{}]
    found += [{name: value} for name, values in others.items() for value in values]
    found.append({name: values[-1] for name, values in others.items() if values})
    return found


def other_values(parameter: Any) -> list[Any]:
    """Values that fit a play's parameter."""
    hint = parameter.hint
    if get_origin(hint) is Literal:
        return list(get_args(hint))
    if get_origin(hint) is tuple:
        return [(0.5,) * len(get_args(hint))]
    for part in get_args(hint):
        if isinstance(part, ByName):
            return list(part.registry)
    by_type: list[tuple[type, list[Any]]] = [(bool, [True, False]), (float, [0.5]), (int, [1, 2])]
    return next((values for kind, values in by_type if kind in (hint, *get_args(hint))), [])


def shipped() -> list[str]:
    """The plays of the package; other test modules enter their own beside them."""
    return [name for name in PLAYS if PLAYS[name].__module__.startswith("robobt.")]


@pytest.mark.integration
@pytest.mark.parametrize("play", shipped())
def test_every_play_that_ships_can_be_saved_and_read_back_whatever_its_parameters(play: str) -> None:
    builder = PLAYS[play]
    built = 0
    for parameters in settings_of(builder):
        try:
            root = builder(**parameters)
        except ValueError:
            continue
        built += 1
        text = tree_yaml(root, play)
        again = build(text)
        assert tree_differences(root, again, VOCABULARY) == [], parameters
        # What they are written from, which tells 1 from 1.0 as the text does.
        assert repr(describe_tree(again, VOCABULARY, play)) == repr(describe_tree(root, VOCABULARY, play))
    assert built >= len(parameters_of(builder))


@pytest.mark.parametrize(
    "root",
    [
        GoToPose(target=(0.1, -2.0), heading=1e-7, name="a: name # with -- signs"),
        GoToPose(limits=RobotLimits(max_speed=2.0, side_braking=1.0), name="$dollar"),
        IsRestart(kind=Restart.PENALTY, ours=False, name="yes"),
        SelectShot(rater=OpenAngle(), max_distance=3.0, name="1e-3"),
        SelectShot(rater="open_angle", name="2020-01-01"),
        Inverter("not", Stop(name="Stop it")),
        Cooldown("rest", Stop(), seconds=2.0, after="failure"),
        TickDivider("seldom", Stop(), every=3),
        RefereeSwitch("phases", {"halt": Stop(), "play": Wall()}),
        Sequence("empty", memory=True),
    ],
    ids=lambda root: root.name,
)
def test_values_of_all_kinds_are_saved_and_read_back(root: Behaviour) -> None:
    assert same(root, build(tree_yaml(root, "test")))


@pytest.mark.integration
@given(
    target=st.none() | st.tuples(st.floats(-9, 9), st.floats(-9, 9)),
    heading=st.none() | st.floats(allow_nan=False, allow_infinity=False),
    name=st.text(min_size=1, max_size=20).filter(lambda name: name.isprintable() and name.strip()),
)
@settings(max_examples=40)
def test_whatever_a_skill_is_made_from_is_saved_and_read_back(
    target: Any, heading: float | None, name: str
) -> None:
    root = GoToPose(target=target, heading=heading, name=name)
    assert same(root, build(tree_yaml(root, "test")))


def test_a_child_that_serves_several_cases_stays_one_child() -> None:
    waiting = Stop()
    root = RefereeSwitch("phases", {"halt": waiting, "play": Wall(), "stop": waiting}, otherwise=Stop())
    text = tree_yaml(root, "test")
    assert "halt | stop: Stop" in text
    again = build(text)
    assert isinstance(again, RefereeSwitch)
    assert again.cases["halt"] is again.cases["stop"]
    assert len(again.children) == 3


def test_differences_are_told_with_path_and_values() -> None:
    def root(memory: bool, place: int, name: str = "root", more: int = 0) -> Behaviour:
        children: list[Behaviour] = [Wall(place=place, size=3), *[Stop() for _ in range(more)]]
        return Sequence(name, memory=memory, children=children)

    one = root(True, 1)
    assert tree_differences(one, root(True, 1), VOCABULARY) == []
    assert tree_differences(one, root(False, 2), VOCABULARY) == [
        "root: memory is True and False",
        "root/Wall: place is 1 and 2",
    ]
    assert tree_differences(one, root(True, 1, "other"), VOCABULARY) == [
        "root: Sequence 'root' and Sequence 'other'"
    ]
    assert tree_differences(one, root(True, 1, more=1), VOCABULARY) == ["root: 1 children and 2"]
    assert tree_differences(Stop(), Wall(name="Stop"), VOCABULARY) == ["Stop: Stop 'Stop' and Wall 'Stop'"]


def test_parameters_stand_for_what_the_caller_gives() -> None:
    node, params = "{Wall: {place: $place, size: $size}}", "{place: 0, size: {type: int, default: 3}}"
    assert same(tree(node, params), Wall(place=0, size=3))
    assert same(tree(node, params, place=2), Wall(place=2, size=3))


@pytest.mark.parametrize(
    ("params", "kind", "default"),
    [
        ("{p: 1}", "int", 1),
        ("{p: 1.0}", "float", 1.0),
        ("{p: 1e-3}", "float", 1e-3),
        ("{p: true}", "bool", True),
        ("{p: word}", "str", "word"),
        ("{p: [1, 2.5]}", "tuple[float, float]", [1, 2.5]),
        ("{p: {default: 2}}", "int", 2),
        ("{p: {type: float | none, default: null}}", "float | none", None),
        ("{p: {type: point}}", "tuple[float, float]", inspect.Parameter.empty),
    ],
)
def test_a_parameter_has_the_type_of_its_default_or_the_one_it_says(
    params: str, kind: str, default: Any
) -> None:
    (parameter,) = (
        parse_yaml(f"play: p\nparams: {params}\ntree: Stop\n", VOCABULARY).trees["p"].parameters.values()
    )
    assert parameter.kind == kind
    assert parameter.default == default


def test_a_tree_of_the_file_can_be_used_again_and_again_and_a_play_too() -> None:
    root = build(
        """
        play: p
        params: {size: 2}
        trees:
          wall:
            params: {place: {type: int}, size: 4}
            tree: {Wall: {place: $place, size: $size}}
        tree:
          Selector:
            name: all
            memory: true
            children:
              - SubTree: {tree: wall, params: {place: 1, size: $size}}
              - SubTree: {tree: wall, params: {place: 3}}
              - SubTree: {tree: goalkeeper, params: {speed_factor: 0.5}}
        """
    )
    children = [Wall(place=1, size=2), Wall(place=3, size=4), PLAYS["goalkeeper"](speed_factor=0.5)]
    assert same(root, Selector("all", memory=True, children=children))


def test_a_text_that_begins_with_a_dollar_is_written_with_two() -> None:
    text = "play: p\nparams: {text: $$x}\ntree: Stop\n"
    assert parse_yaml(text, VOCABULARY).trees["p"].parameters["text"].default == "$x"


@pytest.mark.parametrize(
    ("text", "where"),
    [
        ("", "test.yaml:1: a tree file is a mapping"),
        ("play: p", "test.yaml:1: a tree file needs 'tree'"),
        ("tree: Stop", "needs 'play'"),
        ("play: p\ntree: Stop\nroot: Stop", "test.yaml:3: a tree file has no 'root'"),
        ("play: 3\ntree: Stop", "play is a text on one line"),
        ("play: p\ndescription: [1]\ntree: Stop", "test.yaml:2: the description is text"),
        ("play: p\ntree: Sotp", "test.yaml:2: no node is called 'Sotp'; is it Stop"),
        (
            "play: p\ntree: {Retry: {name: r, num_failures: -1, child: Stop}}",
            "Retry: num_failures: should be 1 or more; FailureIsRunning tries without end, not -1",
        ),
        (
            "play: p\ntree: {Repeat: {name: r, num_success: 0, child: Stop}}",
            "Repeat: num_success: should be 1 or more, or -1 for without end, not 0",
        ),
        ("play: p\ntree: qqqq", "there are Aim"),
        ("play: p\ntree: 3", "a node is a name"),
        ("play: p\ntree: {Wall: 3}", "Wall takes its parameters by name"),
        (
            "play: p\ntree:\n  Wall:\n    place: 0\n    sise: 2",
            "test.yaml:5: Wall: sise: Wall has no such parameter",
        ),
        (
            "play: p\ntree:\n  Wall:\n    place: two",
            "test.yaml:4: Wall: place: input should be a valid integer",
        ),
        ('play: p\ntree: {Wall: {place: "1"}}', "Wall: place: .*valid integer"),
        ("play: p\ntree:\n  Wall: {place: 3}", "test.yaml:3: Wall: place 3 is not one of a wall of 1"),
        ("play: p\ntree: {GoToPose: {heading: .nan}}", "GoToPose: heading"),
        (
            "play: p\ntree: {GoToPose: {target: 60}}",
            "test.yaml:2: GoToPose: target: input should be a list, not 60",
        ),
        ("play: p\ntree: {GoToPose: {limits: {top_speed: 1}}}", "limits.top_speed"),
        ("play: p\ntree: {IsRestart: {kind: corner}}", "IsRestart: kind"),
        (
            "play: p\ntree:\n  SelectShot:\n    rater: {name: open_angle, clearence: 1}",
            r"test.yaml:4: SelectShot: rater.clearence: .*did you mean clearance\?",
        ),
        ("play: p\ntree: {SelectShot: {rater: {name: guess}}}", "SelectShot: rater.name: no shot rater"),
        (
            "play: p\ntree: {SelectShot: {rater: {open_angle: {}}}}",
            r"rater.name: .*write {name: open_angle, ",
        ),
        (
            "play: p\nparams: {r: {type: shot rater, default: {name: gausian}}}\ntree: Stop",
            r"r.name: .*did you mean gaussian\?",
        ),
        ("play: p\ntree: {Stop: {name: [1]}}", "name is a text"),
        ("play: p\ntree: {Sequence: {name: s, children: [Stop]}}", "memory: Sequence needs this parameter"),
        ("play: p\ntree: {Sequence: {name: s, memory: true, children: Stop}}", "children is a list of nodes"),
        (
            "play: p\ntree: {Sequence: {name: s, memory: true, child: Stop}}",
            "child: Sequence has no such parameter",
        ),
        ("play: p\ntree: {Inverter: {name: i}}", "child: Inverter needs this branch"),
        ("play: p\ntree: {Inverter: {name: i, child: }}", "a node is a name"),
        ("play: p\ntree: {RefereeSwitch: {name: r, cases: {corner: Stop}}}", "'corner' is no phase"),
        ("play: p\ntree: {Timeout: {name: t, seconds: -1, child: Stop}}", "seconds must be 0 or more"),
        ("play: p\ntree: {Wall: {place: $where}}", "the tree has no parameter 'where'; it has none"),
        ("play: p\nparams: {a: 1}\ntree: {Wall: {place: $b}}", "no parameter 'b'; it has a"),
        ("play: p\nparams: {a: 1.5}\ntree: {Wall: {place: $a}}", "Wall: place: .*valid integer"),
        ("play: p\ntree: {Wall: {place: $}}", r"is not \$name"),
        ("play: p\nparams: [1]\ntree: Stop", "test.yaml:2: params is a mapping"),
        ("play: p\nparams: {a: null}\ntree: Stop", "a: its type does not follow from its default"),
        ("play: p\nparams: {a: {}}\ntree: Stop", "it needs a type or a default"),
        ("play: p\nparams: {a: {type: float, sort: 1}}\ntree: Stop", "the parameter 'a' has no 'sort'"),
        ("play: p\nparams: {a: {type: double}}\ntree: Stop", "'double' is not a type of a parameter"),
        ("play: p\nparams: {a: {type: int, default: x}}\ntree: Stop", "a: input should be a valid integer"),
        ("play: p\nparams: {a: $b}\ntree: Stop", "a default depends on no other parameter"),
        ("play: p\nparams: {a-b: 1}\ntree: Stop", "'a-b' is not a name of a parameter"),
        ("play: p\ntrees: {p: {tree: Stop}}\ntree: Stop", "the tree 'p' is there twice"),
        ("play: p\ntrees: {q: Stop}\ntree: Stop", "the tree 'q' is a mapping"),
        ("play: p\ntree: {SubTree: {tree: p}}", "the tree 'p' contains itself"),
        (
            "play: p\ntree: Stop\ntrees:\n  q: {tree: {SubTree: {tree: r}}}\n"
            "  r: {tree: {SubTree: {tree: q}}}",
            "test.yaml:5: the tree 'q' contains itself",
        ),
        ("play: p\ntree: {SubTree: {tree: nowhere}}", "no tree or play is called 'nowhere'; there are p, "),
        (
            "play: p\ntree: {SubTree: {tree: goalkeeper, params: {pace: 1}}}",
            "goalkeeper has no such parameter",
        ),
        ("play: p\ntree: {SubTree: {tree: goalkeeper, speed: 1}}", "SubTree has no 'speed'"),
        (
            "play: p\ntrees: {q: {params: {n: {type: int}}, tree: Stop}}\ntree: {SubTree: {tree: q}}",
            "n: q needs this parameter",
        ),
        ("play: p\ntree: !!python/name:os.system", "the tag .* is not allowed"),
        ("play: p\ntree: [", "test.yaml:2: "),
        ("play: \x07p", "is not text"),
        ("play: p\ntree: " + "[" * 200, "nested deeper than"),
        ("#" * 200_000, "is larger than 128 KiB"),
    ],
)
def test_what_is_wrong_is_one_line_with_file_and_place(text: str, where: str) -> None:
    said = problem(text)
    assert re.search(where, said), said


@pytest.mark.parametrize(
    "content", [b"\xff\xfe\x00", b"play: \xff", b"\x80\x81", "play: \ud800".encode("utf-8", "surrogatepass")]
)
def test_bytes_that_are_no_text_are_an_error(content: bytes) -> None:
    with pytest.raises(TreeFileError):
        parse_yaml(content, VOCABULARY)


class Unregistered(Leaf[None]):
    def __init__(self, *, what: object = None, name: str = "") -> None:
        super().__init__(name)
        self.what = what

    def on_running(self) -> Status:
        return self.succeed()


@pytest.mark.parametrize(
    ("root", "problem"),
    [
        (
            Sequence("s", memory=True, children=[Unregistered()]),
            "s/Unregistered: files cannot name a Unregistered",
        ),
        (Sequence("", memory=True), "names that are printable"),
        (Stop(name="a\tb"), "names that are printable"),
    ],
)
def test_what_a_file_cannot_say_is_an_error_with_the_nodes_path(root: Behaviour, problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        tree_yaml(root, "test")


def test_a_parameter_that_is_no_plain_data_is_an_error_with_the_nodes_path() -> None:
    vocabulary = Vocabulary({"Unregistered": Unregistered})
    with pytest.raises(ValueError, match=r"Unregistered: what: .* cannot be written as plain data"):
        describe_tree(Unregistered(what=object()), vocabulary, "test")


def test_a_leaf_whose_parameters_have_no_names_cannot_be_named() -> None:
    class Loose(Leaf[None]):
        def __init__(self, *words: str) -> None:
            super().__init__()

    with pytest.raises(TreeFileError, match="Loose takes more than named parameters"):
        parse_yaml("play: p\ntree: Loose\n", Vocabulary({"Loose": Loose}))


def test_every_control_node_can_be_named() -> None:
    bases = {"Gate", "Switch"}
    for name, thing in vars(nodes).items():
        if isinstance(thing, type) and issubclass(thing, Behaviour) and name not in bases:
            assert CONTROL[name].cls is thing


def test_a_play_from_a_file_is_called_like_any_play(tmp_path: Path) -> None:
    path = tmp_path / "wall.yaml"
    path.write_text(
        "play: wall\nparams: {place: 0, size: {type: int}}\ntree: {Wall: {place: $place, size: $size}}\n"
    )
    play = load_play(path)
    assert same(play(size=2), Wall(size=2))
    assert play(size=2) is not play(size=2)
    assert str(inspect.signature(play)) == "(*, place: int = 0, size: int)"
    for parameters, expected in (
        ({}, TypeError),
        ({"size": 1, "pace": 2}, TypeError),
        ({"size": "x"}, TreeFileError),
        ({"size": 1, "place": 3}, TreeFileError),
    ):
        with pytest.raises(expected):
            play(**parameters)


def test_a_file_whose_main_tree_cannot_be_built_is_an_error_at_once(tmp_path: Path) -> None:
    path = tmp_path / "wall.yaml"
    path.write_text("play: wall\nparams: {place: 3}\ntree: {Wall: {place: $place}}\n")
    with pytest.raises(TreeFileError, match=r"wall.yaml:3: Wall: place 3 is not one of a wall of 1"):
        load_play(path)


def test_a_play_is_found_by_its_name_or_its_file(tmp_path: Path) -> None:
    path = tmp_path / "wall.yaml"
    path.write_text("play: wall\ntree: Wall\n")
    assert find_play("goalkeeper") is PLAYS["goalkeeper"]
    assert same(find_play(str(path))(), Wall())
    assert find_play(str(path)) is find_play(str(path))
    path.write_text("play: wall\ntree: {Wall: {size: 2}}\n")
    assert same(find_play(str(path))(), Wall(size=2))
    with pytest.raises(KeyError, match="no play is called 'wall'"):
        find_play("wall")
    for missing in ("no.yaml", "no\x00.xml"):
        with pytest.raises(TreeFileError, match="cannot be read"):
            find_play(str(tmp_path / missing))


DOCUMENT = Path(__file__).parents[3] / "docs" / "tree_files.md"


def test_the_documents_example_is_a_play() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    (example,) = [block for block in re.findall(r"```yaml\n(.*?)```", text, re.DOTALL) if "play:" in block]
    file = parse_yaml(example, VOCABULARY)
    assert parse_yaml(write_yaml(file), VOCABULARY) == file
    root = build_tree(file, VOCABULARY, {"range": 3.0})
    assert [child.name for child in root.children] == ["shoot", "win the ball"]


def test_the_document_names_every_type_that_is_not_a_skill_or_links_to_where_they_are() -> None:
    text = DOCUMENT.read_text(encoding="utf-8") + DOCUMENT.with_name("control_nodes.md").read_text(
        encoding="utf-8"
    )
    sisters = {
        "FailureIsRunning",
        "RunningIsFailure",
        "RunningIsSuccess",
        "SuccessIsFailure",
        "SuccessIsRunning",
    }
    assert [name for name in CONTROL if f"`{name}" not in text and name not in sisters] == []
