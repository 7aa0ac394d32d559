"""The command ``robobt``: thin over the rest, and where worlds, plays and matches are wired together.

The functions are in the modules here; what they share is in ``common``. Everything heavy
is imported by the command that needs it, so that ``robobt --help`` is quick.
"""

from __future__ import annotations

import gc
import shlex
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from io import TextIOWrapper
from typing import Annotated

import typer

from robobt.cli.common import console, errors, one_line_errors
from robobt.cli.groups import spread
from robobt.config.telling import tell_warnings
from robobt.signals import leave_after_signal

_COMMANDS = {
    "match": "match:match",
    "live": "live:live",
    "compare": "compare:compare",
    "tournament": "tournament.tournament:tournament",
    "sweep": "tournament.sweep:sweep",
    "results": "tournament.results:results",
    "replay": "replay:replay",
    "scenarios": "scenarios:scenarios",
    "plays": "lists:plays",
    "skills": "lists:skills",
    "raters": "lists:raters",
    "policies": "lists:policies",
    "tree": "tree:tree",
    "train": "train:train",
    "demonstrations": "train:demonstrations",
    "rate": "rate:rate",
    "export": "export:export",
    "models": "export:models",
    "serve": "league:serve",
    "log": "league:log_packets",
}
"""The commands by name, each a function of a module here, in the order of ``robobt --help``."""

_GROUPS = {
    "record": (
        "Use recordings: what the teams did, in other tools, in tests.",
        {"export": "record:export", "case": "record:case", "statistics": "record:statistics"},
    ),
    "collect": ("Collect data from simulated play.", {"shots": "collect:shots"}),
    "shots": (
        "Predictors of shots: train them, judge them, draw their map.",
        {
            "train": "shots:train",
            "score": "shots:score",
            "map": "shots:draw",
        },
    ),
}
"""The groups of commands, each with its help and its commands."""

_MOVED = {"bench": "python -m benchmarks", "paper": "python -m paper"}
"""Commands that are run from a clone of the repository now, and how."""

app: typer.Typer
"""The whole of it, made when it is first used."""


def __getattr__(name: str) -> object:
    if name != "app":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = made = application()
    return made


def _version(show: bool) -> None:
    if show:
        from robobt import __version__

        console.print(f"robobt {__version__}")
        raise typer.Exit


def _run_on(context: typer.Context, address: str) -> None:
    """Run what the command does in several processes on a cluster."""
    from robobt.engines.cluster import RayEngine
    from robobt.engines.run import running_on

    context.with_resource(running_on(context.with_resource(RayEngine(address))))


def global_options(
    context: typer.Context,
    engine: Annotated[
        str,
        typer.Option(
            help="Where commands with --workers run them: local (processes of this machine), ray, or "
            "ray://HOST:PORT.",
        ),
    ] = "local",
    debug: Annotated[bool, typer.Option("--debug", hidden=True, help="Show tracebacks.")] = False,
    _shown: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Do what the options say that stand before a command."""
    tell_warnings(debug)
    for stream in (sys.stdout, sys.stderr):
        # A terminal or file that lacks a sign is shown a question mark for it.
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")
    if engine != "local":
        one_line_errors(_run_on)(context, engine)


def add_commands(group: typer.Typer, commands: Mapping[str, str], package: str = "robobt.cli") -> None:
    """Give an application commands: by name, each a "module:function" of the package."""
    for name, place in commands.items():
        module, _, function = place.partition(":")
        command = getattr(import_module(f"{package}.{module}"), function)
        group.command(name)(one_line_errors(spread(command)))


def _moved(name: str, now: str) -> Callable[[typer.Context], None]:
    def say_so(context: typer.Context) -> None:
        asked = shlex.join(context.args) or "--help"
        errors.print(
            f"robobt {name} has moved: in a clone of the repository run {now} {asked}", soft_wrap=True
        )
        raise typer.Exit(2)

    return say_so


def application(only: str | None = None) -> typer.Typer:
    """Make the application; of one command or group alone where that is all that is asked for."""
    known = only in _COMMANDS or only in _GROUPS or only in _MOVED
    made = typer.Typer(
        no_args_is_help=True,
        add_completion=not known,
        pretty_exceptions_enable=False,
        help="Behaviour trees for robot soccer: play scenarios, look at plays and skills, measure.",
    )
    made.callback()(global_options)
    add_commands(made, {name: place for name, place in _COMMANDS.items() if name == only or not known})
    for name, (about, commands) in _GROUPS.items():
        if name == only or not known:
            group = typer.Typer(no_args_is_help=True, help=about)
            # A group of its own even with a single command.
            group.callback()(lambda: None)
            add_commands(group, commands)
            made.add_typer(group, name=name)
    anything = {"ignore_unknown_options": True, "allow_extra_args": True}
    for name, now in _MOVED.items():
        if name == only or not known:
            made.command(name, hidden=True, add_help_option=False, context_settings=anything)(
                _moved(name, now)
            )
    return made


def main() -> None:
    """Run the command ``robobt``."""
    run(application, "robobt")


def run(make: Callable[[str | None], typer.Typer], name: str) -> None:
    """Run an application as a program of this name; ``make`` is given the first word of the command line."""
    # What a start imports stays; looking through its 270,000 objects for garbage took an eighth of the start.
    gc.set_threshold(400_000, *gc.get_threshold()[1:])
    try:
        # To make all commands takes as long as many a command itself.
        make(sys.argv[1] if len(sys.argv) > 1 else None)(prog_name=name)
    except SystemExit as end:
        leave_after_signal(end.code)
        raise
    finally:
        # All of it ends with the process; taking it apart object by object took a quarter of a short match.
        gc.freeze()
