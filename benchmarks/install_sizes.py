"""How large each extra is, in an environment that has them all: `python -m benchmarks install_sizes`.

For each extra: what it adds to an installation that has the package itself and the extras named
with it, by the sizes of the files that each distribution lists, compiled ones included.
"""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement

PROJECT = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text())["project"]
EXTRAS: dict[str, list[str]] = PROJECT["optional-dependencies"]


@cache
def needed(name: str, extra: str = "") -> frozenset[str]:
    """Return a distribution, by a name in lower case, and all that it needs."""
    found = {name}
    for line in distribution(name).requires or ():
        one = Requirement(line)
        if one.marker is None or one.marker.evaluate({"extra": extra}):
            found |= all_of(one)
    return frozenset(found)


def all_of(one: Requirement) -> frozenset[str]:
    name = one.name.lower().replace("_", "-")
    return frozenset().union(*[needed(name, extra) for extra in (*one.extras, "")])


def own(lines: list[str]) -> frozenset[str]:
    """Return the distributions of a list of requirements, those of the extras named among them included."""
    found: frozenset[str] = frozenset()
    for one in map(Requirement, lines):
        if one.name == PROJECT["name"]:
            found |= own([line for extra in one.extras for line in EXTRAS[extra]])
        else:
            found |= all_of(one)
    return found


def size(names: frozenset[str]) -> float:
    """Return the size of distributions [MB]."""
    files = [Path(str(file.locate())) for name in names for file in distribution(name).files or ()]
    return sum(file.stat().st_size for file in files if file.is_file()) / 1e6


def main() -> None:
    torch = needed("torch")
    light = own([line for line in PROJECT["dependencies"] if not line.startswith("torch")])
    print(f"{'robobt without PyTorch':24} {size(light):6.0f} MB")
    print(f"{'PyTorch':24} {size(torch - light):6.0f} MB")
    for extra, lines in EXTRAS.items():
        named = [line for line in lines if line.startswith(PROJECT["name"])]
        named = named if named != lines else []  # nothing but other extras: their sum
        try:
            added = own(lines) - own(named) - light - torch
        except PackageNotFoundError as error:
            print(f"{extra:24} {error} is not installed")
            continue
        beside = f" beside {', '.join(sorted(Requirement(named[0]).extras))}" if named else ""
        print(f"{extra:24} {size(added):6.0f} MB{beside}")
