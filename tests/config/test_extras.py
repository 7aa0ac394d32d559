"""What a light installation lacks is named with the extra that brings it."""

from __future__ import annotations

import json
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
import importlib.abc, json, sys
class Without(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {set(EXTRAS)!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Without())
from robobt.cli import main
for command in json.loads(sys.argv[1]):
    sys.argv = ["robobt", *command.split()]
    try:
        main()
    except SystemExit as end:
        print(chr(0), end.code or 0, file=sys.stderr)
"""


def light(*commands: str) -> list[tuple[str, int]]:
    """Run commands one after the other in one process; what each prints as an error, and its exit status."""
    done = subprocess.run(
        [sys.executable, "-c", LIGHT, json.dumps(commands)], capture_output=True, text=True, check=True
    )
    errors = re.findall(r"(.*?)\0 (\d+)\n", done.stderr, re.DOTALL)
    assert len(errors) == len(commands), done.stderr
    return [(error, int(status)) for error, status in errors]


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
    ((error, status),) = light("match striker_vs_goalkeeper --trials 1 --json")
    assert status == 0, error


@pytest.mark.integration
def test_what_it_cannot_do_names_the_extra(tmp_path: Path) -> None:
    extras = {
        f"match striker_vs_goalkeeper --trials 1 --record {tmp_path / 'x.html'}": "record",
        "train go_to_ball": "learn",
        "serve striker_vs_goalkeeper --seconds 1": "league",
        "shots collect --count 1 --out x.parquet": "shots",
        "match six_v_six --live": "live",
        "tournament run team_player field_player": "tournament",
    }
    for (command, extra), (error, status) in zip(extras.items(), light(*extras), strict=True):
        assert status == 1, command
        assert f'pip install "robobt[{extra}]"' in error
        assert error.count("\n") == 1


def test_only_a_missing_package_of_an_extra_is_explained() -> None:
    assert missing_extra(ModuleNotFoundError("x", name="my_own")) is None
    assert missing_extra(ValueError("x")) is None
    assert "scikit-learn" in str(missing_extra(ModuleNotFoundError("x", name="sklearn.svm")))
    with pytest.raises(MissingExtraError, match=r"needs no_such_package.*robobt\[shots\]"):
        need("shots", "no_such_package.inner")
    need("shots", "sklearn")
