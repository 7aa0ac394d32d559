"""Every benchmark is a command of ``python -m benchmarks``, whose help explains what it prints."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result
from typer.testing import CliRunner

from benchmarks import tree
from benchmarks.__main__ import COMMANDS, SCRIPTS, application
from robobt.config.yaml import write_yaml
from robobt.tree import TreeRunner
from tests.cli.test_train import OPTIONS
from tests.match.scripted import data


def run(name: str, *arguments: object, code: int = 0) -> Result:
    result = CliRunner().invoke(application(name), [name, *map(str, arguments)])
    assert result.exit_code == code, result.output
    return result


def told(*arguments: str) -> dict[str, Any]:
    printed = json.loads(run(*arguments, "--json").stdout)
    assert isinstance(printed, dict)
    return printed


def help_of(name: str) -> str:
    return " ".join(run(name, "--help").stdout.replace("│", " ").split())


def test_without_a_name_the_benchmarks_are_listed() -> None:
    listed = CliRunner().invoke(application(), ["--help"]).output
    assert all(name in listed for name in (*COMMANDS, *SCRIPTS))


@pytest.mark.integration
@pytest.mark.parametrize("name", COMMANDS)
def test_each_has_help(name: str) -> None:
    assert f"python -m benchmarks {name}" in help_of(name).replace("root", "python -m benchmarks")


def test_a_script_reads_its_own_options(capsys: pytest.CaptureFixture[str]) -> None:
    assert "--draws DRAWS" in run("vision_faults", "--help").stdout


@pytest.mark.integration
def test_the_simulator_is_measured() -> None:
    printed = told("sim", "--seconds", "0.1")
    assert list(printed) == ["one_v_one", "six_v_six", "eleven_v_eleven"]
    explained = help_of("sim")
    for case, figures in printed.items():
        assert case in explained
        assert all(key in explained for key in figures)
        assert figures["steps_per_s"] > 0
        assert figures["bare_ratio"] > 0
        assert figures["pairs"] >= 1
        # Without meetings the physics would cost next to nothing.
        assert figures["contacts_per_s"] > 0.0
    assert "Compared: CPU time of 200 control steps with frames" in run("sim", "--seconds", "0.1").stdout


@pytest.mark.integration
def test_a_match_is_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = tmp_path / "mine.yaml"
    scenario.write_text(write_yaml(data(ball={"position": {"center": [0, 0], "radius": 0.5}})))
    stock: list[TreeRunner[Any]] = []
    by_py_trees = TreeRunner.tick_by_py_trees

    def tick_by_py_trees(runner: TreeRunner[Any]) -> None:
        stock.append(runner)
        by_py_trees(runner)

    monkeypatch.setattr(TreeRunner, "tick_by_py_trees", tick_by_py_trees)
    printed = told("match", str(scenario), "--seconds", "1")
    # Of the four matches, one is ticked by py_trees.
    assert len(stock) == printed["robots"]
    explained = help_of("match")
    assert all(key in explained for key in printed)
    assert printed["real_time_factor"] == pytest.approx(printed["simulated_s"] / printed["cpu_s"])
    assert printed["real_time_factor_py_trees"] > 0
    assert printed["recording_share"] < 1
    assert 0 <= printed["referee_share"] < 1
    assert printed["speedup_vs_py_trees"] > 0
    assert printed["turns"] >= 1
    text = run("match", scenario, "--seconds", "1").stdout
    assert "times real time" in text
    assert "Compared: processor time of the same match" in text


@pytest.mark.integration
def test_trees_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    measure = tree.bench_tree
    monkeypatch.setattr(tree, "bench_tree", lambda: measure(rounds=1, ticks=20))
    printed, explained = told("tree"), help_of("tree")
    for key in ("speedup_vs_py_trees", "ratio_to_plain_classes", "store_speedup_vs_blackboard"):
        assert key in explained
        assert printed[key] > 0


@pytest.mark.integration
def test_the_learners_switches_are_compared(tmp_path: Path) -> None:
    told = run("train", "shoot", "--seeds", 1, "--only", "fast", *OPTIONS, "--out", tmp_path)
    assert "the bar" in told.output
    assert (tmp_path / "comparison.md").read_text().count("\n") == 3


@pytest.mark.integration
def test_trainings_are_timed_beside_another_checkout() -> None:
    short = "steps=1280", "evaluation.every=640", "evaluation.starts=2", "rebuild_every=640"
    options = [word for each in short for word in ("--set", each)]
    root = str(Path(__file__).parents[2])
    for bar, reached, steps in (("0", True, 640), ("1", False, 1280)):
        asked = "train_to", "go_to_ball", "--bar", bar, "--seeds", "1", "--starts", "2"
        printed = told(*asked, "--beside", root, *options)
        assert [checkout["folder"] for checkout in printed["checkouts"]] == ["", root]
        for checkout in printed["checkouts"]:
            (row,) = checkout["seeds"]
            assert (row["reached"], row["steps"], len(row["curve"])) == (reached, steps, steps // 640)
            assert row["cpu_s"] == row["curve"][-1][1] > 0.0
            assert (checkout["median_cpu_s"] is not None) == reached


def test_an_unknown_task_is_told_before_a_training_starts() -> None:
    told = run("train_to", "go_to_bal", code=1)
    assert "no task is called 'go_to_bal'; did you mean go_to_ball or" in " ".join(told.output.split())


def test_help_keeps_brackets() -> None:
    assert "robobt[sb3]" in help_of("ppo")


def test_an_unknown_switch_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    told = run("train", "shoot", "--only", "magic", code=1)
    assert "no variant is called 'magic'" in " ".join(told.output.split())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.integration
def test_the_filter_is_measured() -> None:
    play = told("filter", "--seconds", "2")["play"]
    assert play["compensated"]["robot_position"] < play["uncompensated"]["robot_position"]
    printed = run("filter", "--seconds", 2).stdout
    assert printed.count("at capture") == printed.count("uncompensated") == 2


@pytest.mark.slow
def test_the_league_is_measured_in_two_processes() -> None:
    printed = told("league", "--seconds", "6")
    assert printed["lost"] == printed["errors"] == printed["dropped"] == 0
    assert printed["frame_rate"] == pytest.approx(60.0, rel=0.02)


@pytest.mark.slow
def test_clocks_are_followed() -> None:
    rows = told("clock", "--seconds", "6")["rows"]
    assert {row["speed"] for row in rows} == {0.25, 0.5, 1.0, 2.0, 4.0}
    assert all(row["mean_error"] < 0.003 for row in rows)
    assert "queued" in run("clock", "--seconds", 6).stdout


@pytest.mark.integration
def test_a_late_team_is_played_beside_one_that_is_not() -> None:
    arms = "--only", "+0", "--only", "measured"
    length = "--seconds", "10", "--matches", "1", "--workers", "1"
    figures = told("late_team", "--scenario", "striker_vs_goalkeeper", *length, *arms)["arms"]
    assert figures["+0"]["goals"] == [1]
    assert figures["measured"]["goals"] in ([0], [1])
    assert figures["measured"]["share"] == figures["measured"]["mean"]
