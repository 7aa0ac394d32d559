"""What README and docs say to type, import and follow is there."""

from __future__ import annotations

import ast
import re
import shlex
from importlib import import_module
from pathlib import Path

import pytest
from typer.core import TyperGroup
from typer.exceptions import TyperException
from typer.main import get_command

from robobt.cli import app

ROOT = Path(__file__).parent.parent
PAGES = {
    str(path.relative_to(ROOT)): path
    for path in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
}
FENCED = re.compile(r"^ *```(\w*)\n(.*?)^ *```", re.DOTALL | re.MULTILINE)
ANCHOR = re.compile(r"[^\w\- ]")
ROBOBT = get_command(app)


def blocks(page: str, kind: str) -> list[str]:
    return [block for found, block in FENCED.findall(PAGES[page].read_text()) if found == kind]


def typed(page: str) -> list[str]:
    """The lines of its shell blocks that run robobt."""
    lines = "\n".join(blocks(page, "sh")).replace("\\\n", " ").splitlines()
    return [line.strip() for line in lines if re.match(r" *robobt ", line)]


def named(page: str) -> list[str]:
    """The commands that its sentences name, often without what they need."""
    text = FENCED.sub("", PAGES[page].read_text())
    return [" ".join(span.split()) for span in re.findall(r"`(robobt [^`]+)`", text)]


def take(words: list[str]) -> None:
    """Read the words of a command as robobt does, and leave it at that."""
    command, context = ROBOBT, None
    while isinstance(command, TyperGroup):
        context = command.make_context("robobt", words, parent=context)
        _, found, words = command.resolve_command(context, [*context._protected_args, *context.args])
        command = found or command
    command.make_context("robobt", words, parent=context)


def options_of(words: list[str]) -> set[str]:
    """The options of the command that the first words name."""
    command = ROBOBT
    for word in words:
        if isinstance(command, TyperGroup) and not word.startswith("-"):
            assert word in command.commands, f"there is no command {word!r}"
            command = command.commands[word]
    found = [*command.params, *ROBOBT.params]
    return {"--help"}.union(*[[*option.opts, *option.secondary_opts] for option in found])


@pytest.mark.parametrize("page", PAGES)
def test_a_command_to_type_is_one_that_robobt_takes(page: str) -> None:
    for line in typed(page):
        try:
            take(shlex.split(line, comments=True)[1:])
        except TyperException as error:
            pytest.fail(f"{line}: {error}")


@pytest.mark.parametrize("page", PAGES)
def test_a_command_that_a_sentence_names_has_these_options(page: str) -> None:
    for span in named(page):
        words = shlex.split(span.removesuffix(" …"))[1:]
        given = {word.split("=")[0] for word in words if word.startswith("--")}
        assert given <= options_of(words), span


@pytest.mark.parametrize("page", PAGES)
def test_what_its_python_imports_is_there(page: str) -> None:
    for block in blocks(page, "python"):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith("robobt"):
                module = import_module(str(node.module))
                for name in node.names:
                    assert hasattr(module, name.name), f"{node.module} has no {name.name}"


@pytest.mark.parametrize("page", PAGES)
def test_its_links_lead_somewhere(page: str) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", FENCED.sub("", PAGES[page].read_text())):
        if target.startswith(("https://", "http://")):
            continue
        name, _, anchor = target.partition("#")
        path = (PAGES[page].parent / name).resolve() if name else PAGES[page]
        assert path.exists(), target
        if anchor:
            headings = re.findall(r"^#+ (.*)$", FENCED.sub("", path.read_text()), re.MULTILINE)
            assert anchor in [ANCHOR.sub("", text.lower()).replace(" ", "-") for text in headings], target
