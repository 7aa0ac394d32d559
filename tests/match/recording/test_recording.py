import json
import random
import re
import signal
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import inf, nan
from pathlib import Path
from typing import ClassVar

import numpy as np
import pyarrow as pa
import pyarrow.ipc
import pytest
from py_trees.visitors import VisitorBase
from pydantic import ValidationError

from robobt.live.replay_html import replay_html
from robobt.match import MatchLoop
from robobt.match.recording import (
    Event,
    RecordedNode,
    RecordedRobot,
    Recorder,
    RecordingError,
    RecordingHeader,
    RobotFlag,
    load_recording,
    reader,
)
from robobt.match.recording.stream import new_stream
from robobt.match.scenario.scenario import load_scenario, scenario_from
from robobt.sim import preset
from robobt.skills.store import Store
from robobt.tree import Behaviour, Inverter, Leaf, Selector, Sequence, Status, TreeRunner
from robobt.world import BallState, Frame, RefereeCommand, RobotCommand, RobotId, RobotState, Team
from robobt.world.command import CHIP_ANGLE
from robobt.world.detections import Detections
from robobt.worlds import sim_world
from tests.conftest import StartPython
from tests.match.recording.made_recording import (
    BLUE_1,
    BLUE_4,
    PERIOD,
    YELLOW_0,
    Every,
    Raises,
    Wait,
    frame,
    header,
    record,
    runners,
)
from tests.tree.random_trees import random_tree


def stream(metadata: dict[str, str]) -> bytes:
    """An Arrow stream without rows."""
    sink = pa.BufferOutputStream()
    pa.ipc.new_stream(sink, pa.schema([("time", pa.float64())], metadata=metadata)).close()
    return sink.getvalue().to_pybytes()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "match.robobt.arrows"


def record_frames(path: Path, frames: list[Frame]) -> None:
    with Recorder(path, header()) as recorder:
        for each in frames:
            recorder.tick(each)
        recorder.close({})


def test_a_recording_gives_the_match_back_to_the_rounding(path: Path) -> None:
    record(path)
    recording = load_recording(path)
    assert len(recording) == 120
    for tick in range(120):
        told, true = recording.frame(tick), frame(tick, score=int(tick >= 50))
        assert told.time == pytest.approx(true.time, abs=1e-6)
        assert told.ball.position == pytest.approx(true.ball.position, abs=5.1e-5)
        assert (told.ball.vx, told.ball.vy) == pytest.approx((true.ball.vx, true.ball.vy), abs=5.1e-4)
        for robot, real in zip(told.own + told.opponents, true.own + true.opponents, strict=True):
            assert robot.position == pytest.approx(real.position, abs=5.1e-5)
            fine = (robot.heading, robot.vx, robot.vy, robot.omega)
            assert fine == pytest.approx((real.heading, real.vx, real.vy, real.omega), abs=5.1e-4)
            assert (robot.id, robot.ball_contact) == (real.id, real.ball_contact)
        assert (told.game, told.last_touch) == (true.game, true.last_touch)
        assert (told.field, told.period, told.team) == (true.field, true.period, Team.BLUE)


def test_the_header_holds_robots_and_their_trees(path: Path) -> None:
    record(path)
    told = load_recording(path).header
    assert told.model_copy(update={"robots": ()}) == header().model_copy(update={"robots": ()})
    assert [robot.id for robot in told.robots] == [BLUE_1, BLUE_4, YELLOW_0]
    assert told.robots[1].tree == ()
    assert [(node.name, node.type, node.depth) for node in told.robots[0].tree] == [
        ("play", "Selector", 0),
        ("now and then", "Sequence", 1),
        ("Every", "Every", 2),
        ("Wait", "Wait", 2),
        ("idle", "Wait", 1),
    ]
    assert told.robots[0].tree[2].detail == "count=7"


def test_every_status_and_every_word_is_there_at_its_tick(path: Path) -> None:
    seen = record(path)
    recording = load_recording(path)
    for tick, trees in enumerate(seen):
        for robot, (statuses, words) in trees.items():
            assert recording.statuses_at(robot, tick) == statuses
            said = recording.feedback_at(robot, tick)
            assert [said.get(place, "") for place in range(len(words))] == words


