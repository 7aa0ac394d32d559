"""Docstrings, comments, messages and documents avoid phrases that a reader has to read twice.

The phrases belong to one dialect: sentences without a noun for the thing ("what is told of"), idioms of no
other project ("so many" for "this many") and archaic words. Refused is the phrase, not the thought: name the
thing, and say it with a verb of the field (report, print, restart, target, detection).
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
CODE = ("robobt", "benchmarks", "paper")

UNCHECKED = ()
"""Beginnings of paths of code that is not checked; empty once all of it passes."""

DOCUMENTS = ("README.md", "CONTRIBUTING.md", "docs/**/*.md")
"""Documents that are checked, as patterns; with "docs/**/*.md" once all of those pass."""

REFUSED = {
    "likewise": r"\blikewise\b",
    "the same of": r"\bthe same of\b|\bof the same\b(?! *[\w`:]| *$)",
    "told of": r"\btold of\b|\btells? of\b",
    "is told": r"\b(is|are|was|were|be|been) told\b(?! to\b)",
    "so many": r"\bso (many|much)\b",
    "is from before": r"\b(is|are|was|were) from before\b",
    "anew": r"\banew\b",
    "wherein": r"\b(where|there)(in|of|upon|by)\b(?<!thereby)",
    "as it likes": r"\bas (it|they) likes?\b",
    "what is left of": r"\bwhat is left of\b",
    "the one of the other": r"\bthe one of the other\b",
    "for it is": r", for (it|they|there|that|this) (is|are|was|were)\b",
}
"""Refused phrases, by their names in failures, as patterns."""

ANY = re.compile("|".join(REFUSED.values()), re.IGNORECASE)


def refused(text: str) -> list[str]:
    """Return the names of the refused phrases in a text."""
    line = " ".join(text.split())
    if not ANY.search(line):
        return []
    return [name for name, pattern in REFUSED.items() if re.search(pattern, line, re.IGNORECASE)]


def strings(source: str) -> Iterator[tuple[int, str]]:
    """Yield the string literals of a module that are docstrings or messages, with their lines."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            yield node.lineno, node.value


def comments(source: str) -> Iterator[tuple[int, str]]:
    """Yield the comments of a module, joined over adjacent lines, with the line of each one's end."""
    end, text = -1, ""
    for number, line in enumerate(source.splitlines(), 1):
        # A "#" in a string counts as one too, which is read as a string besides.
        _, sign, comment = line.partition("#")
        if sign:
            if number != end + 1:
                yield end, text
                text = ""
            end, text = number, f"{text} {comment.lstrip('#:')}"
    yield end, text


def prose(document: str) -> Iterator[tuple[int, str]]:
    """Yield the paragraphs of a Markdown document, without code and quoted text, with their lines."""
    without = re.sub(
        r"^(```|~~~).*?^\1", lambda block: "\n" * block[0].count("\n"), document, flags=re.M | re.S
    )
    line = 1
    for paragraph in re.split(r"(\n\s*\n)", without):
        shown = re.sub(r"`[^`]*`|\"[^\"]*\"|“[^”]*”|^\s*>.*$", "", paragraph, flags=re.M)
        if shown.strip():
            yield line, shown
        line += paragraph.count("\n")


def found(path: Path) -> list[str]:
    """Return where a file has refused phrases, as "path:line: phrase"."""
    text = path.read_text(encoding="utf-8")
    parts = prose(text) if path.suffix == ".md" else [*strings(text), *comments(text)]
    name = path.relative_to(ROOT).as_posix()
    return [f"{name}:{line}: {phrase}" for line, part in parts for phrase in refused(part)]


def code() -> Iterator[Path]:
    for folder in CODE:
        for path in sorted((ROOT / folder).rglob("*.py")):
            name = path.relative_to(ROOT).as_posix()
            if not name.startswith(UNCHECKED) and not name.endswith("_pb2.py"):
                yield path


def test_code_says_nothing_in_refused_phrases() -> None:
    paths = list(code())
    assert len(paths) > 500
    assert [place for path in paths for place in found(path)] == []


def test_documents_say_nothing_in_refused_phrases() -> None:
    paths = [path for pattern in DOCUMENTS for path in sorted(ROOT.glob(pattern))]
    assert len(paths) >= len(DOCUMENTS)
    assert [place for path in paths for place in found(path)] == []


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("driven: likewise.", ["likewise"]),
        ("drives: of the same.", ["the same of"]),
        ("Return the same of VMAS.", ["the same of"]),
        ("The cases are told of in the report.", ["told of", "is told"]),
        ("A launch is tried at so\n    many moments.", ["so many"]),
        ("Robots told to stand wait, and two of the same team touch.", []),
        ("All of it is from before, and measured anew.", ["is from before", "anew"]),
        ("It waits, for it is late.", ["for it is"]),
    ],
)
def test_refused_phrases_are_found(text: str, names: list[str]) -> None:
    assert refused(text) == names


def test_comments_are_read_over_their_lines() -> None:
    assert [text for _, text in comments("x = 1  # one of so\n# many\n\n# two\n")][1:] == [
        "  one of so  many",
        "  two",
    ]


def test_quoted_text_and_code_of_documents_are_not_prose() -> None:
    document = 'Never "likewise".\n\n```sh\nlikewise\n```\n\n| `anew` | again |\n\nPlay it likewise.\n'
    assert [(line, refused(text)) for line, text in prose(document) if refused(text)] == [(9, ["likewise"])]
