"""What an exception in a robot's tree does to its match."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

from robobt.match import RunError, Scenario, ScenarioError, run_trials_in
from robobt.match.loop import MatchLoop
from robobt.match.recording import load_recording
from robobt.match.scenario.scenario import scenario_from
from robobt.signals import Terminated
from robobt.tree import Sequence, Status, TreeError, TreeRunner
from tests.match.scripted import PlainWorld, Scripted, data


def breaking(breaks: str, **changes: Any) -> Scenario:
    given = data(ends={"time_limit": 0.1}, **changes)
    given["robots"]["blue"][0]["params"] = {"breaks": breaks}
    return scenario_from(given, "mine.yaml")


def test_by_default_the_match_goes_on_without_the_robot() -> None:
    (result,) = run_trials_in(breaking("raise"), PlainWorld).results
    assert result.robots["blue 0"].errors == result.ticks - 1 > 0


def test_a_tree_that_fails_at_every_tick_for_one_reason_is_told() -> None:
    run = run_trials_in(breaking("fail"), PlainWorld, 2)
    assert run.results[0].robots["blue 0"].always_failed == "Scripted: cannot"
    assert run.summary().robots["blue 0"].always_failed == "Scripted: cannot"
    (other,) = run_trials_in(breaking("fail once"), PlainWorld, 1).results
    assert other.robots["blue 0"].always_failed is None


@pytest.mark.parametrize("breaks", ["raise", "nan"])
def test_raise_ends_the_match_with_the_robot_and_the_nodes_path(breaks: str) -> None:
    match = MatchLoop(breaking(breaks, on_error="raise"), 0, PlainWorld)
    with pytest.raises(TreeError, match=r"^blue 0: Scripted: "):
        match.tick()


def test_what_the_node_raised_is_the_cause() -> None:
    match = MatchLoop(breaking("raise", on_error="raise"), 0, PlainWorld)
    with pytest.raises(TreeError) as raised:
        match.tick()
    assert isinstance(raised.value.__cause__, RuntimeError)


def test_a_run_ends_with_file_trial_robot_and_node() -> None:
    with pytest.raises(RunError, match=r"^mine\.yaml: trial \d: blue 0: Scripted: RuntimeError: brok"):
        run_trials_in(breaking("raise", on_error="raise"), PlainWorld, 2)


def test_the_recording_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "raised.robobt.arrows"
    with pytest.raises(RunError):
        run_trials_in(breaking("raise", on_error="raise"), PlainWorld, record={0: path})
    assert load_recording(path).header.trial == 0


def test_finished_trials_can_be_continued_under_the_other_policy(tmp_path: Path) -> None:
    out = tmp_path / "results.jsonl"
    first = run_trials_in(breaking("", on_error="raise"), PlainWorld, 2, out=out)
    assert run_trials_in(breaking(""), PlainWorld, 2, out=out).results == first.results


def test_another_word_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r"mine\.yaml: on_error: input should be 'stop' or 'raise'"):
        breaking("", on_error="ignore")


def test_a_skill_that_ends_the_program_ends_the_match_and_its_recording_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "left.robobt.arrows"
    match = MatchLoop(breaking(""), 0, PlainWorld, record=path)

    def leave() -> None:
        raise SystemExit(3)

    assert match.tick()
    monkeypatch.setattr(match.players[0].runner, "_tick", leave)
    with pytest.raises(SystemExit), match:
        match.tick()
    assert len(load_recording(path)) == 1


class Leaves(Scripted):
    def on_running(self) -> Status:
        sys.exit("enough")


def test_a_skill_that_ends_the_program_is_named(caplog: pytest.LogCaptureFixture) -> None:
    runner = TreeRunner(Sequence("root", False, [Leaves(speed=1.0, kick=0.0, breaks="")]), None)
    with pytest.raises(SystemExit, match="enough"):
        runner.tick()
    assert "root/Leaves ends the program: SystemExit: enough (test_on_error.py:" in caplog.text


def test_a_signal_that_arrives_in_a_skill_is_not_the_skills(caplog: pytest.LogCaptureFixture) -> None:
    leaf = Leaves(speed=1.0, kick=0.0, breaks="")
    for leaving in (Terminated(15), KeyboardInterrupt()):
        leaf.on_running = Mock(side_effect=leaving)  # type: ignore[method-assign]
        with pytest.raises(type(leaving)):
            TreeRunner(leaf, None).tick()
    assert caplog.text == ""
