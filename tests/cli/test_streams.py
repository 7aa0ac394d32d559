"""What a command does when nobody reads, or reads on, what it prints."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

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
