from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.learning import TASKS
from robobt.learning.training.demonstrations import read_demonstrations
from robobt.learning.training.run_folder import load_run
from tests.learning.tiny import draw_no_curves
from tests.learning.training.test_seeds import SHORT
from tests.registries import temporarily

OPTIONS = [part for name, value in SHORT.items() for part in ("--set", f"{name}={json.dumps(value)}")]


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.mark.integration
def test_a_run_is_trained_resumed_and_told(tmp_path):
    told = run("train", "go_to_ball", *OPTIONS, "--out", tmp_path / "run", "--json")
    assert told.exit_code == 0, told.output
    figures = json.loads(told.stdout)
    assert figures["runs"][0]["held_out"]["starts"] == 4
    assert figures["together"]["seeds"] == [0]
    assert load_run(tmp_path / "run" / "seed_0").figures["weights"] == figures["runs"][0]["weights"]
    again = run("train", "go_to_ball", *OPTIONS, "--out", tmp_path / "run", "--resume")
    assert again.exit_code == 0
    assert "held-out success" in again.output
    refused = run("train", "go_to_ball", *OPTIONS, "--out", tmp_path / "run")
    assert refused.exit_code == 1
    assert "holds a run already" in refused.output


@pytest.mark.integration
def test_the_seed_of_the_settings_is_the_first_unless_another_is_asked_for(tmp_path, monkeypatch):
    draw_no_curves(monkeypatch)
    own = run("train", "go_to_ball", *OPTIONS, "--set", "seed=7", "--out", tmp_path / "own", "--json")
    assert json.loads(own.stdout)["together"]["seeds"] == [7]
    asked = run(
        "train", "go_to_ball", *OPTIONS, "--set", "seed=7", "--seed", 0, "--out", tmp_path / "a", "--json"
    )
    assert json.loads(asked.stdout)["together"]["seeds"] == [0]


def test_a_task_that_a_file_registers_is_found_by_its_name(tmp_path, monkeypatch):
    mine = tmp_path / "mine.py"
    mine.write_text(
        "from robobt.learning import TASKS, GoToBallTask\n\n\n"
        "@TASKS.register('my_go_to_ball')\nclass Mine(GoToBallTask):\n    name = 'my_go_to_ball'\n"
    )
    trained = []

    def train_seeds(settings, seeds, *_):
        trained.append((settings.task, [*seeds]))
        return []

    monkeypatch.setattr("robobt.learning.training.train.train_seeds", train_seeds)
    with temporarily(TASKS):
        told = run("train", "my_go_to_ball", "--import", mine, "--out", tmp_path / "run")
    assert told.exit_code == 0, told.output
    assert trained == [("my_go_to_ball", [0])]


@pytest.mark.integration
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["train", "dance"], "no task is called 'dance'"),
        (["train", "shoot", "--preset", "slow"], "no preset of shoot is called 'slow'"),
        (["train", "shoot", "--set", "agent.tau=7"], "agent.tau"),
        (["train", "shoot", "--set", "tau"], "name=value"),
        (["record", "demonstrations", "shoot", "--by", "magic", "--out", "x"], "skill or script"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(arguments, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told = run(*arguments)
    assert told.exit_code != 0
    assert said in " ".join(told.output.split())
    assert list(tmp_path.iterdir()) == []


def test_demonstrations_are_recorded_by_one_command(tmp_path):
    told = run(
        "record", "demonstrations", "shoot", "--episodes", 5, "--out", tmp_path / "d.parquet", "--json"
    )
    assert told.exit_code == 0, told.output
    figures = json.loads(told.stdout)
    assert figures["episodes"] == 5
    recorded = read_demonstrations(tmp_path / "d.parquet")
    assert len(recorded) == figures["steps"]
    assert recorded.about["teacher"] == "skill"
    spoken = run(
        "record", "demonstrations", "shoot", "--episodes", 2, "-o", tmp_path / "e.parquet", "--by", "script"
    )
    assert "2 episodes" in spoken.output
