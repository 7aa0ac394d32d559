"""What a light installation lacks is named with the extra that brings it."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from robobt.config.extras import EXTRAS, MissingExtraError, missing_extra, need

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
LIGHT = f"""
import importlib.abc, sys
class Without(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {set(EXTRAS)!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Without())
from robobt.cli import main
main()
"""


def light(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", LIGHT, *command], capture_output=True, text=True, check=False
    )


def test_every_package_is_brought_by_the_extra_that_is_named() -> None:
    extras = PROJECT["optional-dependencies"]
    names = {
        "foxglove_schemas_protobuf": "foxglove-schemas-protobuf",
        "google": "protobuf",
        "mcap_protobuf": "mcap-protobuf-support",
        "PIL": "pillow",
        "sklearn": "scikit-learn",
        "stable_baselines3": "stable-baselines3",
    }
    for package, extra in EXTRAS.items():
        brought = {re.split(r"[\[>=<]", one)[0] for one in extras[extra]}
        assert names.get(package, package) in brought
    base = {re.split(r"[\[>=<]", one)[0] for one in PROJECT["dependencies"]}
    assert not base & {names.get(package, package) for package in EXTRAS}


@pytest.mark.integration
def test_a_light_installation_plays() -> None:
    done = light("match", "striker_vs_goalkeeper", "--trials", "1", "--json")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("command", "extra"),
    [
        ("match striker_vs_goalkeeper --trials 1 --record out/x.html", "record"),
        ("train go_to_ball", "learn"),
        ("serve striker_vs_goalkeeper --seconds 1", "league"),
        ("shots collect --count 1 --out x.parquet", "shots"),
        ("match six_v_six --live", "live"),
        ("tournament run team_player field_player", "tournament"),
    ],
)
def test_what_it_cannot_do_names_the_extra(command: str, extra: str, tmp_path: Path) -> None:
    done = light(*command.replace("out/x.html", str(tmp_path / "x.html")).split())
    assert done.returncode == 1
    assert f'pip install "robobt[{extra}]"' in done.stderr
    assert done.stderr.count("\n") == 1


def test_only_a_missing_package_of_an_extra_is_explained() -> None:
    assert missing_extra(ModuleNotFoundError("x", name="my_own")) is None
    assert missing_extra(ValueError("x")) is None
    assert "scikit-learn" in str(missing_extra(ModuleNotFoundError("x", name="sklearn.svm")))
    with pytest.raises(MissingExtraError, match=r"needs no_such_package.*robobt\[shots\]"):
        need("shots", "no_such_package.inner")
    need("shots", "sklearn")
