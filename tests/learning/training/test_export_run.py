"""A finished run becomes a model whose card says where it comes from and what it can do."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from robobt import __version__
from robobt.cli import app
from robobt.config.commit import source_commit
from robobt.learning.training.export_run import export_run, held_out
from robobt.learning.training.results import Evaluation
from robobt.learning.training.run_folder import RunFolderError, load_run
from robobt.learning.training.settings import load_settings
from robobt.learning.training.train import train
from robobt.models.file import ModelError, read_model_file
from robobt.models.policy import load_policy
from robobt.skills import GoToBall, LearnedSkill, Shoot

TINY = {
    "steps": 512,
    "seed": 3,
    "tensorboard": False,
    "collection.random_steps": 128,
    "agent.hidden_sizes": [8],
    "evaluation.every": 256,
    "evaluation.starts": 4,
    "evaluation.held_out": 20,
    "rebuild_every": 256,
    "environment": {"time_limit": 40, "period": 0.025, "simulator": "grsim"},
}


@pytest.fixture(scope="module", params=["go_to_ball", "shoot"])
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / str(request.param)
    train(load_settings(str(request.param), "fast", TINY), folder)
    return folder


@pytest.mark.integration
def test_the_card_tells_the_whole_run(run: Path, tmp_path: Path) -> None:
    (path,) = export_run(run, folder=tmp_path)
    task = run.name
    card = read_model_file(path).card
    result = load_run(run)
    assert path == tmp_path / f"{task}_ddpg.pt"
    assert card.skill == {"go_to_ball": "GoToBall", "shoot": "Shoot"}[task]
    assert card.observation.name == task
    assert card.environment == result.settings.environment.model_dump(mode="json")
    assert card.action is not None
    assert card.action == result.settings.environment.action
    assert card.period == 0.025
    assert card.limits is not None
    assert card.limits.max_speed == 5.0
    assert card.seed == 3
    assert card.code_version == __version__
    assert card.code_commit == source_commit()
    assert card.created_by.startswith(f"robobt export {__version__}")
    assert card.training["settings"]["agent"]["hidden_sizes"] == [8]
    assert card.training["figures"]["steps"] == result.figures["steps"]
    success, figures = card.held_out["success"], result.figures["held_out"]
    assert (success.value, success.low, success.high, success.n) == (
        figures["success"],
        figures["low"],
        figures["high"],
        20,
    )


@pytest.mark.integration
def test_the_exported_policy_is_the_runs_best_actor(run: Path, tmp_path: Path) -> None:
    from robobt.learning.agents.networks import policy_of

    inputs = np.random.default_rng(1).normal(0.0, 2.0, (100, 6 if run.name == "go_to_ball" else 10))
    wanted = policy_of(load_run(run).actor)(inputs)
    for path in export_run(run, "both", tmp_path, ("torchscript", "onnx"), starts=5):
        np.testing.assert_allclose(load_policy(path)(inputs), wanted, atol=1e-6)


@pytest.mark.integration
def test_it_is_a_skill_at_once(run: Path, tmp_path: Path) -> None:
    (path,) = export_run(run, "mine", tmp_path, starts=5)
    leaf = GoToBall if run.name == "go_to_ball" else Shoot
    assert leaf(policy=str(path)).policy == str(path)
    assert LearnedSkill(model=str(path)).model == str(path)


def test_of_several_seeds_the_best_is_taken(run: Path, tmp_path: Path) -> None:
    (tmp_path / "seed_7").symlink_to(run)
    (tmp_path / "result.json").write_text('{"best_seed": 7}')
    (path,) = export_run(tmp_path, "best", tmp_path / "models", starts=5)
    assert read_model_file(path).card.seed == 3


def test_a_folder_that_holds_no_finished_run_is_one_error(tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match="not the folder of a run that has ended"):
        export_run(tmp_path)
    with pytest.raises(RunFolderError, match="there is no such folder"):
        export_run(tmp_path / "nothing")


@pytest.mark.parametrize("name", ["bad name", "../mine", "mine.pt", "x" * 65])
def test_a_name_that_is_none_is_one_error(run: Path, tmp_path: Path, name: str) -> None:
    with pytest.raises(ModelError, match="is no name for a model"):
        export_run(run, name, tmp_path, starts=5)
    assert list(tmp_path.iterdir()) == []


def test_held_out_figures_carry_their_intervals() -> None:
    success = np.array([True, True, True, False])
    times = np.array([1.0, 2.0, 3.0, np.nan])
    figures = held_out(Evaluation(success, times, np.array([1.0, 1.5, 2.5, 1.0]), np.zeros(4)))
    assert figures["success"].value == 0.75
    assert figures["time"].value == 2.0
    assert figures["time"].n == 3
    assert figures["time_ratio"].value == pytest.approx(6.0 / 5.0)
    for one in figures.values():
        assert one.low is not None
        assert one.high is not None
        assert one.low < one.value < one.high
    few = held_out(Evaluation(success[:2], np.array([0.1, 1.9]), np.array([0.1, 1.0]), np.zeros(2)))
    assert few["time"].low == few["time_ratio"].low == 0.0
    nothing = held_out(Evaluation(~success & success, times * np.nan, times * np.nan, np.zeros(4)))
    assert list(nothing) == ["success"]


@pytest.mark.integration
def test_the_commands_write_list_and_show_models(run: Path, tmp_path: Path) -> None:
    def robobt(*arguments: str, code: int = 0) -> str:
        done = CliRunner().invoke(app, list(arguments))
        assert done.exit_code == code, done.output
        return done.output

    out = str(tmp_path / "models")
    written = json.loads(robobt("export", str(run), "--name", "mine", "--onnx", "--out", out, "--json"))
    assert [file["format"] for file in written["files"]] == ["torchscript", "onnx"]
    assert all(file["listed"] for file in written["files"])
    assert "--force" in robobt("export", str(run), "--name", "mine", "--out", out, code=1)
    again = robobt("export", str(run), "--name", "mine", "--onnx", "--out", out, "--force")
    assert "held-out result" in again
    robobt("export", str(run), "--name", "beside")
    assert (run / "beside.pt").is_file()
    listed = json.loads(robobt("list", "models", "--path", out, "--json"))
    own = [file for file in listed["models"] if file["card"]["name"] == "mine"]
    assert own == [written["files"][1], written["files"][0]]
    assert listed["problems"] == []
    assert "mine" in robobt("list", "models", "--path", out)
    shown = robobt("show", str(tmp_path / "models" / "mine.pt"))
    assert "sin_" in shown
    assert f"robobt {__version__}, commit {source_commit() or 'unknown'}" in shown
    assert f"robobt {__version__}, commit unknown" in robobt("show", "go_to_ball_ddpg")
    (tmp_path / "models" / "mine.pt").write_bytes(b"broken")
    assert "manifest" in robobt("list", "models", "--path", out, code=1)
    listed = robobt("list", "models", "--path", out, "--json", code=1).partition("\nrobobt")[0]
    assert "manifest" in json.loads(listed)["problems"][0]
