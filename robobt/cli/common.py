"""One-line errors, options and tables that the commands share.

Nothing heavy may be imported at the top of any module of this package:
``robobt --help`` loads them all. A command imports what it needs itself.
"""

from __future__ import annotations

import json
import logging
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ParamSpec, TypeVar

import typer
from rich.markup import escape

from robobt.cli.options import option
from robobt.cli.progress import Progress as Progress
from robobt.cli.screen import FittedTable
from robobt.cli.screen import console as console
from robobt.cli.screen import errors as errors
from robobt.config.errors import ConfigError, RobobtError
from robobt.config.extras import missing_extra
from robobt.config.seeds import MAX_SEED as MAX_SEED
from robobt.signals import Terminated, at_the_latest_after, ending

if TYPE_CHECKING:
    from robobt.match.loop import WorldFactory
    from robobt.tree.registry import Registry


Json = Annotated[bool, option("--json")]
"""The option of every command that can print its figures for another program."""

Imports = Annotated[list[Path] | None, option("--import")]
"""The option of every command that knows plays or skills by name; see ``import_files``."""

Seed = Annotated[int | None, option("--seed", "; by default the scenario's", min=0, max=MAX_SEED)]
"""The option of commands that play a scenario with its seed or another."""

Workers = Annotated[int | None, option("--workers", min=1, max=256)]
"""The option of commands that share their work among processes."""

Where = Annotated[str, option("--world")]
"""The option of every command that can play elsewhere; see ``world_of``."""


def complete_scenario(incomplete: str) -> list[str]:
    """Return what a shell offers for a scenario that is being typed."""
    from robobt.config.resources import bundled_scenarios

    return [name for name in bundled_scenarios() if name.startswith(incomplete)]


def complete_play(incomplete: str) -> list[str]:
    """Return what a shell offers for a play that is being typed."""
    from robobt.plays import PLAYS

    return [name for name in PLAYS if name.startswith(incomplete)]


Bundled = Annotated[
    str,
    typer.Argument(help="A scenario file, or the name of a bundled one.", autocompletion=complete_scenario),
]
"""The argument of commands that play a scenario."""

log = logging.getLogger("robobt")
_P = ParamSpec("_P")
_T = TypeVar("_T")


def one_line_errors(command: Callable[_P, None]) -> Callable[_P, None]:
    """Turn whatever goes wrong in a command, or a signal that ends it, into one line on stderr.

    The exit code is 1, or that of the signal: 130 for SIGINT, 143 for SIGTERM.
    """

    @wraps(command)
    def guarded(*args: _P.args, **kwargs: _P.kwargs) -> None:
        with ending():
            run(*args, **kwargs)

    def run(*args: _P.args, **kwargs: _P.kwargs) -> None:
        try:
            with as_far_as_read():
                command(*args, **kwargs)
        except (typer.Exit, typer.Abort, typer.BadParameter):
            raise
        except KeyboardInterrupt as error:
            errors.print("robobt: ended by SIGINT")
            raise typer.Exit(130) from error
        except Terminated as error:
            errors.print(f"robobt: ended by {error.signal.name}")
            raise typer.Exit(128 + error.signal) from error
        except Exception as error:
            if log.isEnabledFor(logging.DEBUG):
                raise
            told = _error_text(missing_extra(error) or error)
            errors.print(f"[red]robobt:[/red] {escape(told)}", soft_wrap=True)
            raise typer.Exit(1) from error

    return guarded


@contextmanager
def as_far_as_read() -> Iterator[None]:
    """End the block early, without an error, when who reads what it prints has enough, as ``head`` has."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        # What is left goes nowhere.
        with suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _error_text(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    text = " ".join(str(error.args[0] if error.args else "").split())
    # robobt's own errors are written for users; any other may be a bug.
    if isinstance(error, RobobtError):
        return text
    if isinstance(error, KeyError | ValueError) and text:
        return f"{text} (robobt --debug shows where)"
    return f"{type(error).__name__}: {text} (robobt --debug shows where)"


def import_files(paths: Iterable[Path] | None) -> None:
    """Run the user's Python files, so that what they register is there."""
    if paths:
        from robobt.plays import python_files

        python_files.import_files(paths)


_ENDING_TIMEOUT = 0.6
"""How long a skill may go on after a signal that ends the command [s]."""


