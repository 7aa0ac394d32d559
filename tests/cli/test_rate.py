from __future__ import annotations

import json
import shutil

import torch
from typer.testing import CliRunner

from robobt.cli import app
from robobt.config.yaml import write_yaml
from robobt.learning.agents.networks import Actor
from robobt.learning.training.run_folder import ACTOR, PAST, SETTINGS, save_actor
from robobt.learning.training.settings import load_settings


def rate(*arguments):
    return CliRunner().invoke(app, ["evaluate", "--round-robin", *map(str, arguments)])


def test_a_runs_policies_are_rated_beside_scripts(tmp_path):
    settings = load_settings("duel", "fast", {"environment.time_limit": 20})
    run, other = tmp_path / "one" / "seed_0", tmp_path / "two" / "seed_0"
    (run / PAST).mkdir(parents=True)
    (run / SETTINGS).write_text(write_yaml(settings.model_dump(mode="json")))
    for seed in range(4):
        policy = Actor([1.0] * 23, 4, [4], generator=torch.Generator().manual_seed(seed))
        save_actor(policy, run / ACTOR if seed == 3 else run / PAST / f"{seed:010}.pt")
    told = rate(
        run,
        "--past",
        2,
        "--script",
        "attack",
        "--play",
        "attack_main:speed_factor=1.0",
        "--starts",
        3,
        "--json",
    )
    assert told.exit_code == 0, told.output
    found = json.loads(told.stdout)
    assert set(found["ratings"]) == {"after 0", "after 2", "best", "attack", "attack_main:speed_factor=1.0"}
    assert len(found["encounters"]) == 10
    assert found["task"] == "duel"
    for one in found["ratings"].values():
        assert one["low"] < one["elo"] < one["high"]
        assert one["won"] + one["drawn"] + one["lost"] == 4 * 6
    # Folders of one name are two runs, and who is given twice is there once.
    shutil.copytree(run, other)
    told = rate(
        run, other, run, "--past", 0, "--script", "still", "--script", "still", "--starts", 1, "--json"
    )
    assert set(json.loads(told.stdout)["ratings"]) == {f"{run} best", f"{other} best", "still"}
    for arguments, said in (
        ((run, "--script", "dance"), "no script 'dance'"),
        ((run, "--play", "dance"), "dance: play: no play is called 'dance'"),
        ((run, "--play", "attack_main:sped=1"), "attack_main:sped=1: params.sped: attack_main has no such"),
        ((tmp_path / "none",), "none"),
    ):
        refused = rate(*arguments)
        assert refused.exit_code == 1
        assert said in refused.output
