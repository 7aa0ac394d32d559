"""The programs that the documents say to type."""

from __future__ import annotations

import re
import shlex

import typer

import benchmarks.__main__
import paper.__main__
import robobt.cli

PROGRAMS: dict[str, typer.Typer] = {
    "robobt": robobt.cli.app,
    "python -m benchmarks": benchmarks.__main__.application(),
    "python -m paper": paper.__main__.application(),
}
"""By how each is called."""

_CALL = re.compile(rf" *({'|'.join(PROGRAMS)})(?: (.*))?", re.DOTALL)


def calls_a_program(line: str) -> bool:
    """Return whether a line runs one of the programs."""
    return _CALL.fullmatch(line) is not None


def program_and_words(line: str) -> tuple[str, list[str]]:
    """Return the name of the program that a line runs, and the words that it is given."""
    found = _CALL.fullmatch(line)
    assert found is not None, line
    return found[1], shlex.split(found[2] or "", comments=True)
