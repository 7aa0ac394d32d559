"""``robobt evaluate``: policies on fresh starts."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app
from robobt.config.resources import models_folder

pytestmark = pytest.mark.integration


def evaluate(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["evaluate", *map(str, arguments)])


def test_a_model_is_judged_beside_the_skill_and_the_script_on_the_same_starts() -> None:
    done = evaluate("go_to_ball_ddpg", "--starts", 20, "--seed", 3, "--json")
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert (said["task"], said["starts"], said["seed"]) == ("go_to_ball", 20, 3)
    assert list(said["results"]) == ["go_to_ball_ddpg", "skill", "script"]
    for one in said["results"].values():
        assert one["successes"] == 20
        assert one["low"] <= one["success"] <= one["high"]
        assert one["time_ratio"] > 1.0
    other = json.loads(evaluate("go_to_ball_ddpg", "--starts", 20, "--seed", 4, "--json").stdout)
    assert other["results"]["script"]["mean_time"] != said["results"]["script"]["mean_time"]


def test_it_is_printed_as_a_table() -> None:
    printed = evaluate("shoot_ddpg", "--starts", 5).stdout
    assert "shoot_ddpg" in printed
    assert "5 of 5" in " ".join(printed.split())


def test_policies_of_two_tasks_are_not_judged_together() -> None:
    done = evaluate("duel_ppo", "save_ppo", "--starts", 2)
    assert done.exit_code == 2
    assert "save_ppo is of the task save, duel_ppo of duel" in " ".join(done.output.split())


def test_a_policy_does_not_take_the_place_of_a_teacher(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copy(models_folder() / "go_to_ball_ddpg.pt", tmp_path / "skill.pt")
    monkeypatch.chdir(tmp_path)
    done = evaluate("skill", "--starts", 2)
    assert done.exit_code == 1
    assert "this name is that of the task's own skill; write ./skill" in " ".join(done.output.split())


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("shot_expected", "is a shot predictor, not a policy"),
        ("nothing", "no model is called 'nothing'"),
        ("nothing", "or the folder of a training run"),
    ],
)
def test_what_is_no_policy_is_told_in_one_line(what: str, said: str) -> None:
    done = evaluate(what, "--starts", 2)
    assert done.exit_code == 1
    assert said in " ".join(done.output.split())
    assert "Traceback" not in done.output
