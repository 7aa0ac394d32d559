"""A script that starts workers wherever it is imported."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import robobt

scenario = robobt.load_scenario("striker_vs_goalkeeper").lasting(0.1)
robobt.run_trials(scenario, 2, workers=2)
"""


@pytest.mark.integration
def test_a_script_without_a_guard_is_told_to_have_one(tmp_path: Path) -> None:
    script = tmp_path / "mine.py"
    script.write_text(SCRIPT)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].endswith('put the script\'s calls under if __name__ == "__main__":')
    assert "freeze_support" not in done.stderr
