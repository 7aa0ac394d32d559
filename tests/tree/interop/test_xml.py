"""The XML of BehaviorTree.CPP 4: read, ticked as its tags say, written, and refused with file and line."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from py_trees.common import OneShotPolicy, ParallelPolicy
from py_trees.decorators import FailureIsRunning

from robobt.plays import PLAYS
from robobt.plays.files import VOCABULARY as PLAY_VOCABULARY
from robobt.plays.files import tree_xml
from robobt.skills import SKILLS, GoToPose, IsRestart, SelectShot, Stop, Wall
from robobt.skills.aim.raters import OpenAngle
from robobt.skills.restarts.referee_switch import RefereeSwitch
from robobt.tree import (
    Behaviour,
    Inverter,
    OneShot,
    Parallel,
    Repeat,
    Retry,
    Selector,
    Sequence,
    Status,
    TreeRunner,
    preorder,
)
from robobt.tree.interop import (
    Entry,
    TreeFile,
    TreeFileError,
    Vocabulary,
    build_tree,
    describe_tree,
    load_tree_file,
    parse_xml,
    parse_yaml,
    write_xml,
)
from robobt.tree.interop.btcpp import TAGS
from robobt.tree.nodes import Cooldown, ParallelCount, SequenceWithMemory, Timeout, Wait
from robobt.world.game import Restart
from robobt.world.limits import RobotLimits
from tests.tree.interop.differences import tree_differences
from tests.tree.tutorial_nodes import VOCABULARY, Aim, House, SaySomething

DATA = Path(__file__).parent / "data"
S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING

# What BehaviorTree.CPP's tutorial of that number shows, in trees of our own.
TUTORIALS = [
    "t01_first_tree",
    "t02_ports",
    "t04_sequence",
    "t04_reactive_sequence",
    "t05_crossdoor",
    "t06_subtree_remapping",
    "t07_several_trees",
    "t10_nested_subtrees",
    "t11_saved_by_groot",
    "t15_mission",
]


def read(text: str, vocabulary: Vocabulary = VOCABULARY) -> TreeFile:
    return parse_xml(text, vocabulary, "test.xml")


def document(body: str, more: str = "") -> str:
    return f'<root BTCPP_format="4"><BehaviorTree ID="Main">{body}</BehaviorTree>{more}</root>'


def tree(body: str, more: str = "", vocabulary: Vocabulary = VOCABULARY) -> Behaviour:
    return build_tree(read(document(body, more), vocabulary), vocabulary)


def tree_of(text: str) -> Behaviour:
    return build_tree(read(text), VOCABULARY)


def load(name: str) -> TreeFile:
    return load_tree_file(DATA / f"{name}.xml", VOCABULARY)


def run(root: Behaviour, house: House, ticks: int = 20, period: float = 0.1) -> list[str]:
    """Tick until the tree has finished."""
    runner = TreeRunner(root, house)
    statuses = []
    for _ in range(ticks):
        statuses.append(runner.tick().value[0])
        assert runner.error is None
        house.time += period
        if statuses[-1] != "R":
            break
    return statuses


def all_leaves() -> dict[str, Any]:
    both = (SKILLS, VOCABULARY.leaves)
    return {name: leaves[name] for leaves in both for name in leaves}  # type: ignore[index]


@pytest.mark.parametrize("name", TUTORIALS)
def test_a_tutorials_tree_is_equal_once_written_out_and_read_back(name: str) -> None:
    file = load(name)
    text = write_xml(file, VOCABULARY)
    again = read(text)
    assert again == file
    assert write_xml(again, VOCABULARY) == text
    assert tree_differences(build_tree(file, VOCABULARY), build_tree(again, VOCABULARY), VOCABULARY) == []


def test_the_files_are_all_looked_at() -> None:
    assert sorted(path.stem for path in DATA.glob("*.xml")) == sorted(TUTORIALS)


@pytest.mark.parametrize(("locked", "end"), [(0, "door opened"), (3, "picking"), (9, "smashed")])
def test_t05_a_closed_door_is_opened_picked_or_smashed(locked: int, end: str) -> None:
    house = House(locked=locked)
    assert run(build_tree(load("t05_crossdoor"), VOCABULARY), house)[-1] == "S"
    assert house.said[-2:] == [end, "through"]
    assert house.said.count("picking") == min(locked, 5)


def test_t06_a_sub_trees_ports_are_the_entries_it_is_given() -> None:
    root = build_tree(load("t06_subtree_remapping"), VOCABULARY)
    (move,) = [node for node in preorder(root) if node.name == "MoveBase"]
    assert move.goal == Entry("move_goal")  # type: ignore[attr-defined]
    house = House()
    assert run(root, house) == ["R", "S"]
    assert house.move_result == "arrived"
    assert house.said[-1] == "arrived"


def test_t07_the_main_tree_is_the_one_that_is_named() -> None:
    file = load("t07_several_trees")
    assert file.main == "Whole"
    house = House()
    run(build_tree(file, VOCABULARY), house)
    assert house.said == ["the whole", "part A", "part B"]
    run(build_tree(replace(file, main="PartB"), VOCABULARY), house)
    assert house.said[-1] == "part B"


def test_t11_what_groot_writes_besides_is_read_over_and_a_sub_trees_model_gives_defaults() -> None:
    house = House()
    run(build_tree(load("t11_saved_by_groot"), VOCABULARY), house)
    assert house.said == ["forty-two", "twice", "twice", "once more", "once more"]


@pytest.mark.parametrize(
    ("tag", "attributes", "node"),
    [
        ("Sequence", "", lambda c: Sequence("Sequence", memory=True, children=[c])),
        ("ReactiveSequence", "", lambda c: Sequence("ReactiveSequence", memory=False, children=[c])),
        ("SequenceWithMemory", "", lambda c: SequenceWithMemory("SequenceWithMemory", [c])),
        ("Fallback", "", lambda c: Selector("Fallback", memory=True, children=[c])),
        ("ReactiveFallback", "", lambda c: Selector("ReactiveFallback", memory=False, children=[c])),
        ("Inverter", "", lambda c: Inverter("Inverter", c)),
        ("Repeat", 'num_cycles="3"', lambda c: Repeat("Repeat", c, 3)),
        ("Repeat", 'num_cycles="-1"', lambda c: Repeat("Repeat", c, -1)),
        ("RetryUntilSuccessful", 'num_attempts="2"', lambda c: Retry("RetryUntilSuccessful", c, 2)),
        ("RetryUntilSuccessful", 'num_attempts="-1"', lambda c: FailureIsRunning("RetryUntilSuccessful", c)),
        ("Timeout", 'msec="1500"', lambda c: Timeout("Timeout", c, seconds=1.5)),
        (
            "Parallel",
            "",
            lambda c: ParallelCount("Parallel", success_count=-1, failure_count=1, children=[c]),
        ),
        (
            "Parallel",
            'success_count="1" failure_count="-1"',
            lambda c: ParallelCount("Parallel", success_count=1, failure_count=-1, children=[c]),
        ),
        (
            "Cooldown",
            'seconds="2" after="failure"',
            lambda c: Cooldown("Cooldown", c, seconds=2.0, after="failure"),
        ),
    ],
)
def test_a_tag_is_the_node_that_does_the_same(tag: str, attributes: str, node: Any) -> None:
    expected = node(SaySomething(message="x"))
    kind = "Decorator" if len(preorder(expected)) == 2 and hasattr(expected, "decorated") else "Control"
    for start, end in ((f"<{tag} {attributes}>", tag), (f'<{kind} ID="{tag}" {attributes}>', kind)):
        root = tree(f'{start}<SaySomething message="x"/></{end}>')
        assert tree_differences(root, expected, VOCABULARY) == []


@pytest.mark.parametrize("tag", ["Repeat", "RetryUntilSuccessful"])
def test_without_end_is_minus_one_in_the_file_again(tag: str) -> None:
    attribute = {"Repeat": "num_cycles", "RetryUntilSuccessful": "num_attempts"}[tag]
    for name in ("", ' name="on and on"'):
        file = read(document(f'<{tag}{name} {attribute}="-1"><PassThroughDoor/></{tag}>'))
        text = write_xml(file, VOCABULARY)
        assert f'{attribute}="-1"' in text
        assert read(text) == file
        root = build_tree(file, VOCABULARY)
        again = describe_tree(root, VOCABULARY, "Main")
        assert tree_differences(build_tree(again, VOCABULARY), root, VOCABULARY) == []
        assert tree_differences(tree_of(write_xml(again, VOCABULARY)), root, VOCABULARY) == []


def test_without_end_cannot_be_a_sub_trees_port() -> None:
    body = '<SubTree ID="Again" times="-1"/>'
    again = (
        '<BehaviorTree ID="Again"><RetryUntilSuccessful num_attempts="{times}"><AlwaysFailure/>'
        "</RetryUntilSuccessful></BehaviorTree>"
    )
    with pytest.raises(TreeFileError, match="num_failures: should be 1 or more; FailureIsRunning tries with"):
        tree(body, again)


def test_a_stock_retry_that_never_retries_is_not_written_as_one_that_always_does() -> None:
    with pytest.raises(ValueError, match="num_failures"):
        describe_tree(Retry("again", SaySomething(message="x"), -1), VOCABULARY, "Main")


def test_every_tag_of_the_table_can_be_read_and_written() -> None:
    needed = {"num_cycles": "2", "num_attempts": "2", "msec": "100", "delay_msec": "100"}
    for tag, entry in TAGS.items():
        kind = VOCABULARY.type(entry.type)
        assert kind is not None
        attributes = " ".join(f'{name}="{needed.get(name, "1")}"' for name in entry.attributes)
        body = f"<{tag} {attributes}/>" if kind.leaf else f"<{tag} {attributes}><AlwaysSuccess/></{tag}>"
        file = read(document(body))
        assert f"<{tag}" in write_xml(file, VOCABULARY)
        assert read(write_xml(file, VOCABULARY)) == file


def test_forcing_and_keeping_running_change_only_the_status_they_name() -> None:
    yes, no = '<SaySomething message="x"/>', "<PassThroughDoor/>"
    for tag, of_success, of_failure in (
        ("ForceSuccess", "S", "S"),
        ("ForceFailure", "F", "F"),
        ("KeepRunningUntilFailure", "R", "F"),
        ("Inverter", "F", "S"),
    ):
        assert run(tree(f"<{tag}>{yes}</{tag}>"), House(), ticks=1) == [of_success]
        assert run(tree(f"<{tag}>{no}</{tag}>"), House(), ticks=1) == [of_failure]


def test_milliseconds_pass_on_the_simulated_clock() -> None:
    assert run(tree('<Sleep msec="250"/>'), House()) == ["R", "R", "R", "S"]
    late = tree('<Delay delay_msec="150"><SaySomething message="x"/></Delay>')
    assert run(late, House()) == ["R", "R", "S"]
    timed = tree('<Timeout msec="150"><Sleep msec="900"/></Timeout>')
    assert run(timed, House()) == ["R", "R", "F"]


@pytest.mark.parametrize(
    ("text", "value"),
    [("1.5", 1.5), ("2", 2.0), ("-1e-3", -1e-3), ("json:4", 4.0)],
)
def test_a_number_is_read_as_its_parameter_has_it(text: str, value: float) -> None:
    root = tree(f'<Aim speed="{text}"/>')
    assert isinstance(root, Aim)
    assert root.speed == value
    assert type(root.speed) is float


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ('target="1;2.5"', GoToPose(target=(1.0, 2.5))),
        ('face_ball="true" avoid_robots="0"', GoToPose(face_ball=True, avoid_robots=False)),
        ('face_ball="TRUE"', GoToPose(face_ball=True)),
        ('heading="json:null"', GoToPose()),
        ('target="{target}"', GoToPose()),
        ("limits='json:{\"max_speed\": 2}'", GoToPose(limits=RobotLimits(max_speed=2.0))),
    ],
)
def test_values_of_all_kinds_are_read(attributes: str, expected: Behaviour) -> None:
    root = tree(f"<GoToPose {attributes}/>", vocabulary=PLAY_VOCABULARY)
    assert tree_differences(root, expected, PLAY_VOCABULARY) == []


@pytest.mark.parametrize(
    ("attribute", "problem"),
    [
        (
            'rater="gausian"',
            "rater of <SelectShot>: no shot rater is called 'gausian'; .*did you mean gaussian",
        ),
        ("""rater='json:{"name": "gaussian", "spaceing": 1}'""", "rater.spaceing of .*did you mean spacing"),
    ],
)
def test_what_is_wrong_with_a_rater_is_named(attribute: str, problem: str) -> None:
    with pytest.raises(TreeFileError, match=problem):
        tree(f"<SelectShot {attribute}/>", vocabulary=PLAY_VOCABULARY)


@pytest.mark.integration
@pytest.mark.parametrize(
    "root",
    [
        GoToPose(target=(0.1, -2.0), heading=1e-7, name='a "name" <with> & all'),
        GoToPose(limits=RobotLimits(max_speed=2.0, side_braking=1.0)),
        IsRestart(kind=Restart.PENALTY, ours=False),
        SelectShot(rater=OpenAngle(), max_distance=3.0),
        SelectShot(rater="open_angle"),
        Wait(seconds=0.25),
        SaySomething(message="{no entry}"),
        SaySomething(message="json:nothing"),
        SaySomething(message="1.5"),
        SaySomething(message="true"),
        SaySomething(message=" two\n lines;and\ta tab "),
        SaySomething(message=Entry("the_answer")),
        Inverter("Inverter", Stop(name="Inverter")),
        Parallel("p", ParallelPolicy.SuccessOnAll(synchronise=True), [Stop(), Wall()]),
        Parallel("q", ParallelPolicy.SuccessOnOne(), [Stop(), Wall()]),
        OneShot("once", Stop(), OneShotPolicy.ON_COMPLETION),
    ],
    ids=lambda root: f"{type(root).__name__}-{root.name}",
)
def test_values_of_all_kinds_are_written(root: Behaviour) -> None:
    vocabulary = Vocabulary(all_leaves())
    text = write_xml(describe_tree(root, vocabulary, "Main"), vocabulary)
    again = build_tree(read(text, vocabulary), vocabulary)
    assert tree_differences(root, again, vocabulary) == []


@pytest.mark.parametrize("play", [name for name in PLAYS if PLAYS[name].__module__.startswith("robobt.")])
def test_every_play_that_ships_goes_through_xml_unchanged(play: str) -> None:
    root = PLAYS[play]()
    again = build_tree(read(tree_xml(root, play), PLAY_VOCABULARY), PLAY_VOCABULARY)
    assert tree_differences(root, again, PLAY_VOCABULARY) == []


def test_a_switch_names_the_cases_of_its_children() -> None:
    halted = Stop()
    root = RefereeSwitch(
        "phases", {"halt": halted, "stop": halted, "play": Wall()}, otherwise=Stop(name="wait")
    )
    text = tree_xml(root, "Main")
    assert '<RefereeSwitch name="phases" cases="halt | stop;play">' in text
    again = build_tree(read(text, PLAY_VOCABULARY), PLAY_VOCABULARY)
    assert tree_differences(root, again, PLAY_VOCABULARY) == []


@pytest.mark.parametrize(
    "root",
    [RefereeSwitch("r", {}), RefereeSwitch("r", {}, otherwise=Stop()), RefereeSwitch("r", {"halt": Stop()})],
)
def test_a_switch_may_have_few_cases(root: Behaviour) -> None:
    again = build_tree(read(tree_xml(root, "Main"), PLAY_VOCABULARY), PLAY_VOCABULARY)
    assert tree_differences(root, again, PLAY_VOCABULARY) == []


@pytest.mark.parametrize(
    "switch",
    [
        '<RefereeSwitch name="r"/>',
        '<RefereeSwitch name="r" cases="halt"/>',
        '<RefereeSwitch name="r" cases="halt;halt"><Stop/><Stop/></RefereeSwitch>',
        '<RefereeSwitch name="r" cases="halt"><Stop/><Stop/><Stop/></RefereeSwitch>',
    ],
)
def test_a_switch_whose_cases_do_not_fit_its_children_is_an_error(switch: str) -> None:
    with pytest.raises(TreeFileError, match="names the cases of its children"):
        read(document(switch), PLAY_VOCABULARY)


def test_the_palette_lists_every_skill_with_parameters_and_entries() -> None:
    text = tree_xml(Stop(), "Main")
    root = ElementTree.fromstring(text)
    actions = {model.get("ID"): model for model in root.iter("Action")}
    conditions = {model.get("ID"): model for model in root.iter("Condition")}
    assert not set(actions) & set(conditions)
    assert {"HasBall", "IsHalted", "ShotIsSteady"} <= set(conditions)
    models = {**actions, **conditions}
    assert set(models) >= set(SKILLS)
    assert models["BallInOwnHalf"][0].text == "where the own side ends [m]; 0 is the half-way line."
    ports = {port.get("name"): (port.tag, port.get("default")) for port in models["KickToTarget"]}
    assert ports["touch_downs"] == ("input_port", "1")
    assert ports["shot"] == ("input_port", "{shot}")
    assert ports["team"] == ("output_port", "{team}")
    assert {port.get("name"): port.tag for port in models["SelectShot"]}["shot"] == "inout_port"
    assert {port.get("name"): port.get("default") for port in models["GoToPose"]}["target"] == "{target}"
    assert "RefereeSwitch" in {model.get("ID") for model in root.iter("Control")}


def test_the_palettes_own_defaults_are_what_leaving_them_out_means() -> None:
    model = ElementTree.fromstring(tree_xml(Stop(), "Main")).find("TreeNodesModel")
    assert model is not None
    for action in model.iter("Action"):
        name = action.get("ID", "")
        kind = PLAY_VOCABULARY.type(name)
        assert kind is not None
        required = {entry for entry, parameter in kind.parameters.items() if parameter.required}
        if required:
            continue
        given = "".join(
            f' {port.get("name")}="{(port.get("default") or "").replace(chr(34), "&quot;")}"'
            for port in action
            if port.get("default") is not None
        )
        spelled = tree(f"<{name}{given}/>", vocabulary=PLAY_VOCABULARY)
        plain = tree(f"<{name}/>", vocabulary=PLAY_VOCABULARY)
        assert tree_differences(spelled, plain, PLAY_VOCABULARY) == []


def test_a_yaml_file_with_parameters_and_sub_trees_keeps_them_in_xml() -> None:
    text = """
        play: main
        params: {message: hello, times: {type: int, default: 2}, tone: soft}
        trees:
          part:
            params: {word: {type: str}, times: 1}
            tree: {Repeat: {name: again, num_success: $times, child: {SaySomething: {message: $word}}}}
        tree:
          Sequence:
            name: both
            memory: true
            children:
              - SubTree: {tree: part, params: {word: $message, times: $times}}
              - SubTree: {tree: part, params: {word: bye}}
    """
    file = parse_yaml(text, VOCABULARY)
    again = read(write_xml(file, VOCABULARY))
    assert again.trees["main"].parameters == file.trees["main"].parameters
    given = {"message": "once", "times": 3}
    for values in ({}, given):
        one, other = build_tree(file, VOCABULARY, values), build_tree(again, VOCABULARY, values)
        assert tree_differences(one, other, VOCABULARY) == []


def test_an_entry_is_written_as_one_wherever_it_stands() -> None:
    text = """
        play: main
        trees: {part: {tree: {SaySomething: {message: {entry: move_result}}}}}
        tree:
          Sequence:
            name: both
            memory: true
            children: [{SaySomething: {message: {entry: the_answer}}}, {SubTree: {tree: part}}]
    """
    file = parse_yaml(text, VOCABULARY)
    written = write_xml(file, VOCABULARY)
    assert '"{the_answer}"' in written
    assert '"{@move_result}"' in written
    one, other = build_tree(file, VOCABULARY), build_tree(read(written), VOCABULARY)
    assert tree_differences(one, other, VOCABULARY) == []


def test_an_entry_that_a_leaf_uses_anyway_may_be_said() -> None:
    root = tree('<Aim target="{target}" battery="{battery}"/>')
    assert tree_differences(root, Aim(), VOCABULARY) == []


def test_a_sub_trees_literal_port_is_a_value_of_the_type_it_is_used_as() -> None:
    sub = '<BehaviorTree ID="Sub"><Aim target="{place}" speed="{pace}"/></BehaviorTree>'
    root = tree('<SubTree ID="Sub" place="1;2" pace="3"/>', sub)
    assert tree_differences(root, Aim(target=(1.0, 2.0), speed=3.0), VOCABULARY) == []


def test_an_equals_sign_gives_a_sub_tree_the_entry_of_the_ports_own_name() -> None:
    sub = '<BehaviorTree ID="Sub"><SaySomething message="{the_answer}"/></BehaviorTree>'
    root = tree('<SubTree ID="Sub" the_answer="{=}"/>', sub)
    assert tree_differences(root, SaySomething(message=Entry("the_answer")), VOCABULARY) == []


def test_an_at_sign_means_the_outermost_trees_entry() -> None:
    inner = '<BehaviorTree ID="Inner"><SaySomething message="{@the_answer}"/></BehaviorTree>'
    sub = f'<BehaviorTree ID="Sub"><SubTree ID="Inner"/></BehaviorTree>{inner}'
    root = tree('<SubTree ID="Sub"/>', sub)
    assert tree_differences(root, SaySomething(message=Entry("the_answer")), VOCABULARY) == []


def test_a_play_may_be_a_sub_tree() -> None:
    root = tree('<SubTree ID="patrol" length="3"/>')
    assert tree_differences(root, SaySomething(message="hello 3.0"), VOCABULARY) == []


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "iso-8859-1"])
def test_the_declared_encoding_is_kept_to(encoding: str) -> None:
    text = f'<?xml version="1.0" encoding="{encoding}"?>' + document('<SaySomething message="Tor für uns"/>')
    root = build_tree(parse_xml(text.encode(encoding), VOCABULARY), VOCABULARY)
    assert tree_differences(root, SaySomething(message="Tor für uns"), VOCABULARY) == []


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b'<?xml version="1.0" encoding="klingon"?><root/>', "unknown encoding"),
        (b'<?xml version="1.0" encoding="utf-16"?><root/>', "is not XML"),
        (b'<root name="\xff"/>', "is not XML"),
        (b"\x00\x00", "is not XML"),
        (b"\xff\xfe<", "is not XML"),
    ],
)
def test_bytes_that_are_no_text_are_an_error(content: bytes, problem: str) -> None:
    with pytest.raises(TreeFileError, match=problem):
        parse_xml(content, VOCABULARY)


def test_a_tree_alone_needs_no_id() -> None:
    file = read('<root BTCPP_format="4"><BehaviorTree><AlwaysSuccess/></BehaviorTree></root>')
    assert file.main == "BehaviorTree"


SAY = '<SaySomething message="x"/>'
SUB = '<BehaviorTree ID="Sub"><SaySomething message="{word}"/></BehaviorTree>'


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "is not XML"),
        ("<root></toor>", "mismatched tag"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><root BTCPP_format="4"/>', "document type"),
        (document('<SaySomething message="&a;"/>'), "undefined entity"),
        ("<?php x?>" + document(SAY), r"<\?php\?> is not allowed"),
        ('<tree BTCPP_format="4"/>', "the outermost tag is <root>"),
        (
            "<root/>",
            r"this file is for BehaviorTree.CPP 3 \(<root> has no BTCPP_format\); "
            'robobt reads version 4: convert it, then set BTCPP_format="4"',
        ),
        ('<root BTCPP_format="4" project="p"/>', "no attribute project"),
        ('<root BTCPP_format="4"/>', "there is no <BehaviorTree>"),
        ('<root BTCPP_format="4">words</root>', "there is text in <root>"),
        ('<root BTCPP_format="4"><include path="other.xml"/></root>', "<include> is not supported"),
        ('<root BTCPP_format="4"><Sequence/></root>', "no <Sequence>"),
        (document(SAY, "<BehaviorTree><AlwaysSuccess/></BehaviorTree>"), "needs the attribute ID"),
        (document(SAY, '<BehaviorTree ID="Main"><AlwaysSuccess/></BehaviorTree>'), "'Main' is there twice"),
        (document(""), "<BehaviorTree> has one child, not 0"),
        (
            document(SAY, '<BehaviorTree ID="Other"><AlwaysSuccess/></BehaviorTree>'),
            "Main and Other could both be the main tree; name one in main_tree_to_execute",
        ),
        (
            document('<SubTree ID="B"/>', '<BehaviorTree ID="B"><SubTree ID="Main"/></BehaviorTree>'),
            "every tree is a sub-tree of another; name one in main_tree_to_execute",
        ),
        (
            document(SAY).replace('"4"', '"4" main_tree_to_execute="Other"'),
            "no tree 'Other'; there are Main",
        ),
        (document("<Qqqq/>"), "no node is called 'Qqqq'; there are .*SaySomething"),
        (document("<saysomething/>"), "is it SaySomething"),
        (document(f"<Switch3>{SAY}</Switch3>"), "<Switch3>: robobt has no blackboard; write a switch"),
        (document("<Action/>"), "<Action> needs the attribute ID"),
        (
            document('<Control ID="SaySomething" message="x"/>'),
            "SaySomething is not a <Control> but a <Action>",
        ),
        (document('<Action ID="Inverter"/>'), "Inverter is not a <Action> but a <Decorator>"),
        (document('<Script code="x:=1"/>'), "robobt has no scripts"),
        (document('<SaySomething message="x" _skipIf="y"/>'), "_skipIf: robobt has no scripts"),
        (document('<SaySomething message="x" _odd="y"/>'), "no attribute _odd"),
        (document("<SaySomething/>"), "message: SaySomething needs this parameter"),
        (document('<SaySomething message="x" loud="true"/>'), "no attribute loud; it has message"),
        (document('<SaySomething message="x" name=""/>'), "name of <SaySomething> is a text"),
        (document(f'<SaySomething message="x">{SAY}</SaySomething>'), "<SaySomething> has no children"),
        (document('<SaySomething message="x">hello</SaySomething>'), "there is text"),
        (document('<Aim speed="fast"/>'), "speed of <Aim>: 'fast' is not of type float"),
        (document('<Aim speed="{target}"/>'), "takes a value, and cannot be wired to the entry 'target'"),
        (document('<Aim battery="{target}"/>'), "uses the entry 'battery' and cannot be wired to 'target'"),
        (document('<Aim battery="full"/>'), "battery of <Aim> is an entry that it uses"),
        (document('<SaySomething message="{nowhere}"/>'), "House has no such entry"),
        (document('<SaySomething message="{two words}"/>'), "not the name of an entry"),
        (document("<Sequence/>"), "<Sequence> needs a child"),
        (document(f'<Sequence memory="true">{SAY}</Sequence>'), "<Sequence> has no attribute memory"),
        (document(f"<Selector>{SAY}</Selector>"), "<Selector> is written Fallback or ReactiveFallback"),
        (document(f"<Inverter>{SAY}{SAY}</Inverter>"), "<Inverter> has one child, not 2"),
        (document(f"<Repeat>{SAY}</Repeat>"), "<Repeat> needs the attribute num_cycles"),
        (document(f'<Repeat num_cycles="0">{SAY}</Repeat>'), "0 is neither 1 or more nor -1"),
        (document('<Sleep msec="-1"/>'), "-1 is negative"),
        (document('<Sleep msec="{time}"/>'), "msec of <Sleep> is a number"),
        (document(f'<Parallel threshold="1">{SAY}</Parallel>'), "no attribute threshold"),
        (document(f'<Parallel success_count="2">{SAY}</Parallel>'), "a count of 2 does not fit 1 children"),
        (document("<SubTree/>"), "<SubTree> needs the attribute ID"),
        (document('<SubTree ID="Nowhere"/>'), "no tree or play is called 'Nowhere'; there are Main, patrol"),
        (document('<SubTree ID="Main"/>'), "'Main' contains itself"),
        (document(f'<SubTree ID="Sub">{SAY}</SubTree>', SUB), "<SubTree> has no children"),
        (document('<SubTree ID="Sub" wrod="x"/>', SUB), "Sub has no such port; it has word"),
        (document('<SubTree ID="Sub" _autoremap="maybe"/>', SUB), "_autoremap is true or false"),
        (document('<SubTree ID="Sub"/>', SUB), "the tree 'Sub' is not given 'word'"),
        (document('<SubTree ID="patrol" length="far"/>'), "patrol: length: 'far' is not of type float"),
        (document('<SubTree ID="patrol" speed="1"/>'), "patrol has no such parameter"),
        (document(SAY, "<TreeNodesModel/><TreeNodesModel/>"), "two <TreeNodesModel>"),
        (document(SAY, "<TreeNodesModel><Port/></TreeNodesModel>"), "<TreeNodesModel> has no <Port>"),
        (
            document(SAY, '<TreeNodesModel><Action ID="A"><port/></Action></TreeNodesModel>'),
            "a model has ports, no <port>",
        ),
        (
            document(
                '<SubTree ID="Sub"/>',
                SUB
                + '<TreeNodesModel><SubTree ID="Sub"><input_port name="word"/></SubTree></TreeNodesModel>',
            ),
            "Sub needs this port",
        ),
    ],
)
def test_what_is_wrong_is_one_line_with_file_and_place(text: str, problem: str) -> None:
    with pytest.raises(TreeFileError, match=problem) as caught:
        build_tree(read(text), VOCABULARY)
    said = str(caught.value)
    assert said.startswith("test.xml:")
    assert "\n" not in said


def test_the_line_is_that_of_the_element() -> None:
    text = document(
        "\n<Sequence>\n  <CheckBattery/>\n\n  <SaySomething\n message='x' loud='y'/>\n</Sequence>"
    )
    with pytest.raises(TreeFileError) as caught:
        read(text)
    assert caught.value.line == 5
    assert caught.value.file == "test.xml"


@pytest.mark.integration
def test_a_small_file_does_not_become_a_large_tree() -> None:
    twice = '<Sequence><SubTree ID="T{0}"/><SubTree ID="T{0}"/></Sequence>'
    trees = "".join(f'<BehaviorTree ID="T{n}">{twice.format(n + 1)}</BehaviorTree>' for n in range(40))
    last = f'<BehaviorTree ID="T40">{SAY}</BehaviorTree>'
    text = f'<root BTCPP_format="4">{trees}{last}</root>'
    file = read(text)
    with pytest.raises(TreeFileError, match="more than 10000 nodes"):
        build_tree(file, VOCABULARY)


@pytest.mark.parametrize("depth", [90, 101, 5000])
def test_deep_nesting_is_a_tree_or_an_error(depth: int) -> None:
    text = document("<Inverter>" * (depth - 3) + "<AlwaysSuccess/>" + "</Inverter>" * (depth - 3))
    if depth <= 100:
        assert len(preorder(build_tree(read(text), VOCABULARY))) == depth - 2
    else:
        with pytest.raises(TreeFileError, match="nested deeper than 100 levels"):
            read(text)


def test_a_long_chain_of_sub_trees_is_a_tree_or_an_error() -> None:
    trees = "".join(f'<BehaviorTree ID="T{n}"><SubTree ID="T{n + 1}"/></BehaviorTree>' for n in range(5000))
    with pytest.raises(TreeFileError, match="nested too deeply"):
        read(f'<root BTCPP_format="4">{trees}<BehaviorTree ID="T5000">{SAY}</BehaviorTree></root>')


def test_a_file_that_is_too_large_or_not_there_or_of_another_kind_is_an_error(tmp_path: Path) -> None:
    large = tmp_path / "large.xml"
    large.write_text(document(SAY) + " " * (1024 * 1024))
    other = tmp_path / "tree.json"
    for path, problem in (
        (large, "is larger than"),
        (tmp_path / "no.xml", "No such file"),
        (other, "ending"),
    ):
        with pytest.raises(TreeFileError, match=problem):
            load_tree_file(path, VOCABULARY)


class Unregistered(Wait):
    pass


@pytest.mark.parametrize(
    ("root", "problem"),
    [
        (
            Sequence("s", memory=True, children=[Unregistered(seconds=1.0)]),
            "s/Unregistered: files cannot name",
        ),
        (Wait(seconds=0.0005), "not a whole number of milliseconds"),
        (Wait(seconds=1e308), "not a whole number of milliseconds"),
        (SaySomething(message="a\x00b"), "XML cannot hold the characters"),
        (Stop(name="two\nlines"), "names that are printable"),
        (
            Parallel("p", ParallelPolicy.SuccessOnSelected([])),
            "p: files cannot name the policy SuccessOnSelected",
        ),
    ],
)
def test_what_xml_cannot_say_is_an_error(root: Behaviour, problem: str) -> None:
    vocabulary = Vocabulary(all_leaves())
    with pytest.raises(ValueError, match=problem):
        write_xml(describe_tree(root, vocabulary, "Main"), vocabulary)


def test_names_within_values_have_to_be_built_before_they_are_xml() -> None:
    text = "play: p\nparams: {n: 1.0}\ntree: {GoToPose: {limits: {max_speed: $n}}}\n"
    file = parse_yaml(text, PLAY_VOCABULARY)
    with pytest.raises(ValueError, match="build the tree first"):
        write_xml(file, PLAY_VOCABULARY)
    root = build_tree(file, PLAY_VOCABULARY)
    text = write_xml(describe_tree(root, PLAY_VOCABULARY, "p"), PLAY_VOCABULARY)
    again = build_tree(read(text, PLAY_VOCABULARY), PLAY_VOCABULARY)
    assert tree_differences(again, root, PLAY_VOCABULARY) == []


def test_the_documents_table_is_the_table_that_is_used() -> None:
    text = (DATA.parents[3] / "docs" / "tree_files.md").read_text(encoding="utf-8")
    rows = [row.split("|")[1:4] for row in text.splitlines() if row.startswith("| `")]
    told = {}
    for tags, kinds, attributes in rows:
        for tag, kind in zip(tags.split(","), kinds.split(","), strict=False):
            told[tag.strip(" `")] = (kind.strip(" `"), attributes)
    for tag, entry in TAGS.items():
        kind, attributes = told[tag]
        fixed = ", ".join(f"{name}={value}" for name, value in entry.fixed.items())
        assert kind == (f"{entry.type}({fixed})" if fixed else entry.type)
        assert all(f"`{name}`" in attributes for name in entry.attributes)