class Ticked(VisitorBase):
    """Notes the places of the nodes a tick reached."""

    def __init__(self, nodes: list[Behaviour]) -> None:
        super().__init__(full=False)
        self.places = {id(node): place for place, node in enumerate(nodes)}
        self.reached: set[int] = set()

    def initialise(self) -> None:
        self.reached = set()

    def run(self, behaviour: Behaviour) -> None:
        self.reached.add(self.places[id(behaviour)])


@pytest.mark.integration
@pytest.mark.parametrize("seed", range(40))
def test_whatever_a_tree_does_is_recorded_as_it_was_seen(path: Path, seed: int) -> None:
    rng = random.Random(seed)
    runner, twin = (
        TreeRunner(
            random_tree(random.Random(seed), f"{name}{seed}")([], "once"), Store(frame(0), frame(0).own[0])
        )
        for name in ("recorded", "watched")
    )
    ticked = Ticked(twin.nodes)
    twin.show_to(ticked)
    if seed % 4 == 0:
        runner.tick_by_py_trees()
    seen = []
    with Recorder(path, header(), {BLUE_1: runner}) as recorder:
        for tick in range(60):
            now = frame(tick)
            for node in runner.nodes + twin.nodes:
                if isinstance(node, Leaf):
                    node.store.frame = now
            ticked.reached = set()
            if rng.random() < 0.8:
                runner.tick()
                twin.tick()
            if rng.random() < 0.1:
                runner.stop()
                twin.stop()
            recorder.tick(now)
            words = [node.feedback_message for node in runner.nodes]
            seen.append((runner.statuses(), words, ticked.reached, twin.statuses()))
        recorder.close({})
    recording = load_recording(path)
    nodes = recording.header.robots[0].tree
    for tick, (statuses, words, reached, same) in enumerate(seen):
        assert statuses == same
        assert recording.statuses_at(BLUE_1, tick) == statuses
        said = recording.feedback_at(BLUE_1, tick)
        for place, letter in enumerate(statuses):
            if letter != "-" and nodes[place].type not in ("Selector", "Sequence", "Parallel"):
                assert said.get(place, "") == words[place]
        told = [nodes[place].path for place in sorted(reached) if statuses[place] != "-"]
        assert recording.ticked_path(BLUE_1, tick) == told


def test_frames_of_a_recording_tell_how_its_ball_moves(tmp_path: Path) -> None:
    ball = preset("grsim").ball.model
    with Recorder(tmp_path / "a.robobt", header(ball_model=ball)) as recorder:
        recorder.tick(frame(0))
    assert load_recording(tmp_path / "a.robobt").frame(0).ball_model == ball


def test_a_robot_too_far_away_for_the_file_is_nowhere(path: Path) -> None:
    far = frame(0)
    far.own = (replace(far.own[0], x=2.0**70), replace(far.own[1], x=1e307))
    record_frames(path, [far, frame(1)])
    assert [len(load_recording(path).frame(tick).own) for tick in range(2)] == [0, 2]


def test_trees_are_written_only_when_they_change(path: Path) -> None:
    record(path)
    changes = load_recording(path).statuses[0]
    assert 20 < len(changes) < 60
    assert all(one[1] != other[1] for one, other in pairwise(changes))


def test_a_robot_without_a_tree_has_no_statuses(path: Path) -> None:
    record(path)
    recording = load_recording(path)
    assert recording.statuses_at(BLUE_4, 10) == ""
    with pytest.raises(KeyError, match="yellow 9"):
        recording.statuses_at(RobotId(Team.YELLOW, 9), 0)


def test_events_and_outcome_come_back(path: Path) -> None:
    record(path)
    recording = load_recording(path)
    assert recording.events[1] == Event(pytest.approx(50 / 60, abs=1e-6), "goal", Team.BLUE, None, "1 : 0")
    kicks = [event for event in recording.events if event.kind == "kick"]
    assert [(event.team, event.robot) for event in kicks] == [(Team.YELLOW, YELLOW_0)] * 3
    assert recording.outcome == {"outcome": "goal_blue", "blue": 1}
    assert recording.complete


def test_flags_tell_contact_dribbler_and_kick(path: Path) -> None:
    record(path)
    flags = load_recording(path).flags
    sent = RobotFlag.COMMANDED
    assert flags[10].tolist() == [
        sent | RobotFlag.BALL_CONTACT | RobotFlag.DRIBBLER,
        0,
        sent | RobotFlag.KICK,
    ]
    assert flags[11].tolist() == [sent | RobotFlag.DRIBBLER, 0, sent | RobotFlag.KICK]


