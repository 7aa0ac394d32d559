"""The one base class of robobt's errors, and how a message names a file, a line and a field."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import Any


class RobobtError(Exception):
    """Base class of every error that robobt raises on purpose; the message is one readable line."""

    def __reduce__(self) -> tuple[Any, ...]:
        # An exception is otherwise made again from its message alone, which those with fields refuse: what a
        # worker process raised would arrive as a TypeError.
        return (_made_again, (type(self), self.args, self.__dict__))


def _made_again(kind: type[RobobtError], args: tuple[object, ...], fields: dict[str, object]) -> RobobtError:
    made = kind.__new__(kind, *args)
    made.__dict__.update(fields)
    return made


class ConfigError(RobobtError, ValueError):
    """Something is wrong with a file that a person writes, or with one of its fields.

    The message is one line: ``file:line: field: problem``, without the parts that are unknown.

    Attributes:
        file: path of the file, or the name of the text; empty for values that come from no file.
        problem: what is wrong and what to do.
        field: dotted path of the field ("robots.blue.0.play"); empty when it is not one field.
        line: line of the file, counted from 1; None when it is not one place.
    """

    def __init__(self, file: str, problem: str, field: str = "", line: int | None = None) -> None:
        self.file, self.problem, self.field, self.line = file, one_line(problem), field, line
        where = file if line is None else f"{file}:{line}"
        super().__init__(": ".join([one_line(part) for part in (where, field, self.problem) if part]))


class FieldError(RobobtError, ValueError):
    """A problem with a field further down than the one that is being validated.

    Attributes:
        field: dotted path from the validated field on ("0.number").
    """

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(problem)
        self.field = field


def message_of(error: BaseException) -> str:
    """Return the message of the exception ``error``; a KeyError's comes without quotes around it."""
    return str(error.args[0]) if error.args else type(error).__name__


def one_line(text: str, limit: int = 500) -> str:
    """Return the text on one line, printable, and no longer than ``limit`` characters."""
    words = " ".join(text.split())
    shown = "".join([character if character.isprintable() else "?" for character in words])
    return shown if len(shown) <= limit else shown[: limit - 3] + "..."


def text_of(value: object, text: Callable[[Any], str] = str) -> str:
    """Return ``text(value)``, or a description of the error that it raised.

    Args:
        value: any object, whose class may be a user's.
        text: makes the text.
    """
    try:
        return text(value)
    except (SystemExit, KeyboardInterrupt):
        raise
    except BaseException as error:
        return f"a {type(value).__name__} whose text is a {type(error).__name__}"


def short_repr(value: object) -> str:
    """Return the ``repr`` of a value for a message, at most 60 characters long."""
    shown = text_of(value, repr)
    return shown if len(shown) <= 60 else shown[:57] + "..."


FEW = 6
"""Number of names listed even if one was probably meant."""

MANY = 12
"""Number of names that are still listed where a command lists them, too."""


def unknown_name(name: object, known: Iterable[str], there_are: str = "there are", command: str = "") -> str:
    """Return the end of a message about an unknown name: the likely name, the known ones, or both if few.

    Args:
        name: the unknown name.
        known: the known names.
        there_are: words in front of their list.
        command: the command that lists the names, given in place of more than :data:`MANY` of them.
    """
    there = list(known)
    meant = close_names(str(name), there) if len(there) > 1 else []
    guess = f"did you mean {' or '.join(meant)}?"
    if meant and len(there) > FEW:
        return guess
    if command and len(there) > MANY:
        return f"'{command}' lists all {len(there)}"
    listed = f"{there_are} {', '.join(there) or 'none'}"
    return f"{listed}; {guess}" if meant else listed


def close_names(name: str, known: Iterable[str]) -> list[str]:
    """Return up to three known names most similar to this one, ignoring case and hyphens."""
    plain = {_plain(each): each for each in known}
    asked = _plain(name)
    close = get_close_matches(asked, plain, n=3, cutoff=0.66)
    if len(asked) >= 3:
        close += [each for each in plain if asked in each and each not in close]
    return [plain[each] for each in close[:3]]


def _plain(name: str) -> str:
    return name.lower().replace("_", "").replace("-", "").replace(" ", "")


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Make an OSError from the block name this file.

    Errors without a file name (a full disk) and errors about a temporary file that was to
    be renamed to this one would otherwise not tell the reader which file is meant.
    """
    try:
        yield
    except OSError as error:
        if error.filename is None or error.filename2 is not None:
            error.filename = str(path)
        raise
