"""Files full of integers, divisions, shifts, shapes and loops end, hang or fill no process."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from tests.campaign import count

MEMORY = 500 * 10**6


def tried(kinds: tuple[str, ...], number: int, seed: int) -> list[dict[str, int]]:
    """Outcomes of files of each kind, each loaded and run in a process of its own, once all are in order."""
    command = [sys.executable, "-m", "tests.models.checks.trials", *kinds, "--count", str(number)]
    done = subprocess.run([*command, "--seed", str(seed)], capture_output=True, text=True, check=True)
    print(done.stdout)
    outcomes = []
    for line in done.stdout.splitlines():
        told = json.loads(line)
        assert set(told["outcomes"]) <= {"loaded", "loaded, fails on some", "refused"}, told
        assert sum(told["outcomes"].values()) == number
        assert told["memory"] < MEMORY
        outcomes.append(dict(told["outcomes"]))
    return outcomes


@pytest.mark.integration
def test_some_files_from_the_generator() -> None:
    of_torchscript, of_onnx = tried(("torchscript", "onnx"), 12, seed=1)
    assert of_torchscript["loaded"] > 1
    assert of_onnx["loaded"] > 1


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "number"), [("torchscript", 2000), ("onnx", 1000)])
def test_files_from_the_generator_by_the_thousand(kind: str, number: int) -> None:
    # A good share has to be loaded, or their running would measure nothing.
    assert tried((kind,), count(number), seed=44)[0]["loaded"] > 0.2 * count(number)
