"""The file on the page about tasks of one's own is trained, killed, resumed, exported and played by name."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import StartPython
from tests.waiting import soon

PAGE = (Path(__file__).parents[3] / "docs" / "own_tasks.md").read_text(encoding="utf-8")
SHORT = (
    "steps=5120 collection.num_envs=32 ppo.num_steps=20 ppo.hidden_sizes=[16] rebuild_every=640 "
    "evaluation.every=2560 evaluation.starts=16 evaluation.held_out=16 checkpoint_seconds=0 tensorboard=false"
)
TRAIN = (
    "-m",
    "robobt",
    "train",
    "my_task.py:BringHome",
    *[part for one in SHORT.split() for part in ("--set", one)],
)

AFTERWARDS = f"""
import sys
from robobt.cli import main
def command(line):
    sys.argv = ["robobt", *line.split()]
    try:
        main()
    except SystemExit as end:
        assert not end.code, line
command("{" ".join(TRAIN[2:])} --out broken --resume --json")
print("---")
command("export broken --name bring_home --out models")
print("---")
play = "--blue my_play.yaml --import my_task.py --set ends.time_limit=2"
command("match striker_vs_goalkeeper " + play + " --trials 1 --json")
"""
"""What is done with what was trained for a while, in one process, which starts sooner than three."""


def block(start: str) -> str:
    found = re.search(rf"(?ms)^```\w+\n({re.escape(start)}.*?)^```", PAGE)
    assert found
    return found[1]


@pytest.mark.integration
def test_a_task_in_ones_own_folder_goes_all_the_way(
    start_python: StartPython, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("my_task.py").write_text(block("# my_task.py"))
    Path("my_play.yaml").write_text(block("# my_play.yaml"))

    def run(*arguments: str) -> str:
        process = start_python(*arguments)
        printed, _ = process.communicate()
        assert process.returncode == 0
        return printed

    # Two seeds in workers of their own, one of which is killed and goes on.
    whole = json.loads(run(*TRAIN, "--seeds", "2", "-w", "2", "--out", "whole", "--json"))
    result = Path("broken/seed_0/result.json")
    # On a busy machine it may have ended before it is killed.
    for _ in range(10):
        shutil.rmtree("broken", ignore_errors=True)
        broken = start_python(*TRAIN, "--out", "broken")
        soon(lambda: Path("broken/seed_0/checkpoint").exists() or broken.poll() is not None)  # noqa: B023
        broken.kill()
        broken.communicate()
        if not result.exists():
            break
    assert not result.exists()
    file = Path("my_task.py")
    file.write_text(file.read_text().replace("0.3 *", "0.4 *"))
    command = (sys.executable, *TRAIN, "--out", "broken", "--resume")
    refused = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "my_task.py, or a module that it imports, has changed since this run began" in refused.stderr
    assert refused.returncode == 1
    file.write_text(block("# my_task.py"))
    trained, _, afterwards = run("-c", AFTERWARDS).split("---\n")
    resumed = json.loads(trained)
    assert resumed["runs"][0]["weights"] == whole["runs"][0]["weights"]
    line = json.loads(Path("broken/seed_0/log.jsonl").read_text().splitlines()[-1])
    assert set(line["terms"]) == {"home", "advance", "approach"}

    played = json.loads(afterwards)
    assert played["trials"] == 1
    observed = run(
        "-c", "import gymnasium; print(gymnasium.make('my_task:BringHome-v0').reset(seed=0)[0].shape)"
    )
    assert observed == "(8,)\n"
