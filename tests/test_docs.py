"""What README and docs say to type, import and follow is there."""

from __future__ import annotations

import ast
import os
import re
import shlex
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from typer.core import TyperGroup
from typer.exceptions import TyperException
from typer.main import get_command
from typer.testing import CliRunner

import robobt
from mkdocs_hooks import llms_txt
from robobt.cli import app
from robobt.config.extras import MissingExtraError
from robobt.config.yaml import read_yaml
from robobt.plays import PLAYS
from tests.programs import PROGRAMS, calls_a_program, program_and_words
from tests.registries import temporarily

ROOT = Path(__file__).parent.parent
INDEX = (ROOT / "docs" / "index.md").read_text()
PAGES = {
    str(path.relative_to(ROOT)): path
    for path in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
}
FENCED = re.compile(r"^ *```(\w*)\n(.*?)^ *```", re.DOTALL | re.MULTILINE)
ANCHOR = re.compile(r"[^\w\- ]")
COMMANDS = {name: get_command(made) for name, made in PROGRAMS.items()}


def blocks(page: str, *kinds: str) -> list[str]:
    return [block for found, block in FENCED.findall(PAGES[page].read_text()) if found in kinds]


def typed(page: str) -> list[str]:
    """The lines of its shell blocks that run one of the programs."""
    lines = "\n".join(blocks(page, "sh", "")).replace("\\\n", " ").splitlines()
    return [line.strip() for line in lines if calls_a_program(line)]


def named(page: str) -> list[str]:
    """The commands that its sentences name, often without what they need."""
    text = FENCED.sub("", PAGES[page].read_text())
    spans = [" ".join(span.split()) for span in re.findall(r"`([^`]+)`", text)]
    return [span.removesuffix(" …") for span in spans if calls_a_program(span)]


def take(line: str) -> None:
    """Read a line as its program does, and leave it at that."""
    name, words = program_and_words(line)
    command, context = COMMANDS[name], None
    while isinstance(command, TyperGroup):
        context = command.make_context(name, words, parent=context)
        _, found, words = command.resolve_command(context, [*context._protected_args, *context.args])
        command = found or command
        assert not command.hidden, f"{line}: is not there any more"
    command.make_context(name, words, parent=context)


def unknown_options(name: str, words: list[str]) -> set[str]:
    """The options that the command of a program, named by the first words, does not have."""
    command = COMMANDS[name]
    for word in words:
        if isinstance(command, TyperGroup) and not word.startswith("-"):
            assert word in command.commands, f"there is no command {word!r}"
            command = command.commands[word]
            assert not command.hidden, f"{word!r} is not there any more"
    if command.context_settings.get("ignore_unknown_options"):
        return set()  # a script's, which reads its own
    found = [*command.params, *COMMANDS[name].params]
    given = {word.split("=")[0] for word in words if word.startswith("--")}
    return given.difference(["--help"], *[[*option.opts, *option.secondary_opts] for option in found])


@pytest.mark.parametrize("page", PAGES)
def test_a_command_to_type_is_one_that_the_program_takes(page: str) -> None:
    for line in typed(page):
        try:
            take(line)
        except TyperException as error:
            pytest.fail(f"{line}: {error}")


@pytest.mark.parametrize("page", PAGES)
def test_a_command_that_a_sentence_names_has_these_options(page: str) -> None:
    for span in named(page):
        assert not unknown_options(*program_and_words(span)), span


@pytest.mark.parametrize("page", PAGES)
def test_what_its_python_imports_is_there(page: str) -> None:
    for block in blocks(page, "python"):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith("robobt"):
                try:
                    module = import_module(str(node.module))
                except MissingExtraError as error:
                    pytest.skip(str(error))
                for name in node.names:
                    assert hasattr(module, name.name), f"{node.module} has no {name.name}"


def shown_to_users() -> dict[str, str]:
    """The code of the examples, of the paper's tables, and of README and pages, by where it stands."""
    found = {
        f"{page}, block {number}": block
        for page in PAGES
        for number, block in enumerate(blocks(page, "python"), 1)
    }
    files = [*sorted((ROOT / "examples").glob("*.py")), *sorted((ROOT / "paper").rglob("*.py"))]
    return found | {str(path.relative_to(ROOT)): path.read_text() for path in files}


