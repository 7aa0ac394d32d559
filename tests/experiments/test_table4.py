"""Table 4: the paper's figures beside ours."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.experiments.table4 import COMBINATIONS, play_attempt, table4, table4_scenario
from robobt.experiments.table4_picture import draw_table4
from robobt.experiments.table4_rows import PAPER
from robobt.learning.envs.episodes import straight_line_time
from robobt.match import load_scenario
from robobt.match.runner import trial_seed
from robobt.models.policy import load_policy

pytestmark = pytest.mark.integration

QUICK = ("robobulls", "geometric, kick")
LEARNED = COMBINATIONS["ddpg, ddpg"]


@pytest.mark.parametrize("trial", ["1", "2"])
@pytest.mark.parametrize("row", ["ddpg", "baseline", "human"])
def test_the_papers_totals_are_the_sums_of_its_parts(trial: str, row: str) -> None:
    figures = PAPER[trial][row]
    assert figures["to_ball"] + figures["shoot"] == pytest.approx(figures["total"], abs=2e-4)


def test_the_table_holds_every_figure() -> None:
    found = table4(3, combinations=QUICK, trials=["1"])["trials"]["1"]
    row = found["rows"]["geometric, kick"]
    assert row["goals"] == pytest.approx({"count": 3, "rate": 1.0, "low": 0.4385, "high": 1.0}, abs=1e-3)
    for part in ("approach", "pick_up", "to_ball", "shoot", "total"):
        assert row[part]["n"] == 3
        assert row[part]["low"] <= row[part]["mean"] <= row[part]["high"]
    assert row["approach"]["mean"] + row["pick_up"]["mean"] == pytest.approx(row["to_ball"]["mean"])
    assert row["to_ball"]["mean"] + row["shoot"]["mean"] == pytest.approx(row["total"]["mean"])
    assert found["best_hand_written"] == "geometric, kick"
    assert found["test"] is None


def test_the_optimum_is_that_of_the_limits_an_approach_has() -> None:
    """From (-3.9, 0) m to 0.2 m from the centre: RoboBulls' pilot, and the preset's own limits."""
    rows = table4(1, combinations=QUICK, trials=["1"])["trials"]["1"]["rows"]
    assert rows["robobulls"]["optimum"] == pytest.approx(3.7 / 1.5 + 1.5 / (2 * 2.5))
    assert rows["geometric, kick"]["optimum"] == pytest.approx(3.7 / 5.0 + 5.0 / (2 * 4.15))
    assert rows["geometric, kick"]["optimum_ratio"] > 1.0


def test_another_simulator_keeps_the_trial() -> None:
    own, other = table4_scenario("2", {}), table4_scenario("2", {}, "erforce", "realistic")
    assert (other.ball, other.period) == (own.ball, own.period)
    assert other.simulator["preset"] == "erforce"
    assert other.simulator["realism"] == "realistic"


def test_a_run_is_the_bundled_scenario_played_with_the_same_seed() -> None:
    for trial in ("1", "2"):
        bundled = load_scenario(f"table4_trial{trial}_ddpg")
        # The table's rows share the simpler grSim; this one is played in the preset that is like the real.
        ours = table4_scenario(trial, LEARNED).model_copy(update={"simulator": bundled.simulator})
        assert dict(bundled.robots.blue[0].params) == LEARNED
        assert bundled.simulator["preset"] == "grsim"
        assert play_attempt(bundled, 7) == play_attempt(ours, 7)


@pytest.mark.parametrize("trial", ["1", "2"])
def test_the_learned_skills_score_and_are_sooner_at_the_ball_than_the_papers(trial: str) -> None:
    """Six of the hundred runs of ``robobt paper table4 --runs 100``."""
    found = table4(6, combinations=["ddpg, ddpg"], trials=[trial])
    rows = found["trials"][trial]["rows"]
    assert rows["ddpg, ddpg"]["goals"]["count"] == 6
    assert rows["ddpg, ddpg"]["to_ball"]["mean"] <= PAPER[trial]["ddpg"]["to_ball"]
    # It brakes before a ball that this simulator's dribbler takes surely at 0.6 m/s only.
    assert rows["ddpg, ddpg"]["optimum_ratio"] <= 1.3


def test_the_learned_approachs_optimum_is_that_of_its_model() -> None:
    action = load_policy("go_to_ball_ddpg").card.action
    assert action is not None
    row = table4(1, combinations=["ddpg, ddpg"], trials=["1"])["trials"]["1"]["rows"]["ddpg, ddpg"]
    assert row["optimum"] == pytest.approx(float(straight_line_time(3.7, action.max_speed, 4.15)))


@pytest.mark.parametrize("trial", ["1", "2"])
@pytest.mark.parametrize(
    ("preset", "realism"), [("grsim", None), ("erforce", None), ("default", None), ("grsim", "realistic")]
)
def test_the_shipped_models_score_in_simulators_they_were_not_trained_in(
    preset: str, realism: str | None, trial: str
) -> None:
    scenario = table4_scenario(trial, LEARNED, preset, realism)
    runs = [play_attempt(scenario, trial_seed(1, run)) for run in range(3)]
    assert sum(run.to_ball is not None for run in runs) == 3
    assert sum(run.goal for run in runs) >= 2


def test_the_picture_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    result = table4(2, combinations=QUICK)
    draw_table4(result, tmp_path / "sub" / "table4.png")
    assert (tmp_path / "sub" / "table4.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ValueError, match="not supported"):
        draw_table4(result, tmp_path / "table4.doc")
    assert [path.name for path in tmp_path.iterdir()] == ["sub"]


def test_the_command_prints_and_is_read_by_programs() -> None:
    call = ["paper", "table4", "--runs", "1", "--only", "geometric, kick"]
    shown = CliRunner().invoke(app, call)
    assert shown.exit_code == 0, shown.output
    assert "paper: baseline" in shown.stdout
    assert "1 of 1" in shown.stdout
    told = json.loads(CliRunner().invoke(app, [*call, "--json"]).stdout)
    assert told["runs"] == 1
    assert set(told["trials"]["2"]["rows"]) == {"geometric, kick"}


@pytest.mark.parametrize(
    "wrong", [["--preset", "mars"], ["--realism", "dreamy"], ["--only", "nobody"], ["--runs", "0"]]
)
def test_what_there_is_not_is_said(wrong: list[str]) -> None:
    refused = CliRunner().invoke(app, ["paper", "table4", "--runs", "1", *wrong])
    assert refused.exit_code == 2
