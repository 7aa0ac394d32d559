"""uv's lock file says the same as pyproject.toml and constraints.txt, and names public addresses only."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
EXTRAS: dict[str, list[str]] = PROJECT["project"]["optional-dependencies"]
LOCK_TEXT = (ROOT / "uv.lock").read_text()
LOCK = tomllib.loads(LOCK_TEXT)
PUBLIC = {"pypi.org", "files.pythonhosted.org", "download.pytorch.org", "download-r2.pytorch.org"}


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def spelled_out(lines: list[str]) -> Iterator[Requirement]:
    """Each requirement, with what an extra of robobt's own stands for in its place."""
    for one in map(Requirement, lines):
        if one.name == "robobt":
            for extra in one.extras:
                yield from spelled_out(EXTRAS[extra])
        else:
            yield one


def packages(name: str) -> list[dict[str, Any]]:
    return [package for package in LOCK["package"] if normal(package["name"]) == name]


def test_every_tested_version_is_the_locked_one() -> None:
    pins = dict(
        line.split("==") for line in (ROOT / "constraints.txt").read_text().split("\n") if "==" in line
    )
    assert len(pins) > 100
    for name, version in pins.items():
        locked = {package["version"].removesuffix("+cpu") for package in packages(normal(name))}
        assert version in locked, f"{name}: uv.lock has {locked or 'none'}; run uv lock"


def test_it_was_made_from_these_dependencies() -> None:
    (own,) = packages("robobt")
    locked = {
        (
            normal(one["name"]),
            frozenset(one.get("extras", ())),
            frozenset(one.get("specifier", "").split(",")),
            re.sub(r"extra == '(\w+)'", r"\1", one.get("marker", "")),
        )
        for one in own["metadata"]["requires-dist"]
    }
    asked = set()
    for extra, lines in {"": PROJECT["project"]["dependencies"], **EXTRAS}.items():
        for one in spelled_out(lines):
            named = (normal(one.name), frozenset(one.extras), frozenset(str(one.specifier).split(",")), extra)
            asked.add(named)
    assert locked == asked, "run uv lock"


@pytest.mark.parametrize("platform", ["linux", "win32", "darwin"])
def test_every_platform_gets_pytorchs_cpu_build(platform: str) -> None:
    cpu = "https://download.pytorch.org/whl/cpu"
    assert PROJECT["tool"]["uv"]["index"] == [{"name": "pytorch-cpu", "url": cpu, "explicit": True}]
    assert {package["source"]["registry"] for package in packages("torch")} == {cpu}
    # Apple's build has no other name, for it never has CUDA.
    pinned = re.findall(r"^torch==(.+)$", (ROOT / "constraints.txt").read_text(), re.MULTILINE)[0]
    version = pinned if platform == "darwin" else f"{pinned}+cpu"
    (locked,) = [package for package in packages("torch") if package["version"] == version]
    part = {"linux": "manylinux", "win32": "win_amd64", "darwin": "macosx"}[platform]
    wheels = [wheel for wheel in locked["wheels"] if part in wheel["url"]]
    assert len(wheels) >= 3
    assert all(wheel["hash"].startswith("sha256:") for wheel in wheels)


def test_it_names_public_addresses_only() -> None:
    addresses = {urlsplit(url).hostname for url in re.findall(r'"(\w+://[^"]+)"', LOCK_TEXT)}
    assert addresses == PUBLIC
