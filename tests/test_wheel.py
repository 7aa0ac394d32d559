"""The wheel is complete: unpacked outside the checkout it plays the bundled scenarios."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    built = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(built)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (wheel,) = built.glob("robobt-*.whl")
    target = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(target)
    return target


def run(unpacked: Path, where: Path, code: str) -> str:
    environment = dict(os.environ, PYTHONPATH=str(unpacked))
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=where, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.integration
def test_it_carries_types_scenarios_and_models(unpacked: Path) -> None:
    assert (unpacked / "robobt" / "py.typed").exists()
    assert list((unpacked / "robobt" / "_data" / "scenarios").glob("*.yaml"))
    assert (unpacked / "robobt" / "_data" / "models" / "README.md").exists()
    assert not (unpacked / "tests").exists()


@pytest.mark.integration
def test_it_plays_a_bundled_scenario_outside_the_checkout(unpacked: Path, tmp_path: Path) -> None:
    found = run(unpacked, tmp_path, "import robobt; print(robobt.__file__)")
    assert found.startswith(str(unpacked))
    names = run(unpacked, tmp_path, "from robobt.cli import app; app(['scenarios', '--json'])")
    assert "striker_vs_goalie" in names
    printed = run(
        unpacked,
        tmp_path,
        "from robobt.cli import app; app(['match', 'striker_vs_goalie', '--trials', '1', '--json'])",
    )
    assert printed.startswith("{")