def test_yellows_view_of_a_match_is_recorded_as_blues(path: Path, tmp_path: Path) -> None:
    record_frames(path, [frame(tick) for tick in range(30)])
    record_frames(tmp_path / "mirrored", [frame(tick).mirrored() for tick in range(30)])
    one, other = load_recording(path), load_recording(tmp_path / "mirrored")
    np.testing.assert_allclose(one.truth.robots, other.truth.robots, atol=1.1e-3)
    np.testing.assert_allclose(one.truth.ball, other.truth.ball, atol=1e-9)


def test_the_placement_is_recorded_in_world_coordinates(path: Path) -> None:
    placed = replace(frame(0).game, command=RefereeCommand.BALL_PLACEMENT_BLUE, placement=(1.5, -2.0))
    record_frames(path, [replace(frame(0), game=placed).mirrored()])
    assert load_recording(path).frame(0).game == placed


def test_a_robot_off_the_field_is_nowhere_until_it_is_back(path: Path) -> None:
    frames = [frame(tick) for tick in range(3)]
    frames[1].own = frames[1].own[1:]
    record_frames(path, frames)
    recording = load_recording(path)
    assert [[robot.id for robot in recording.frame(tick).own] for tick in range(3)] == [[1, 4], [4], [1, 4]]
    assert np.isnan(recording.truth.robots[1, 0]).all()


def test_a_robot_the_header_does_not_list_is_left_out(path: Path) -> None:
    stranger = frame(0)
    stranger.own = (*stranger.own, RobotState(9, 0.0, 0.0))
    record_frames(path, [stranger])
    assert [robot.id for robot in load_recording(path).frame(0).own] == [1, 4]


def test_a_position_that_is_no_number_does_not_stop_the_recording(path: Path) -> None:
    broken = frame(0)
    broken.own = (replace(broken.own[0], x=nan), replace(broken.own[1], vy=inf))
    record_frames(path, [broken, replace(frame(1), ball=BallState(nan, 0.0)), frame(2)])
    recording = load_recording(path)
    assert recording.frame(0).own == ()
    assert np.isnan(recording.truth.ball[1]).all()
    assert len(recording.frame(2).own) == 2


@pytest.mark.parametrize("after", [0, 3])
def test_a_tree_that_raises_leaves_one_event_a_fault(path: Path, after: int) -> None:
    trees = {BLUE_1: TreeRunner(Selector("play", memory=False, children=[Raises("bad", after)]), None)}
    with Recorder(path, header(), trees) as recorder:
        for tick in range(5):
            trees[BLUE_1].tick()
            recorder.tick(frame(tick))
        recorder.close({})
    (event,) = load_recording(path).events
    assert (event.kind, event.robot, event.time) == ("error", BLUE_1, frame(after).time)
    assert event.text.startswith("play/bad: RuntimeError: broken on purpose (made_recording.py:")


