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
WITHOUT = """
import json, sys
missing = set(json.loads(sys.argv[1]))
class Without:
    def __init__(self, finder):
        self.finder = finder
    def find_spec(self, name, *others):
        return None if name.partition(".")[0] in missing else self.finder.find_spec(name, *others)
sys.meta_path[:] = [Without(finder) for finder in sys.meta_path]
"""
"""Makes the packages in the first argument look as if they were not installed."""

LIGHT = (
    WITHOUT
    + """
from robobt.cli import main
for command in json.loads(sys.argv[2]):
    sys.argv = ["robobt", *command.split()]
    try:
        main()
    except SystemExit as end:
        print(chr(0), end.code or 0, file=sys.stderr)
"""
)


NAMES = {
    "foxglove_schemas_protobuf": "foxglove-schemas-protobuf",
    "google": "protobuf",
    "mcap_protobuf": "mcap-protobuf-support",
    "PIL": "pillow",
    "sklearn": "scikit-learn",
    "stable_baselines3": "stable-baselines3",
}


def distributions(extra: str) -> set[str]:
    """Return the names of the distributions that an extra installs, those of the extras in it among them."""
    names: set[str] = set()
    for required in PROJECT["optional-dependencies"][extra]:
        if required.startswith("robobt["):
            inner = required.removeprefix("robobt[").rstrip("]").split(",")
            names = names.union(*(distributions(each) for each in inner))
        else:
            names.add(re.split(r"[\[>=<]", required)[0])
    return names


def light(*commands: str, extra: str | None = None) -> list[tuple[str, int]]:
    """Run commands one after the other in one process that has the packages of at most one extra.

    Returns:
        What each command prints as an error, and its exit status.
    """
    there = distributions(extra) if extra else set()
    missing = [package for package in EXTRAS if NAMES.get(package, package) not in there]
    done = subprocess.run(
        [sys.executable, "-c", LIGHT, json.dumps(missing), json.dumps(commands)],
        capture_output=True,
        text=True,
        check=True,
    )
    errors = re.findall(r"(.*?)\0 (\d+)\n", done.stderr, re.DOTALL)
    assert len(errors) == len(commands), done.stderr
    return [(error, int(status)) for error, status in errors]


def test_every_package_is_brought_by_the_extra_that_is_named() -> None:
    for package, extra in EXTRAS.items():
        assert NAMES.get(package, package) in distributions(extra)
    base = {re.split(r"[\[>=<]", one)[0] for one in PROJECT["dependencies"]}
    assert not base & {NAMES.get(package, package) for package in EXTRAS}


@pytest.mark.integration
def test_a_light_installation_plays() -> None:
    ((error, status),) = light("match striker_vs_goalkeeper --trials 1 --json")
    assert status == 0, error


@pytest.mark.integration
@pytest.mark.parametrize(
    ("extra", "commands"),
    [
        (
            "record",
            [
                "match striker_vs_goalkeeper --trials 1 --record {0}/x.html",
                "match striker_vs_goalkeeper --trials 1 --record {0}/m.robobt.arrows",
                "record export {0}/m.robobt.arrows --out {0}/m.parquet",
                "what-if {0}/m.robobt.arrows --at 2 --trials 2 --seconds 0.1",
            ],
        ),
        ("league", ["serve striker_vs_goalkeeper --seconds 0.1"]),
        ("shots", ["shots collect --count 1 --out {0}/x.parquet"]),
        ("learn", ["evaluate go_to_ball_ddpg --starts 1"]),
        (
            "tournament",
            [
                "tournament run attack_main attack_nn --scenario duel --set ends.time_limit=0.5 --rounds 1 "
                "--workers 0 --out {0}/t.sqlite",
                "match striker_vs_goalkeeper --trials 1 --set ends.time_limit=3 --record {0}/m.robobt.arrows",
                "record identify {0}/m.robobt.arrows --out {0}/field.yaml",
            ],
        ),
    ],
)
def test_an_extra_brings_all_that_its_commands_need(extra: str, commands: list[str], tmp_path: Path) -> None:
    for error, status in light(*(command.format(tmp_path) for command in commands), extra=extra):
        assert status == 0, error


def test_a_name_that_needs_an_extra_says_which() -> None:
    code = (
        WITHOUT
        + """
import pkgutil
from importlib import import_module
import robobt
from robobt.config.extras import MissingExtraError
said = {}
for found in pkgutil.walk_packages(robobt.__path__, "robobt.", onerror=lambda name: None):
    if not found.ispkg:
        continue
    try:
        package = import_module(found.name)
        for name in getattr(package, "_HOMES", ()):
            try:
                getattr(package, name)
            except MissingExtraError as error:
                said[f"{found.name}.{name}"] = str(error)
    except MissingExtraError as error:
        said[found.name] = str(error)
print(json.dumps(said))
"""
    )
    done = subprocess.run(
        [sys.executable, "-c", code, json.dumps([name for name in EXTRAS if name != "pyarrow"])],
        capture_output=True,
        text=True,
        check=True,
    )
    said = json.loads(done.stdout)
    for name, extra in {
        "robobt.live.Live": "live",
        "robobt.tournament.play_tournament": "tournament",
        "robobt.tournament.standings_of": "tournament",
        "robobt.learning": "learn",
        "robobt.shots": "shots",
        "robobt.league.wire": "league",
    }.items():
        assert f"robobt[{extra}]" in said.get(name, said.get(name.rpartition(".")[0], "")), name
    assert "robobt.what_if" not in said


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
