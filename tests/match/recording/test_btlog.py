"""The log is decoded here from the format's description, not by the code that wrote it."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from robobt.match import MatchLoop
from robobt.match.recording import Recorder, Recording, load_recording
from robobt.match.recording.btlog import btlog, write_btlog
from robobt.match.scenario.scenario import load_scenario
from robobt.tree import Behaviour, Selector, Sequence, TreeRunner
from robobt.world import RobotId, Team
from robobt.worlds import sim_world
from tests.match.recording.made_recording import BLUE_1, BLUE_4, PERIOD, YELLOW_0, Wait, frame, header, record

IDLE, RUNNING, SUCCESS, FAILURE = range(4)
LETTERS = {IDLE: "-", RUNNING: "R", SUCCESS: "S", FAILURE: "F"}


def decode(data: bytes) -> tuple[ElementTree.Element, int, list[tuple[int, int, int]]]:
    """The tree, the start [us] and the changes: time since the start [us], node, status."""
    assert data[:18] == b"BTCPP4-FileLogger2"
    assert data[18] == 1
    size = int.from_bytes(data[19:23], "little", signed=True)
    root = ElementTree.fromstring(data[23 : 23 + size].decode())
    at = 23 + size
    start = int.from_bytes(data[at : at + 8], "little", signed=True)
    records = data[at + 8 :]
    assert len(records) % 9 == 0
    changes = []
    for place in range(0, len(records), 9):
        each = records[place : place + 9]
        changes.append((int.from_bytes(each[:6], "little"), int.from_bytes(each[6:8], "little"), each[8]))
    return root, start, changes


@pytest.fixture
def recording(tmp_path: Path) -> Recording:
    record(tmp_path / "match.robobt.arrows")
    return load_recording(tmp_path / "match.robobt.arrows")


@pytest.mark.parametrize("robot", [BLUE_1, YELLOW_0])
def test_the_log_holds_every_status_at_its_time(recording: Recording, robot: RobotId) -> None:
    _, start, changes = decode(btlog(recording, robot))
    assert start == 0
    letters = ["-"] * 5
    told = list(changes)
    for tick in range(120):
        while told and told[0][0] <= round(tick * PERIOD * 1e6) + 1:
            _, uid, status = told.pop(0)
            assert letters[uid - 1] != LETTERS[status], "only changes are written"
            letters[uid - 1] = LETTERS[status]
        assert "".join(letters) == recording.statuses_at(robot, tick)
    assert not told


def test_the_tree_is_there_with_numbers_and_paths(recording: Recording) -> None:
    root, _, _ = decode(btlog(recording, BLUE_1))
    assert (root.tag, root.attrib["BTCPP_format"], root.attrib["main_tree_to_execute"]) == (
        "root",
        "4",
        "play",
    )
    tree = root.find("BehaviorTree")
    assert tree is not None
    assert tree.attrib["ID"] == "play"
    below = [node for node in tree.iter() if node is not tree]
    nodes = [(node.tag, node.attrib["_uid"], node.attrib["_fullpath"]) for node in below]
    assert nodes == [
        ("ReactiveFallback", "1", "play"),
        ("ReactiveSequence", "2", "play/now and then"),
        ("Every", "3", "play/now and then/Every"),
        ("Wait", "4", "play/now and then/Wait"),
        ("Wait", "5", "play/idle"),
    ]
    models = root.find("TreeNodesModel")
    assert models is not None
    assert ("Action", "Every") in [(model.tag, model.attrib["ID"]) for model in models]


def test_siblings_of_one_name_and_names_xml_cannot_hold_are_told_apart(tmp_path: Path) -> None:
    def tree() -> Behaviour:
        return Selector('<"&\x00é', False, [Wait("a"), Sequence("a", True, [Wait("a/b")]), Wait("a")])

    runner: TreeRunner = TreeRunner(tree(), None)
    with Recorder(tmp_path / "m.robobt.arrows", header(), {BLUE_1: runner}) as recorder:
        runner.tick()
        recorder.tick(frame(0))
    loaded = load_recording(tmp_path / "m.robobt.arrows")
    root, _, _ = decode(btlog(loaded, BLUE_1))
    paths = [node.attrib["_fullpath"] for node in root.iter() if "_uid" in node.attrib]
    assert paths == ['<"&\ufffdé', '<"&\ufffdé/a', '<"&\ufffdé/a#2', '<"&\ufffdé/a#2/a/b', '<"&\ufffdé/a#3']
    assert root.find(".//Sequence") is not None


def test_a_whole_matchs_tree_is_written_from_the_file_alone(tmp_path: Path) -> None:
    path = tmp_path / "match.robobt.arrows"
    MatchLoop(load_scenario("striker_vs_goalkeeper").lasting(1.0), 1, sim_world, path).play()
    loaded = load_recording(path)
    written = write_btlog(loaded, RobotId(Team.BLUE, 0), tmp_path / "x.btlog")
    root, _, changes = decode(written.read_bytes())
    uids = [int(node.attrib["_uid"]) for node in root.iter() if "_uid" in node.attrib]
    assert uids == list(range(1, len(loaded.header.robots[loaded.slot(RobotId(Team.BLUE, 0))].tree) + 1))
    assert {uid for _, uid, _ in changes} <= set(uids)
    assert len(changes) > 5
    assert not list(tmp_path.glob(".*"))


def test_a_robot_without_a_tree_has_no_log(recording: Recording) -> None:
    with pytest.raises(ValueError, match="no tree was recorded for blue 4"):
        btlog(recording, BLUE_4)
    with pytest.raises(KeyError, match="yellow 9"):
        btlog(recording, RobotId(Team.YELLOW, 9))