def test_the_same_match_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        record(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_the_file_is_a_table_that_any_reader_of_arrow_opens(path: Path) -> None:
    record(path)
    with pa.memory_map(str(path)) as file:
        table = pa.ipc.open_stream(file).read_all()
    assert table.column_names == ["time", "truth", "observed", "commands", "changes", "detections"]
    assert table["time"].to_pylist() == pytest.approx([frame(tick).time for tick in range(120)])
    assert table["truth"][7].as_py()[:2] == pytest.approx(frame(7).ball.position, abs=1e-5)
    assert table["observed"].null_count == 120
    assert json.loads(table["changes"][50].as_py())["game"]["blue_score"] == 1
    assert json.loads(table.schema.metadata[b"header"])["scenario"] == "made"


def test_a_recorder_that_was_not_closed_leaves_an_incomplete_recording(path: Path) -> None:
    record(path, close=False)
    recording = load_recording(path)
    assert len(recording) == 120
    assert not recording.complete
    assert recording.outcome is None


def test_a_second_of_play_is_on_disk_while_the_match_goes_on(path: Path) -> None:
    with Recorder(path, header(), runners()) as recorder:
        assert len(load_recording(path)) == 0
        for tick in range(130):
            recorder.tick(frame(tick))
        held = load_recording(path)
        assert 120 <= len(held) <= 130
        assert not held.complete


def test_a_file_cut_anywhere_loads_up_to_its_last_whole_batch(path: Path, tmp_path: Path) -> None:
    record(path, ticks=200)
    data, cut = path.read_bytes(), tmp_path / "cut"
    source = pa.BufferReader(data)
    ends = []
    while source.tell() < len(data) - 8:
        pa.ipc.read_message(source)
        ends.append(source.tell())
    assert len(ends) == 6
    for size in [*range(ends[0], len(data), 997), *ends, *[end - 1 for end in ends[1:]], len(data) - 1]:
        cut.write_bytes(data[:size])
        whole = max(0, sum(end <= size for end in ends) - 2)
        recording = load_recording(cut)
        assert len(recording) == min(200, 60 * whole)
        assert recording.complete == (whole == 4)


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "is empty"),
        (b"PNG\r\n\x1a\n\x00\x00", "is not a robobt recording"),
        (b"just words", "is not a robobt recording"),
        (stream({}), "is not a robobt recording"),
        (stream({"format": "robobt-recording", "version": "7"}), "version: '7' cannot be read by"),
        (stream({"format": "robobt-recording", "version": "4"}), "header: Invalid JSON"),
        (stream({"format": "robobt-recording", "version": "5"}), "header: Invalid JSON"),
        (stream({"format": "robobt-recording", "version": "3", "header": "{}"}), "period: Field required"),
        (stream({"format": "robobt-recording"})[:40], "is cut off inside its header"),
        (b'{"format":"robobt-recording","version":2}\n', "is a recording in an older format"),
        (b"\x1f\x8b\x08\x00 a compressed one", "is a recording in an older format"),
    ],
)
def test_a_foreign_file_is_refused_in_one_clear_line(path: Path, content: bytes, problem: str) -> None:
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=re.escape(problem)) as caught:
        load_recording(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("version", ["3", "4", "5"])
def test_columns_that_do_not_fit_the_header_are_refused(path: Path, version: str) -> None:
    metadata = {"format": "robobt-recording", "version": version, "header": header().model_dump_json()}
    path.write_bytes(stream(metadata))
    with pytest.raises(RecordingError, match="its columns are not those of its header's robots"):
        load_recording(path)


def test_a_recording_of_version_3_is_read_with_its_ball_on_the_ground(path: Path) -> None:
    old = load_recording(Path(__file__).parent / "version_3.robobt.arrows")
    record(path, ticks=30)
    new = load_recording(path)
    assert len(old) == 30
    for tick in range(30):
        assert old.frame(tick) == new.frame(tick)
        for robot in (BLUE_1, BLUE_4, YELLOW_0):
            assert old.command(robot, tick) == new.command(robot, tick)
            assert old.letters_at(robot, tick) == new.letters_at(robot, tick)
    assert old.outcome == new.outcome
    assert "replay" in replay_html(old)


def test_what_cameras_saw_comes_back_to_the_rounding(path: Path) -> None:
    first = Detections(frame(1).time - 0.03, 2, (1.5, -0.25), {BLUE_4: (-1.0, 2.0, 0.5)})
    second = Detections(frame(1).time - 0.02, 3, None, {YELLOW_0: (3.0, 0.0, -2.0), BLUE_1: (0.0, 0.5, 1.0)})
    with Recorder(path, header()) as recorder:
        recorder.tick(frame(0))
        recorder.tick(frame(1), detections=[first, second])
        recorder.close({})
    pictures = load_recording(path).pictures
    assert pictures is not None
    assert pictures.times == pytest.approx([first.captured, second.captured], abs=1e-4)
    assert pictures.ages == pytest.approx([0.03, 0.02], abs=1e-4)
    assert pictures.cameras.tolist() == [2, 3]
    assert pictures.ball[0] == pytest.approx([1.5, -0.25])
    assert np.isnan(pictures.ball[1]).all()
    slots = [load_recording(path).slot(robot) for robot in (BLUE_4, YELLOW_0)]
    assert pictures.robots[0, slots[0]] == pytest.approx([-1.0, 2.0, 0.5], abs=1e-4)
    assert np.isnan(pictures.robots[0, slots[1]]).all()
    assert pictures.robots[1, slots[1]] == pytest.approx([3.0, 0.0, -2.0], abs=1e-4)


def test_a_recording_of_a_world_that_shows_the_truth_holds_no_pictures(path: Path) -> None:
    record(path, ticks=30)
    assert load_recording(path).pictures is None


def test_a_ball_in_the_air_and_a_chip_come_back_to_the_rounding(path: Path) -> None:
    # Some balls fly and some do not, seen by one team and shown to the other.
    frames = [
        replace(frame(tick), ball=BallState(1.0, 0.5, 2.0, 0.0, 0.3 * tick, 1.0 - tick)) for tick in range(3)
    ]
    frames[1] = replace(frame(1), ball=BallState(1.0, 0.5))
    chip = RobotCommand(kick_speed=5.0, kick_angle=CHIP_ANGLE)
    with Recorder(path, header()) as recorder:
        for each in frames:
            recorder.tick(each, {BLUE_4: chip}, observed=replace(each, ball=BallState(0.0, 0.0, z=0.25)))
        recorder.close({})
    recording = load_recording(path)
    for tick, each in enumerate(frames):
        told = recording.frame(tick).ball
        assert (told.z, told.vz) == pytest.approx((each.ball.z, each.ball.vz), abs=1e-3)
        assert recording.observation(tick).ball.z == 0.25
        command = recording.command(BLUE_4, tick)
        assert command is not None
        assert command.kick_angle == pytest.approx(CHIP_ANGLE, abs=1e-4)


def test_a_file_that_is_not_there_is_a_recording_error(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="No such file"):
        load_recording(tmp_path / "none")
    with pytest.raises(RecordingError, match="directory"):
        load_recording(tmp_path)


def edited(path: Path, column: str, value: object) -> None:
    """Change the cell of the third tick in a recording of one batch."""
    with pa.memory_map(str(path)) as file:
        _, batch = pa.ipc.open_stream(file)
    cells = batch[column].to_pylist()
    cells[2] = value
    place = batch.schema.names.index(column)
    changed = batch.set_column(place, batch.schema.field(column), pa.array(cells, batch.schema.types[place]))
    same = RecordingHeader.model_validate_json(batch.schema.metadata[b"header"])
    with path.open("wb") as file, new_stream(file, same) as writer:
        writer.write_batch(changed)


GAME = {"command": 1, "stage": 13, "blue_score": 0, "yellow_score": 0, "restart": None, "restart_team": None}


@pytest.mark.parametrize(
    ("column", "value", "field", "problem"),
    [
        ("time", None, None, "lacks numbers"),
        ("time", nan, "time", "must be finite and not less than the time before"),
        ("time", 0.0, "time", "must be finite and not less than the time before"),
        ("time", 1e12, "time", "must be finite and not less than the time before"),
        ("truth", None, None, "lacks numbers"),
        ("observed", [0.0] * 27, None, "lacks numbers"),
        ("commands", [0.0] * 17 + [77.0], "commands", "holds flags that are none"),
        ("commands", [0.0] * 17 + [nan], "commands", "holds flags that are none"),
    ],
)
def test_spoiled_numbers_are_named_with_tick_and_column(
    path: Path, column: str, value: object, field: str | None, problem: str
) -> None:
    record(path, ticks=10)
    edited(path, column, value)
    with pytest.raises(RecordingError, match=re.escape(problem)) as caught:
        load_recording(path)
    assert caught.value.path == path
    assert (caught.value.tick, caught.value.field) == (2 if field else 0, field)


@pytest.mark.parametrize(
    ("changes", "field", "problem"),
    [
        ("{", "changes", "Invalid JSON"),
        ("[" * 100_000, "changes", "recursion limit exceeded"),
        ({"dance": 1}, "dance", "Extra inputs are not permitted"),
        ({"statuses": {"blue 1": "SS"}}, "statuses.blue 1", "must have a letter for each node of the tree"),
        ({"statuses": {"blue 1": "SSSSX"}}, "statuses.blue 1", "String should match pattern"),
        ({"statuses": {"blue 7": "SSSSS"}}, "statuses", "there is no robot 'blue 7'"),
        ({"statuses": []}, "statuses", "Input should be an object"),
        (
            {"feedback": {"blue 1": {"5": "hi"}}},
            "feedback.blue 1",
            "names a node that the tree does not have",
        ),
        ({"feedback": {"blue 1": {"1": 3}}}, "feedback.blue 1.1", "Input should be a valid string"),
        ({"written": []}, "written", "Input should be an object"),
        ({"written": {"blue 1": 1}}, "written.blue 1", "Input should be an object"),
        ({"written": {"blue 9": {}}}, "written", "there is no robot or team 'blue 9'"),
        ({"game": GAME | {"command": 10}}, "game.command", "Input should be 0, 1"),
        ({"game": GAME | {"restart": "walk"}}, "game.restart", "Input should be 'kickoff'"),
        ({"touch": ["green", 1]}, "touch.0", "Input should be 'blue' or 'yellow'"),
        ({"touch": "blue"}, "touch", "Input should be"),
        ({"events": [{"time": 1e999, "kind": "goal"}]}, "events.0.time", "Input should be a finite number"),
    ],
)
def test_a_spoiled_change_is_named_with_its_field(
    path: Path, changes: object, field: str, problem: str
) -> None:
    record(path, ticks=10)
    edited(path, "changes", changes if isinstance(changes, str) else json.dumps(changes))
    with pytest.raises(RecordingError, match=re.escape(problem)) as caught:
        load_recording(path)
    assert (caught.value.path, caught.value.tick, caught.value.field) == (path, 2, field)
    assert "\n" not in str(caught.value)


def test_what_stands_after_the_end_is_refused(path: Path) -> None:
    record(path, ticks=3)
    path.write_bytes(path.read_bytes() * 2)
    with pytest.raises(RecordingError, match=r"is damaged after \d+ bytes"):
        load_recording(path)


@pytest.mark.integration
def test_spoiled_files_load_or_raise_one_error(path: Path) -> None:
    record(path, ticks=8)
    data = path.read_bytes()
    rng = random.Random(3)
    refused = 0
    for _ in range(600):
        spoiled = bytearray(data)
        for _ in range(rng.choice((1, 1, 2, 8))):
            spoiled[rng.randrange(len(data))] = rng.randrange(256)
        path.write_bytes(spoiled)
        try:
            load_recording(path)
        except RecordingError:
            refused += 1
    assert refused > 200


def test_the_header_is_checked_when_it_is_made() -> None:
    with pytest.raises(ValidationError, match="robot blue 1 is listed twice"):
        header(robots=[RecordedRobot(team=Team.BLUE, number=1)] * 2)
    orphan = RecordedNode(name="a", type="A", kind="leaf", depth=1)
    with pytest.raises(ValidationError, match="node 0 of the tree cannot have depth 1"):
        RecordedRobot(team=Team.BLUE, number=1, tree=(orphan,))


def test_a_recording_of_no_robots_is_one(path: Path) -> None:
    with Recorder(path, header(robots=())) as recorder:
        recorder.tick(frame(0))
        recorder.close({})
    recording = load_recording(path)
    assert (len(recording), recording.truth.robots.shape, recording.complete) == (1, (1, 0, 6), True)
    assert recording.frame(0).own == ()


def test_a_recording_of_no_ticks_is_one_that_is_not_complete(path: Path) -> None:
    with Recorder(path, header(robots=())) as recorder:
        recorder.close({})
    recording = load_recording(path)
    assert (len(recording), recording.truth.robots.shape, recording.complete) == (0, (0, 0, 6), False)
    with pytest.raises(IndexError):
        recording.frame(0)


def test_frames_can_be_counted_from_the_end(path: Path) -> None:
    record(path)
    assert load_recording(path).frame(-1).time == pytest.approx(119 * PERIOD, abs=1e-6)


def test_commands_of_robots_that_are_not_recorded_do_no_harm(path: Path) -> None:
    with Recorder(path, header()) as recorder:
        recorder.tick(frame(0), {RobotId(Team.YELLOW, 9): RobotCommand(kick_speed=1.0)})
    assert load_recording(path).flags[0].tolist() == [RobotFlag.BALL_CONTACT, 0, 0]


KILLED = """
import sys
from robobt.match.recording import Recorder
from tests.match.recording.made_recording import frame, header, runners
trees = runners()
recorder = Recorder(sys.argv[1], header(), trees)
tick = 0
while True:
    for runner in trees.values():
        runner.tick()
    recorder.tick(frame(tick))
    tick += 1
    if tick % 200 == 0:
        print(tick, flush=True)
"""


@pytest.mark.integration
def test_a_process_that_is_killed_leaves_all_but_its_last_second(
    path: Path, start_python: StartPython
) -> None:
    process = start_python("-c", KILLED, path)
    assert process.stdout is not None
    done = int(process.stdout.readline())
    process.kill()
    assert process.wait() == -signal.SIGKILL
    recording = load_recording(path)
    assert not recording.complete
    assert len(recording) > done - 1 / PERIOD
    assert recording.statuses_at(BLUE_1, done - 62) == "RFF-R"


def test_a_packed_bomb_is_refused_before_it_is_unpacked(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record(path, ticks=10)
    edited(path, "changes", " " * 2**26)
    assert path.stat().st_size < 2**16
    unpack, sizes = pa.ipc.read_record_batch, []

    def watched(message: pa.Message, schema: pa.Schema) -> pa.RecordBatch:
        batch = unpack(message, schema)
        sizes.append(batch.nbytes)
        return batch

    monkeypatch.setattr(pa.ipc, "read_record_batch", watched)
    with pytest.raises(RecordingError, match="is larger than 24 MiB unpacked, as no match is"):
        load_recording(path)
    assert sizes == [0]


@pytest.mark.parametrize("item", ["0,", "[],", "{},", "0.1,"])
def test_lists_that_would_fill_the_memory_are_refused_before_they_are_read(path: Path, item: str) -> None:
    record(path, ticks=10)
    values = f"[{item * 2**21}0]"
    edited(path, "changes", f'{{"written": {{"blue": {{"x": {values}}}}}}}')
    assert path.stat().st_size < 2**16
    tracemalloc.start()
    try:
        with pytest.raises(RecordingError, match="holds more values than a match does"):
            load_recording(path)
        assert tracemalloc.get_traced_memory()[1] < 50e6
    finally:
        tracemalloc.stop()


def test_more_text_than_a_match_has_is_refused(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record(path, ticks=10)
    monkeypatch.setattr(reader, "MOST_TEXT", 100)
    with pytest.raises(RecordingError, match="as no match is"):
        load_recording(path)


def test_what_skills_write_is_recorded_whenever_it_changes(path: Path) -> None:
    scenario = load_scenario("striker_vs_goalkeeper").with_robot("blue 0", max_distance=None).lasting(1.5)
    match = MatchLoop(scenario, 3, sim_world, path)
    striker = match.players[0]
    seen = []
    with match:
        while match.tick():
            seen.append((striker.store.shot, striker.store.command))
    recording = load_recording(path)
    assert len({shot for shot, _ in seen}) > 2
    for tick, (shot, command) in enumerate(seen):
        told = recording.written_at(striker.robot, tick)
        if shot is not None:
            target = pytest.approx(list(shot.target), abs=1e-5)
            assert told["shot"]["target"] == target
            assert told["shot"]["score"] == pytest.approx(shot.score, abs=1e-5)
        sent = recording.command(striker.robot, tick)
        assert sent is not None
        assert (sent.vx, sent.vy, sent.omega) == pytest.approx(
            (command.vx, command.vy, command.omega), abs=5.1e-4
        )
        assert (sent.dribbler, sent.kick_speed > 0) == (command.dribbler, command.kick_speed > 0)
    changes = recording.written[str(striker.robot)]
    assert all(one != other for (_, one), (_, other) in pairwise(changes))
    assert recording.header.seed == 3
    assert scenario_from(recording.header.played, "again").model_dump() == scenario.model_dump()


def test_why_nodes_failed_is_there_by_their_ids(path: Path) -> None:
    record(path)
    recording = load_recording(path)
    assert recording.failures_at(BLUE_1, 0) == {"play/now and then": "", "play/now and then/Every": "1 of 7"}
    assert recording.ticked_path(BLUE_1, 6) == [
        "play",
        "play/now and then",
        "play/now and then/Every",
        "play/now and then/Wait",
    ]


class Writes(Leaf[Store]):
    """Writes whatever it is given."""

    writes: ClassVar = ("target",)

    def __init__(self, values: Callable[[], object]) -> None:
        super().__init__()
        self.values = values

    def on_running(self) -> Status:
        self.store.target = self.values()  # type: ignore[assignment]
        return self.succeed()


class Rude:
    def __eq__(self, other: object) -> bool:
        raise RuntimeError("not comparable")

    __hash__ = None  # type: ignore[assignment]

    def __str__(self) -> str:
        raise RuntimeError("no text")

    __repr__ = __str__


def test_whatever_a_skill_writes_can_be_recorded(path: Path) -> None:
    shared = [1, 2]
    values = [
        (1.0, nan),
        shared,
        shared,
        {"a": {2, 1}},
        Rude(),
        Rude(),
        np.array([1.5, 2.0]),
        "x" * 999,
        object(),
    ]
    told = [
        [1.0, None],
        [1, 2],
        [1, 2, 3],
        {"a": [1, 2]},
        *["a Rude whose text is a RuntimeError"] * 2,
        [1.5, 2.0],
    ]
    store = Store(frame(0), frame(0).own[0])
    runner = TreeRunner(Writes(iter(values).__next__), store)
    with Recorder(path, header(), {BLUE_1: runner}, {BLUE_1: store}) as recorder:
        for tick in range(len(values)):
            runner.tick()
            if tick == 2:
                shared.append(3)
            recorder.tick(frame(tick))
    recording = load_recording(path)
    assert [recording.written_at(BLUE_1, tick)["target"] for tick in range(7)] == told
    assert len(recording.written_at(BLUE_1, 7)["target"]) == 200
    assert recording.written_at(BLUE_1, 8)["target"] == "a object"


class OwnError(BaseException):
    """Not even an Exception."""


class MuteError(Exception):
    def __str__(self) -> str:
        raise RuntimeError("no text")


class Ends(Leaf[None]):
    def __init__(self, error: BaseException) -> None:
        super().__init__()
        self.error = error

    def on_running(self) -> Status:
        self.feedback_message = MuteError()  # type: ignore[assignment]
        raise self.error


@pytest.mark.parametrize(
    "error", [GeneratorExit(3), OwnError("x"), MuteError("x"), RuntimeError(MuteError())]
)
def test_whatever_a_skill_raises_fails_one_robot(path: Path, error: BaseException) -> None:
    runner: TreeRunner = TreeRunner(Ends(error), None)
    with Recorder(path, header(), {BLUE_1: runner}) as recorder:
        for tick in range(3):
            assert runner.tick() is Status.INVALID
            recorder.tick(frame(tick))
    (event,) = load_recording(path).events
    assert event.text.startswith(f"Ends: {type(error).__name__}: ")
    assert re.search(r"\(test_recording\.py:\d+\)$", event.text)


def test_ctrl_c_in_a_skill_ends_the_program() -> None:
    runner: TreeRunner = TreeRunner(Ends(KeyboardInterrupt()), None)
    with pytest.raises(KeyboardInterrupt):
        runner.tick()


def test_words_without_a_text_are_recorded_as_such(path: Path) -> None:
    class Odd(Wait):
        def on_running(self) -> Status:
            return self.run(MuteError())  # type: ignore[arg-type]

    runner: TreeRunner = TreeRunner(Odd(), None)
    with Recorder(path, header(), {BLUE_1: runner}) as recorder:
        runner.tick()
        recorder.tick(frame(0))
    assert load_recording(path).feedback_at(BLUE_1, 0) == {0: "a MuteError whose text is a RuntimeError"}


def test_a_very_deep_or_very_wide_tree_is_recorded_too(path: Path) -> None:
    deep: Behaviour = Wait("leaf")
    for _ in range(150):
        deep = Sequence("deep", False, [deep])
    wide = Sequence("wide", False, [Every(1, f"{place}") for place in range(400)])
    runner: TreeRunner = TreeRunner(Selector("both", False, [Inverter("not", wide), deep]), None)
    with Recorder(path, header(), {BLUE_1: runner}) as recorder:
        for tick in range(3):
            runner.tick()
            recorder.tick(frame(tick))
    recording = load_recording(path)
    assert recording.statuses_at(BLUE_1, 2) == runner.statuses()
    assert len(set(recording.ticked_path(BLUE_1, 2))) == 554


@pytest.mark.integration
def test_recording_changes_nothing_of_what_is_played(path: Path) -> None:
    scenario = load_scenario("three_v_three").lasting(4.0)
    bare = MatchLoop(scenario, 5, sim_world).play()
    assert MatchLoop(scenario, 5, sim_world, path).play().trace == bare.trace


def test_a_match_in_which_trees_see_the_truth_holds_it_once(tmp_path: Path) -> None:
    path = tmp_path / "plain.robobt.arrows"
    with MatchLoop(load_scenario("striker_vs_goalkeeper").lasting(0.5), 0, sim_world, record=path) as match:
        while match.tick():
            pass
    assert load_recording(path).observed is None
