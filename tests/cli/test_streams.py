"""What a command does when nobody reads, or reads on, what it prints."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.waiting import LIMIT

ROBOBT = [sys.executable, "-m", "robobt"]


@pytest.mark.integration
@pytest.mark.parametrize("arguments", [["plays"], ["plays", "--json"]])
def test_a_reader_that_has_enough_is_no_failure(arguments: list[str]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    try:
        ended = subprocess.run([*ROBOBT, *arguments], stdout=writer, stderr=subprocess.PIPE, check=False)
    finally:
        os.close(writer)
    assert (ended.returncode, ended.stderr) == (0, b"")


@pytest.mark.integration
@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_a_stream_that_is_closed_from_the_start_is_no_failure(closed: str) -> None:
    command = " ".join([*ROBOBT, "--version", closed])
    ended = subprocess.run(["sh", "-c", command], capture_output=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, b"")


def test_warnings_are_told_but_not_each_failure_of_a_tree() -> None:
    program = (
        "import logging, sys; from robobt.cli import app;"
        "sys.argv = ['robobt', 'plays']; app(standalone_mode=False);"
        "logging.getLogger('robobt.league.wire.links').warning('two senders');"
        "logging.getLogger('robobt.tree.runner').warning('tree stopped')"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=LIMIT)
    assert done.stderr == "two senders\n"