@contextmanager
def world_of(address: str, publish: bool = False) -> Iterator[WorldFactory]:
    """Return the world factory of an address.

    At the end of the block, also by a signal that some skill ignores, robots of the league are
    stopped and ports released.
    """
    from robobt.worlds import world_from

    factories = [world_from(address)]
    if publish:
        from robobt.league.serve.publishing import PublishingFactory

        factories.append(PublishingFactory(factories[0]))
    with ExitStack() as stack:
        for factory in factories:
            if hasattr(factory, "close"):
                stack.callback(factory.close)
        stack.enter_context(at_the_latest_after(_ENDING_TIMEOUT))
        yield factories[-1]


def unknown(name: str, registry: Registry[_T]) -> typer.BadParameter:
    """Make the usage error for an unknown name, with the known ones or what is wrong with its package."""
    problem = registry.problem_with(name)
    there = f"no {registry.kind} is called {name!r}; {registry.meant(name)}"
    return typer.BadParameter(there if problem is None else problem)


def parse_assignments(texts: Iterable[str], option: str) -> dict[str, object]:
    """Parse ``name=value`` texts, the values read as YAML; ``option`` is named in the usage error."""
    from robobt.config.yaml import parse_marked

    given: dict[str, object] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name:
            raise typer.BadParameter(f"takes name=value, not {text!r}", param_hint=option)
        try:
            given[name] = parse_marked(value, name).plain()
        except ConfigError as error:
            raise typer.BadParameter(f"{name}: {error.problem}", param_hint=option) from error
    return given


@contextmanager
def blaming(option: str) -> Iterator[None]:
    """Name the option, rather than a file that it changes, where what it says is wrong."""
    try:
        yield
    except ConfigError as error:
        field, problem = error.field, error.problem
        # The problem names the robot already; of the field only the parameter is news.
        if (robot := _ROBOT_PREFIX.match(problem)) and (place := _ROBOTS_FIELD.match(field)):
            named = (robot[1], field[place.end() :])
            field, problem = ": ".join(filter(None, named)), problem[robot.end() :]
        raise ConfigError(option, problem, field) from error


_ROBOT_PREFIX = re.compile(r"((?:blue|yellow) \d+): ")
_ROBOTS_FIELD = re.compile(r"robots\.\w+\.\d+\.(?:params\.|play$)?")


def cores() -> int:
    """Return how many tasks are run at a time by default: this process's cores, or those of its engine."""
    from robobt.engines.run import engine

    elsewhere = engine()
    if elsewhere is not None:
        return elsewhere.workers
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def say(text: str) -> None:
    """Print a line as it is, however long."""
    console.print(escape(text), soft_wrap=True)


def warn(text: str) -> None:
    """Print a line on stderr, or to nobody where that is no longer read."""
    with suppress(BrokenPipeError):
        errors.print(f"[yellow]robobt:[/yellow] {escape(text)}", soft_wrap=True)


def print_json(data: Mapping[str, object]) -> None:
    """Print one JSON object, dataclasses by their fields; what JSON lacks (NaN, infinity) is a ValueError."""
    sys.stdout.write(json.dumps(data, indent=2, allow_nan=False, default=asdict) + "\n")


def table(*columns: str) -> FittedTable:
    """Return an empty table without lines, to be printed on ``console``."""
    return FittedTable(*columns)


_WORDS = re.compile(r"[^\s:,/|]*[\s:,/|]*")


def name_lines(name: str, beside: int) -> str:
    """Return a name for a table, broken into lines between its words where it is too long.

    Args:
        name: an entrant's, a variant's: words joined by spaces, colons, commas and the like.
        beside: how many columns of the screen the rest of the table needs.
    """
    width, lines = max(16, console.width - beside), [""]
    for word in _WORDS.findall(name):
        if lines[-1] and len(lines[-1]) + len(word.rstrip()) > width:
            lines.append("")
        lines[-1] += word
    return escape("\n".join(map(str.rstrip, lines)))


def one_of(given: Iterable[str], known: Iterable[str], option: str) -> None:
    """Refuse a value of an option that is not known, naming those that are."""
    known = list(known)
    for name in given:
        if name not in known:
            there = ", ".join([repr(one) for one in known])
            raise typer.BadParameter(f"must be one of {there}, not {name!r}", param_hint=option)
