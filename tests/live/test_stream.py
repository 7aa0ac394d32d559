"""What viewers are sent is what was played, wherever they begin."""

import base64
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robobt.live import stream as module
from robobt.live.replay_html import page_data
from robobt.live.stream import Stream
from robobt.match import MatchLoop
from robobt.match.recording import Recording, load_recording
from robobt.match.recording.reader import parse_recording
from robobt.match.scenario.scenario import load_scenario
from robobt.worlds import sim_world

pytestmark = pytest.mark.integration

SECONDS = 8.0


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> tuple[Stream, Recording, list[bytes]]:
    """A match that was streamed and recorded, and the present at each second."""
    path = tmp_path_factory.mktemp("live") / "m.robobt.arrows"
    presents = []
    with MatchLoop(load_scenario("team_v_baseline").lasting(SECONDS), 3, sim_world, path) as match:
        stream = Stream(match.capture())
        ticks = 0
        while match.tick():
            ticks += 1
            if ticks % 3 == 0:
                stream.advance()
            if ticks % 60 == 0:
                present = stream.present()
                assert present is not None
                presents.append(present)
        stream.advance()
    return stream, load_recording(path), presents


def decoded(message: bytes) -> dict[str, Any]:
    chunk: dict[str, Any] = json.loads(message)
    return chunk


def numbers(text: str, kind: str) -> np.ndarray[Any, Any]:
    return np.frombuffer(base64.b64decode(text), dtype=kind)


Known = list[tuple[str, dict[int, str], dict[str, Any]]]


def shown(chunks: list[dict[str, Any]], tree_sizes: list[int]) -> Iterator[Known]:
    """What a page knows of every robot after each chunk: letters, feedback, what skills wrote."""
    robots: Known = [("", {}, {}) for _ in tree_sizes]
    for chunk in chunks:
        for slot, news in enumerate(chunk["robots"]):
            letters, said, written = robots[slot]
            if chunk["whole"]:
                said = {}
            flat = news.get("feedback", [])
            for node, text in zip(flat[1::3], flat[2::3], strict=True):
                said = {**said, node: chunk["texts"][text]}
            for place in news.get("statuses", [])[-1:]:
                letters = chunk["letters"][place]
            for change in news.get("written", [])[1::2]:
                written = {**written, **change}
            robots[slot] = letters, said, written
        yield list(robots)


def test_the_chunks_hold_every_tick_of_the_match(played: tuple[Stream, Recording, list[bytes]]) -> None:
    stream, recording, _ = played
    messages, end = stream.messages(0, 2**30)
    assert end == stream.end == len(messages)
    chunks = [*map(decoded, messages)]
    assert sum(chunk["frames"] for chunk in chunks) == len(recording)
    times = np.concatenate([numbers(chunk["times"], "<f4") for chunk in chunks])
    np.testing.assert_allclose(times, recording.times, atol=1e-5)
    whole = page_data(recording)
    rows = np.concatenate([numbers(chunk["robots"][3]["rows"], "<i2") for chunk in chunks])
    np.testing.assert_array_equal(rows, numbers(whole["robots"][3]["rows"], "<i2"))  # type: ignore[index]
    assert [event for chunk in chunks for event in chunk["events"]] == json.loads(json.dumps(whole["events"]))


def test_a_viewer_that_begins_anywhere_whole_knows_what_one_from_the_start_knows(
    played: tuple[Stream, Recording, list[bytes]],
) -> None:
    stream, recording, _ = played
    chunks = [decoded(message) for message in stream.messages(0, 2**30)[0]]
    sizes = [len(robot.tree) for robot in recording.header.robots]
    begins = [i for i, chunk in enumerate(chunks) if chunk["whole"]]
    assert len(begins) == 2
    *_, all_along = shown(chunks, sizes)
    *_, from_there = shown(chunks[begins[1] :], sizes)
    for slot, robot in enumerate(recording.header.robots):
        tick = len(recording) - 1
        for letters, said, _ in (all_along[slot], from_there[slot]):
            assert letters == recording.statuses_at(robot.id, tick)
            assert {node: text for node, text in said.items() if text} == recording.feedback_at(
                robot.id, tick
            )
        assert all_along[slot][2] == from_there[slot][2]


def test_the_present_is_what_the_recording_has_at_that_tick(
    played: tuple[Stream, Recording, list[bytes]],
) -> None:
    _, recording, presents = played
    for message in presents:
        chunk = decoded(message)
        tick = int(np.argmin(np.abs(recording.times - float(numbers(chunk["times"], "<f4")[0]))))
        (robots,) = shown([chunk], [len(robot.tree) for robot in recording.header.robots])
        for slot, robot in enumerate(recording.header.robots):
            assert robots[slot][0] == recording.statuses_at(robot.id, tick)
        assert chunk["frames"] == 1


def test_what_is_saved_is_what_was_recorded(played: tuple[Stream, Recording, list[bytes]]) -> None:
    stream, recording, _ = played
    saved = parse_recording(stream.recording(), Path("saved"))
    assert saved.header == recording.header
    np.testing.assert_array_equal(saved.times, recording.times)
    np.testing.assert_array_equal(saved.truth.robots, recording.truth.robots)
    np.testing.assert_array_equal(saved.commands, recording.commands)
    for tick in range(0, len(recording), 25):
        for robot in recording.header.robots:
            assert saved.letters_at(robot.id, tick) == recording.letters_at(robot.id, tick)
            assert saved.feedback_at(robot.id, tick) == recording.feedback_at(robot.id, tick)
            assert saved.written_at(robot.id, tick) == recording.written_at(robot.id, tick)
    assert saved.events == recording.events


def test_only_the_last_minutes_are_kept_and_can_still_be_saved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "KEPT_TIME", 2.0)
    monkeypatch.setattr(module, "_SEGMENT", 1.0)
    with MatchLoop(load_scenario("striker_vs_goalkeeper").lasting(7.0), 4, sim_world) as match:
        stream = Stream(match.capture())
        while match.tick():
            stream.advance()
            assert stream.end - len(stream.messages(0, 2**30)[0]) == stream.first
    saved = parse_recording(stream.recording(), Path("saved"))
    last = match.result().time
    assert stream.first > 0
    assert 2.0 <= last - saved.times[0] <= 4.0
    assert saved.times[-1] == pytest.approx(last, abs=0.1)
    robot = saved.header.robots[0].id
    assert "-" * len(saved.nodes(robot)) != saved.letters_at(robot, 0)


def test_messages_are_given_piece_by_piece(played: tuple[Stream, Recording, list[bytes]]) -> None:
    stream = played[0]
    everything, _ = stream.messages(0, 2**30)
    found: list[bytes] = []
    at = 0
    while at < stream.end:
        some, at = stream.messages(at, 5000)
        assert sum(map(len, some[:-1])) <= 5000
        found += some
    assert found == everything
    assert stream.messages(stream.end, 5000) == ([], stream.end)