def imported(code: str) -> set[str]:
    """The modules that code imports from, wherever in it."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom):
            found.add(str(node.module))
        elif isinstance(node, ast.Import):
            found.update(name.name for name in node.names)
    return found


@pytest.mark.parametrize("place", shown_to_users())
def test_users_import_from_robobt_or_one_of_its_rooms(place: str) -> None:
    deep = {name for name in imported(shown_to_users()[place]) if re.fullmatch(r"robobt(\.\w+){2,}", name)}
    assert not deep, "let the room export what is needed from there"


@pytest.mark.parametrize("page", PAGES)
def test_its_links_lead_somewhere(page: str) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", FENCED.sub("", PAGES[page].read_text())):
        made = target.startswith(("reference/", "tutorials/"))  # by mkdocs_hooks.py
        if made or target.startswith(("https://", "http://")):
            continue
        name, _, anchor = target.partition("#")
        path = (PAGES[page].parent / name).resolve() if name else PAGES[page]
        assert path.exists(), target
        if anchor:
            headings = re.findall(r"^#+ (.*)$", FENCED.sub("", path.read_text()), re.MULTILINE)
            assert anchor in [ANCHOR.sub("", text.lower()).replace(" ", "-") for text in headings], target


@pytest.mark.parametrize("place", [*PAGES, "examples/05_train_a_skill.py"])
def test_a_link_to_a_page_that_is_made_says_how_to_make_it(place: str) -> None:
    """In a clone there is no such page."""
    text = " ".join((PAGES.get(place) or ROOT / place).read_text().replace("\n# ", " ").split())
    for after in re.split(r"\]\((?:\.\./)?reference/[^)]+\)", text)[1:]:
        assert "`make docs` builds" in after[:60], place


def pages(nav: list[Any]) -> set[str]:
    found: set[str] = set()
    for entry in nav:
        for value in entry.values():
            found |= pages(value) if isinstance(value, list) else {value}
    return found


def test_every_page_is_in_the_sites_contents() -> None:
    named = pages(read_yaml(ROOT / "mkdocs.yml")["nav"])
    docs = ROOT / "docs"
    written = {str(path.relative_to(docs)) for path in docs.rglob("*.md")}
    written |= {f"tutorials/{path.stem}.md" for path in (ROOT / "examples").glob("*.py")}
    assert {page for page in named if not page.startswith("reference/")} == written


def test_language_models_are_told_of_every_page() -> None:
    site = read_yaml(ROOT / "mkdocs.yml")
    text = llms_txt(site["site_name"], site["site_description"], site["nav"])
    assert text.startswith(
        f"# robobt\n\n> {site['site_description']}\n\n## Start here\n\n- [Start here](index.html)\n"
    )
    linked = re.findall(r"^- \[[^\]]+\]\((\S+)\.html\)$", text, re.MULTILINE)
    assert sorted(linked) == sorted(page.removesuffix(".md") for page in pages(site["nav"]))
    assert [line for line in text.splitlines() if line.startswith("## ")][1:] == [
        f"## {title}" for entry in site["nav"] for title, inside in entry.items() if isinstance(inside, list)
    ]


MEASUREMENTS = [page for page in PAGES if page.startswith("docs/measurements/")]
ROOMS = [
    "world",
    "sim",
    "motion",
    "skills",
    "plays",
    "match",
    "learning",
    "models",
    "shots",
    "league",
    "tournament",
    "tree",
]
MEASURED = re.compile(
    r"Measured \d{4}-\d\d-\d\d at `[0-9a-f]{7,}`; rests on ([a-z]+(?:, [a-z]+)*)\.\n\n```sh\n(.+?)```\n",
    re.DOTALL,
)


@pytest.mark.parametrize("page", MEASUREMENTS)
def test_a_measurement_begins_with_its_date_rooms_and_command(page: str) -> None:
    for section in re.split(r"(?m)^## ", PAGES[page].read_text())[1:]:
        title, _, body = section.partition("\n\n")
        found = MEASURED.match(body)
        assert found, title
        assert set(found[1].split(", ")) <= set(ROOMS), title


def test_the_citation_is_of_this_version() -> None:
    assert read_yaml(ROOT / "CITATION.cff")["version"] == robobt.__version__


@pytest.mark.integration
def test_ones_own_play_is_looked_at_and_played(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    # Workers that play a file's plays are tested beside it.
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0}, raising=False)
    blocks = re.findall(r"```(\w+)\n(.*?)```", INDEX.partition("## 3. ")[0], re.DOTALL)
    (python,) = [block for kind, block in blocks if kind == "python"]
    Path("my_play.py").write_text(python)
    lines = [line for kind, block in blocks if kind == "sh" for line in block.splitlines()]
    commands = [shlex.split(line)[1:] for line in lines if line.startswith("robobt ")]
    assert len(commands) == 4
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
