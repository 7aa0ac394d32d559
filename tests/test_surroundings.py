"""The tests pass whatever starts them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import LIMIT

pytestmark = pytest.mark.integration

ROOT = Path(__file__).resolve().parents[1]


def passes(test: str, before: str = "", **variables: str) -> bool:
    """Whether a test passes in a process of its own, which a shell starts after a command."""
    done = subprocess.run(
        ["sh", "-c", f'{before} exec "$0" -m pytest --patience {LIMIT} "$1"', sys.executable, test],
        cwd=ROOT,
        env={**os.environ, **variables},
        stdout=subprocess.DEVNULL,
        timeout=2.0 * LIMIT,
        check=False,
    )
    return done.returncode == 0


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a shell of POSIX")
def test_signals_may_be_ignored_as_nohup_and_the_background_of_a_script_have_them() -> None:
    ends = "tests/test_signals.py::test_a_signal_to_terminate_ends_the_block_with_its_own_exit_status"
    assert passes(ends, 'trap "" HUP INT TERM;')


def test_the_environment_may_ask_for_colours_and_a_narrow_terminal() -> None:
    said = "tests/cli/test_cli.py::TestErrors::test_a_missing_scenario_is_named_and_those_there_are"
    assert passes(said, FORCE_COLOR="1", GITHUB_ACTIONS="true", COLUMNS="20")
