"""What skills draw: kept in recordings on request, and nothing that a match depends on."""

from pathlib import Path

import pytest

from robobt.match import MatchLoop, load_scenario
from robobt.match.recording import RecordingError, load_recording
from robobt.match.recording.reader import parse_recording
from robobt.match.results.results import MatchResult
from robobt.match.scenario.scenario import Scenario
from robobt.worlds import sim_world

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("three_v_three").lasting(1.0)


def play(scenario: Scenario, path: Path, *layers: str) -> MatchResult:
    with MatchLoop(scenario, 3, sim_world, path, layers=layers) as match:
        while match.tick():
            pass
        return match.result()


def test_a_recording_holds_the_layers_that_were_asked_for(scenario: Scenario, tmp_path: Path) -> None:
    path = tmp_path / "m.robobt.arrows"
    result = play(scenario, path, "paths")
    recording = load_recording(path)
    shapes = [shape for name in recording.drawn for _, drawn in recording.drawn[name] for shape in drawn]
    assert {(shape[0], shape[1]) for shape in shapes} == {("paths", "line")}
    # A way begins where its robot is, in the view of its own team.
    for robot in recording.header.robots:
        side = 1.0 if robot.team == "blue" else -1.0
        for tick, drawn in recording.drawn.get(str(robot.id), [])[:5]:
            x, y = (recording.observed or recording.truth).robots[tick, recording.slot(robot.id), :2]
            for shape in drawn[:1]:
                assert shape[2:4] == pytest.approx([side * x, side * y], abs=1e-3)
    assert result.trace == play(scenario, tmp_path / "n.robobt.arrows").trace
    assert load_recording(tmp_path / "n.robobt.arrows").drawn == {}


def test_what_viewers_look_at_is_not_recorded_with_it(scenario: Scenario, tmp_path: Path) -> None:
    usual, watched = tmp_path / "usual.robobt.arrows", tmp_path / "watched.robobt.arrows"
    play(scenario, usual, "targets")
    with MatchLoop(scenario, 3, sim_world, watched, layers=["targets"]) as match:
        match.capture().look("a viewer", {"paths", "targets"})
        while match.tick():
            pass
    assert watched.read_bytes() == usual.read_bytes()
    assert match.capture().layers >= {"paths", "targets"}


def test_drawings_that_are_none_are_refused(scenario: Scenario, tmp_path: Path) -> None:
    path = tmp_path / "m.robobt.arrows"
    with MatchLoop(scenario, 3, sim_world, path, layers=["evil"]) as match:
        match.capture().field._wanted = ["evil"]
        match.capture().field._shapes = [["evil", "text", 0.0, float("nan"), "text"]]
        match.tick()
    with pytest.raises(RecordingError, match=r"tick 0: drawn\.field\.0"):
        parse_recording(path.read_bytes(), path)
