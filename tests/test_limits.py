"""A test that hangs fails, says where, and does not keep the others from running."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests import limits

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not hasattr(limits.signal, "SIGALRM"), reason="there is no such signal here"),
]

ROOT = Path(__file__).resolve().parents[1]

WAITS = {
    "a child": "subprocess.run([sys.executable, '-S', '-c', 'import time; time.sleep(600)'])",
    "a queue": "queue.SimpleQueue().get()",
    "a socket": "socket.create_server(('127.0.0.1', 0)).accept()",
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
import pytest, queue, socket, subprocess, sys, threading, time
from tests import limits
limits._LET_GO = 1.0

@pytest.fixture
def waits():
    yield
    threading.Event().wait()
"""


def ran(folder: Path, tests: str) -> subprocess.CompletedProcess[str]:
    """The tests of a file, none of which may take longer than half a second."""
    (folder / "test_hangs.py").write_text(IMPORTS + tests)
    command = [sys.executable, "-m", "pytest", "-p", "tests.limits", "-p", "no:hypothesispytest", "-q"]
    return subprocess.run(
        [*command, "--patience", "0.5", "-c", os.devnull, "--rootdir", str(folder), str(folder)],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_whatever_a_test_waits_for_it_fails_and_the_others_run(tmp_path: Path) -> None:
    tests = [
        f"def test_{number}({'waits' if not wait else ''}):\n    {wait or 'pass'}\n"
        for number, wait in enumerate(WAITS.values())
    ]
    done = ran(tmp_path, "\n".join(tests) + "\ndef test_last(): pass\n")
    assert done.stdout.count("Failed: still running after 0.5 s") == len(WAITS)
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
    done = ran(tmp_path, hangs)
    assert done.returncode == 1
    assert "Timeout" in done.stderr
    assert where in done.stderr
