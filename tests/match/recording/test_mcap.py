"""MCAP files, opened by the library's own reader, hold what their recordings hold."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from math import atan2, cos, hypot, nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.SceneEntityDeletion_pb2 import SceneEntityDeletion
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from robobt.match import MatchLoop
from robobt.match.recording import Recording, load_recording
from robobt.match.recording.mcap import write_mcap
from robobt.match.scenario.scenario import load_scenario
from robobt.world import RobotId
from robobt.worlds import sim_world
from tests.match.recording.made_recording import BLUE_1, BLUE_4, PERIOD, YELLOW_0, record

Messages = dict[str, list[tuple[int, Any]]]


def opened(path: Path) -> Messages:
    """By topic each message with its time [ns], in the order of times."""
    found: Messages = defaultdict(list)
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            assert schema is not None
            assert decoded.DESCRIPTOR.full_name == schema.name
            assert message.publish_time == message.log_time
            found[channel.topic].append((message.log_time, decoded))
    return found


@pytest.fixture
def recording(tmp_path: Path) -> Recording:
    record(tmp_path / "made.robobt.arrows")
    return load_recording(tmp_path / "made.robobt.arrows")


def written(recording: Recording, folder: Path) -> Messages:
    return opened(write_mcap(recording, folder / "written.mcap"))


def test_topics_counts_and_times_of_a_match_are_those_of_its_recording(tmp_path: Path) -> None:
    # Noise, so that what trees see is not what is.
    noisy = {"realism": {"ball_noise": 0.001}}
    scenario = load_scenario("three_v_three").lasting(1.0).model_copy(update={"simulator": noisy})
    with MatchLoop(scenario, 3, sim_world, tmp_path / "m.robobt.arrows", layers=("paths",)) as match:
        match.play()
    recording = load_recording(tmp_path / "m.robobt.arrows")
    assert recording.observed is not None
    assert recording.drawn
    found = written(recording, tmp_path)
    times = [round(time * 1e9) for time in recording.times]
    expected = {"/truth": times, "/vision": times, "/field": times[:1]}
    # The same robots and the ball are there all the time.
    expected |= {"/truth/shapes": times[:1], "/vision/shapes": times[:1]}
    expected["/referee"] = [times[tick] for tick, _ in recording.games]
    expected["/events"] = sorted(round(event.time * 1e9) for event in recording.events)
    for slot, robot in enumerate(recording.header.robots):
        changed = {tick for tick, _ in recording.letters[slot]} | {
            tick for tick, _ in recording.feedback[slot]
        }
        expected[f"/trees/{robot.team}/{robot.number}"] = [times[tick] for tick in sorted(changed)]
    for owner, drawn in recording.drawn.items():
        expected[f"/drawings/{owner.replace(' ', '/')}"] = [times[tick] for tick, _ in drawn]
    assert {topic: [time for time, _ in told] for topic, told in found.items()} == {
        topic: times for topic, times in expected.items() if times
    }


def test_the_file_says_what_was_played_and_how_it_ended(recording: Recording, tmp_path: Path) -> None:
    with write_mcap(recording, tmp_path / "x.mcap").open("rb") as file:
        told = {entry.name: entry.metadata for entry in make_reader(file).iter_metadata()}
    assert told["recording"]["scenario"] == "made"
    assert told["recording"]["seed"] == "5"
    assert told["outcome"]["outcome"] == "goal_blue"


@pytest.mark.parametrize("shown", ["truth", "vision"])
def test_every_transform_is_the_pose_of_that_tick(shown: str, recording: Recording, tmp_path: Path) -> None:
    seen = replace(recording.truth, robots=recording.truth.robots + np.float32(0.1))
    recording = replace(recording, observed=seen)
    poses = recording.truth if shown == "truth" else seen
    for tick, (_, message) in enumerate(written(recording, tmp_path)[f"/{shown}"]):
        placed = {one.child_frame_id: one for one in message.transforms}
        assert set(placed) == {f"{shown}/{name}" for name in ("ball", "blue 1", "blue 4", "yellow 0")}
        assert {one.parent_frame_id for one in placed.values()} == {"field"}
        ball = placed[f"{shown}/ball"].translation
        assert (ball.x, ball.y, ball.z) == tuple(poses.ball[tick, [0, 1, 4]].tolist())
        for slot, robot in enumerate(recording.header.robots):
            one = placed[f"{shown}/{robot.id}"]
            x, y, heading = poses.robots[tick, slot, :3].tolist()
            assert (one.translation.x, one.translation.y, one.translation.z) == (x, y, 0.0)
            turn = one.rotation
            assert cos(2 * atan2(turn.z, turn.w) - heading) == pytest.approx(1.0)


def test_a_robot_off_the_field_and_a_ball_that_nobody_sees_are_left_out(
    recording: Recording, tmp_path: Path
) -> None:
    recording.truth.robots[40:80, recording.slot(BLUE_4)] = nan
    recording.truth.ball[60:] = nan
    found = written(recording, tmp_path)
    counts = [len(message.transforms) for _, message in found["/truth"]]
    assert counts == [4] * 40 + [3] * 20 + [2] * 20 + [3] * 40
    told = found["/truth/shapes"]
    assert [time for time, _ in told] == [round(tick * PERIOD * 1e9) for tick in (0, 40, 60, 80)]
    assert [{one.id for one in message.entities} for _, message in told] == [
        {"ball", "blue 1", "blue 4", "yellow 0"},
        {"ball", "blue 1", "yellow 0"},
        {"blue 1", "yellow 0"},
        {"blue 1", "blue 4", "yellow 0"},
    ]
    for _, message in told:
        assert [deletion.type for deletion in message.deletions] == [SceneEntityDeletion.Type.ALL]


@pytest.mark.parametrize("robot", [BLUE_1, YELLOW_0])
def test_statuses_and_reasons_are_those_of_the_tick(
    robot: RobotId, recording: Recording, tmp_path: Path
) -> None:
    letters = {0: "-", 1: "R", 2: "S", 3: "F"}
    topic = f"/trees/{robot.team}/{robot.number}"
    for time, tree in written(recording, tmp_path)[topic]:
        tick = round(time / 1e9 / PERIOD)
        assert tree.timestamp.ToNanoseconds() == time
        assert [node.path for node in tree.nodes] == [node.path for node in recording.nodes(robot)]
        told = "".join([letters[node.status] for node in tree.nodes])
        assert told == recording.statuses_at(robot, tick)
        assert [node.path for node in tree.nodes if node.ticked] == recording.ticked_path(robot, tick)
        reasons = {place: node.reason for place, node in enumerate(tree.nodes) if node.reason}
        there = {place for place, letter in enumerate(told) if letter != "-"}
        feedback = recording.feedback_at(robot, tick)
        assert reasons == {place: text for place, text in feedback.items() if place in there}


def test_drawings_lie_where_their_team_drew_them(recording: Recording, tmp_path: Path) -> None:
    shapes = [
        ["plan", "line", 1.0, 2.0, 3.0, 0.5],
        ["plan", "point", 1.0, 0.25],
        ["aim", "circle", 1.0, 2.0, 0.5],
        ["aim", "text", 1.0, 2.0, "here"],
        ["aim", "number", 0.75, "chance"],
    ]
    drawn = {"blue 1": [(3, shapes), (5, [])], "yellow 0": [(4, shapes)], "field": [(6, shapes)]}
    found = written(replace(recording, drawn=drawn), tmp_path)
    (_, first), (_, cleared) = found["/drawings/blue/1"]
    assert not cleared.entities
    assert len(cleared.deletions) == 1
    for message, sign in (
        (first, 1.0),
        (found["/drawings/yellow/0"][0][1], -1.0),
        (found["/drawings/field"][0][1], 1.0),
    ):
        layers = {entity.id: entity for entity in message.entities}
        assert set(layers) == {"plan", "aim"}
        (line,) = layers["plan"].lines
        assert [(point.x, point.y) for point in line.points] == [(sign, 2 * sign), (3 * sign, 0.5 * sign)]
        assert layers["plan"].spheres[0].pose.position.y == 0.25 * sign
        (text,) = layers["aim"].texts
        assert (text.text, text.pose.position.x) == ("here", sign)
        (circle,) = layers["aim"].lines
        for point in circle.points:
            assert hypot(point.x - sign, point.y - 2 * sign) == pytest.approx(0.5)
    ((time, number),) = found["/numbers/yellow/0"]
    assert time == round(4 * PERIOD * 1e9)
    assert (number.layer, number.name, number.value) == ("aim", "chance", 0.75)


def test_events_and_the_referees_word_are_logs(recording: Recording, tmp_path: Path) -> None:
    found = written(recording, tmp_path)
    goal = next(message for _, message in found["/events"] if message.message.startswith("goal"))
    assert (goal.message, goal.name, goal.level) == ("goal: 1 : 0", "blue", Log.Level.INFO)
    assert [message.message for _, message in found["/referee"]] == [
        "FORCE_START, blue 0 : 0 yellow",
        "STOP, blue 1 : 0 yellow",
    ]


def test_times_before_0_are_refused_and_nothing_is_left_behind(recording: Recording, tmp_path: Path) -> None:
    before = {path.name for path in tmp_path.iterdir()}
    with pytest.raises(ValueError, match="before time 0"):
        write_mcap(replace(recording, times=recording.times - 1.0), tmp_path / "x.mcap")
    assert {path.name for path in tmp_path.iterdir()} == before
