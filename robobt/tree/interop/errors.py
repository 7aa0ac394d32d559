"""What is wrong with a tree file."""

from __future__ import annotations

from typing import Any


class TreeFileError(ValueError):
    """A tree file that cannot be used; the message is one line: file, line, what is wrong.

    Attributes:
        file: its path, or what the caller calls the text.
        line: where, counted from 1; None when it is not one place.
        problem: what is wrong there.
    """

    def __init__(self, file: str, line: int | None, problem: str) -> None:
        self.file, self.line, self.problem = file, line, _one_line(problem)
        where = file if line is None else f"{file}:{line}"
        super().__init__(f"{_one_line(where)}: {self.problem}")

    def __reduce__(self) -> tuple[Any, ...]:
        return (TreeFileError, (self.file, self.line, self.problem))


def _one_line(text: str) -> str:
    words = " ".join(text.split())
    said = "".join([character if character.isprintable() else "?" for character in words])
    return said if len(said) <= 500 else said[:497] + "..."
