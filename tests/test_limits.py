"""A test that hangs fails where it hangs, and one that is only slow, on a busy machine, does not."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests import limits
from tests.waiting import LIMIT

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not hasattr(limits.signal, "SIGALRM"), reason="there is no such signal here"),
]

ROOT = Path(__file__).resolve().parents[1]

WAITS = {
    "a child": "subprocess.run([sys.executable, '-S', '-c', 'import time; time.sleep(600)'])",
    "a queue": "queue.SimpleQueue().get()",
    "a loop": "while True: pass",
    "a fixture": "",
}
SWALLOWS = """
    while True:
        try:
            time.sleep(600)
        except BaseException: pass
"""
IMPORTS = """
import pytest, queue, subprocess, sys, threading, time
from tests import limits

@pytest.fixture
def waits():
    yield
    threading.Event().wait()
"""


def ran(folder: Path, tests: str) -> subprocess.CompletedProcess[str]:
    """The tests of a file, none of which may take longer than a second."""
    (folder / "test_hangs.py").write_text(IMPORTS + tests)
    # Under CI pytest repeats each reason in its summary.
    environment = {name: value for name, value in os.environ.items() if name not in ("CI", "BUILD_NUMBER")}
    command = [sys.executable, "-m", "pytest", "-p", "tests.limits", "-p", "no:hypothesispytest", "-q"]
    return subprocess.run(
        [*command, "--patience", "1", "-c", os.devnull, "--rootdir", str(folder), str(folder)],
        env={**environment, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=LIMIT,
        check=False,
    )


def test_whatever_a_test_waits_for_it_fails_and_the_others_run(tmp_path: Path) -> None:
    tests = [
        f"def test_{number}({'waits' if not wait else ''}):\n    {wait or 'pass'}\n"
        for number, wait in enumerate(WAITS.values())
    ]
    done = ran(tmp_path, "\n".join(tests) + "\ndef test_last(): pass\n")
    assert done.stdout.count("Failed: still running after 1 s") == len(WAITS)
    assert "2 passed" in done.stdout
    assert (done.returncode, done.stderr) == (1, "")


@pytest.mark.parametrize(
    ("hangs", "where"),
    [
        (f"def test_hangs():{SWALLOWS}", "in test_hangs"),
        (
            "def test_leaves_a_thread(): threading.Thread(target=time.sleep, args=(600,)).start()",
            "in _shutdown",
        ),
        ("def test_registers(): import atexit; atexit.register(time.sleep, 600)", "Timeout"),
    ],
    ids=["swallows", "thread", "atexit"],
)
def test_a_process_that_does_not_let_go_is_ended_with_its_stacks(
    hangs: str, where: str, tmp_path: Path
) -> None:
    done = ran(tmp_path, f"limits._LET_GO = 1.0\n{hangs}")
    assert done.returncode == 1
    assert "Timeout" in done.stderr
    assert where in done.stderr


@given(st.sampled_from([0.0, 0.25]))
def test_an_example_of_a_property_may_take_as_long_as_it_needs(seconds: float) -> None:
    time.sleep(seconds)


def test_every_run_tries_the_same_examples_of_a_property() -> None:
    tried: list[str] = []

    @given(st.floats())
    def holds(number: float) -> None:
        tried.append(str(number))

    holds()
    once = tried.copy()
    tried.clear()
    holds()
    assert tried == once
