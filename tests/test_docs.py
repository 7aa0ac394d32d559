"""The site has every page of docs, its commands work, and it is built without a warning."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import robobt
from robobt.cli import app
from robobt.config.yaml import read_yaml
from robobt.plays import PLAYS
from tests.registries import temporarily

ROOT = Path(__file__).parent.parent
INDEX = (ROOT / "docs" / "index.md").read_text()


def pages(nav: list[Any]) -> set[str]:
    found: set[str] = set()
    for entry in nav:
        for value in entry.values():
            found |= pages(value) if isinstance(value, list) else {value}
    return found


def test_every_page_is_in_the_sites_contents() -> None:
    named = pages(read_yaml(ROOT / "mkdocs.yml")["nav"])
    written = {path.name for path in (ROOT / "docs").glob("*.md")}
    assert {page for page in named if not page.startswith("reference/")} == written


def test_the_citation_is_of_this_version() -> None:
    assert read_yaml(ROOT / "CITATION.cff")["version"] == robobt.__version__


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*.md")), ids=lambda page: page.stem)
def test_a_link_leads_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text()):
        made = target.startswith("reference/")  # by mkdocs_hooks.py
        assert made or target.startswith("https://") or (page.parent / target).exists(), target


@pytest.mark.integration
def test_ones_own_play_is_looked_at_and_played(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```(\w+)\n(.*?)```", INDEX, re.DOTALL)
    (python,) = [block for kind, block in blocks if kind == "python"]
    Path("my_play.py").write_text(python)
    lines = [line for kind, block in blocks if kind == "sh" for line in block.splitlines()]
    commands = [shlex.split(line)[1:] for line in lines if line.startswith("robobt ")]
    assert len(commands) == 3
    with temporarily(PLAYS):
        for command in commands:
            done = CliRunner().invoke(app, command)
            assert done.exit_code == 0, done.output


@pytest.mark.integration
def test_the_python_about_environments_runs() -> None:
    scope: dict[str, Any] = {}
    for block in re.findall(
        r"```python\n(.*?)```", (ROOT / "docs" / "environments.md").read_text(), re.DOTALL
    ):
        exec(block, scope)
    env = scope["env"]
    env.reset(seed=0)
    before = env.before
    _, reward, terminated, _, _ = env.step(env.action_space.sample())
    assert not terminated
    assert -0.1 < reward < 0.0 == before.sum()


@pytest.mark.integration
def test_two_play_against_two_on_a_small_field(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "scenarios.md").read_text().partition("## Two against two")[2]
    (tmp_path / "small.yaml").write_text(re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)[0])
    scenario = robobt.load_scenario(tmp_path / "small.yaml")
    assert (scenario.field.length, len(scenario.robots.blue)) == (6.0, 2)
    assert robobt.play_match(scenario.lasting(1.0)).time == pytest.approx(1.0, abs=0.03)


@pytest.mark.slow
def test_the_site_is_built_without_a_warning_and_asks_no_outside_address(tmp_path: Path) -> None:
    pytest.importorskip("mkdocs", reason='the site needs pip install "robobt[docs]"')
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for page in tmp_path.rglob("*.html"):
        loaded = re.findall(
            r"<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)=\"?(https?://[^\" >]+)", page.read_text()
        )
        assert not [address for address in loaded if "rel=canonical" not in address], page
    assert (tmp_path / "search" / "search_index.json").stat().st_size > 100_000
