"""A match that is killed at any moment leaves a recording and results to go on from."""

from __future__ import annotations

import json
import os
import random
import signal
import time
from pathlib import Path

import pytest

from robobt.cli import app
from robobt.match import load_scenario, run_trials_in
from robobt.match.recording import RecordingError, load_recording
from robobt.worlds import sim_world
from tests.campaign import count

TRIALS = 4


def play(out: Path, recording: Path) -> None:
    options = f"--trials {TRIALS} --workers 1 --record-trial 0 --json --record".split()
    app(
        ["match", "striker_vs_goalkeeper", *options, str(recording), "--out", str(out)], standalone_mode=False
    )


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_match_killed_at_random_moments_can_be_taken_up_again(tmp_path: Path) -> None:
    rng, recorded, taken_up = random.Random(23), 0, 0
    scenario = load_scenario("striker_vs_goalkeeper")
    begun = time.monotonic()
    wanted = run_trials_in(scenario, sim_world, TRIALS).summary().trace
    whole = time.monotonic() - begun
    for number in range(count(200)):
        out, recording = tmp_path / f"{number}.jsonl", tmp_path / f"{number}.robobt.arrows"
        child = os.fork()
        if child == 0:
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, 1)
            os.dup2(null, 2)
            try:
                play(out, recording)
            finally:
                os._exit(0)
        time.sleep(rng.uniform(0.0, whole * 1.5))
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        if recording.exists():
            try:
                recorded += len(load_recording(recording)) > 0
            except RecordingError as error:
                said = str(error)
                assert said.endswith(("is empty", "is cut off inside its header"))
        if out.exists() and out.stat().st_size:
            lines = out.read_bytes().splitlines(keepends=True)
            taken_up += len(lines) > 1
            for line in lines[: -1 if not lines[-1].endswith(b"\n") else None]:
                json.loads(line)
        assert run_trials_in(scenario, sim_world, TRIALS, out=out).summary().trace == wanted
    assert recorded
    assert taken_up
    print(f"of {count(200)}, {recorded} left a recording and {taken_up} results")
