"""The wheel is complete: unpacked outside the checkout it plays the bundled scenarios."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
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


@pytest.mark.slow
@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13"])
def test_it_plays_where_nothing_else_is_installed(version: str, tmp_path: Path) -> None:
    """Without PyTorch, which a match of hand-written skills does not import."""
    python = shutil.which(f"python{version}")
    if python is None or subprocess.run([python, "-c", ""], check=False, capture_output=True).returncode:
        pytest.skip(f"there is no Python {version} here")
    build = [sys.executable, "-m", "hatchling", "build", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,), (_sdist,) = tmp_path.glob("*.whl"), tmp_path.glob("*.tar.gz")
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    light = [one for one in needed if not one.startswith("torch")]
    subprocess.run([python, "-m", "venv", str(tmp_path / "clean")], check=True)
    clean = tmp_path / "clean" / "bin"
    pip = [str(clean / "python"), "-m", "pip", "install", "--quiet"]
    subprocess.run([*pip, "-c", str(ROOT / "constraints.txt"), *light], check=True)
    subprocess.run([*pip, "--no-deps", str(wheel)], check=True)
    outside = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}

    def robobt(*command: str) -> subprocess.CompletedProcess[str]:
        called = [str(clean / "robobt"), *command]
        return subprocess.run(called, cwd=tmp_path, env=outside, capture_output=True, text=True, check=False)

    played = robobt("match", "striker_vs_goalie", "--trials", "1", "--json")
    assert played.returncode == 0, played.stderr
    refused = robobt("match", "striker_vs_goalie", "--trials", "1", "--replay", "x.html")
    assert 'pip install "robobt[record]"' in refused.stderr
    site = next((tmp_path / "clean" / "lib").glob("python*")) / "site-packages"
    own = ("pip", "setuptools")
    size = sum(
        file.stat().st_size
        for file in site.rglob("*")
        if file.is_file() and file.relative_to(site).parts[0] not in own
    )
    assert size < 350e6


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
