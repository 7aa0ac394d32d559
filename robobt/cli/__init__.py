"""The command ``robobt``: thin over the rest, and where worlds, plays and matches are wired together.

The functions are in the modules here; what they share is in ``common``. Everything heavy
is imported by the command that needs it, so that ``robobt --help`` is quick.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from io import TextIOWrapper
from typing import Annotated

import typer

from robobt.cli.common import MAX_SEED as MAX_SEED
from robobt.cli.common import Json as Json
from robobt.cli.common import Progress as Progress
from robobt.cli.common import Seed as Seed
from robobt.cli.common import Where as Where
from robobt.cli.common import Workers as Workers
from robobt.cli.common import console as console
from robobt.cli.common import cores as cores
from robobt.cli.common import one_line_errors
from robobt.cli.common import one_of as one_of
from robobt.cli.common import print_json as print_json
from robobt.cli.common import say as say
from robobt.cli.common import table as table
from robobt.cli.common import world_of as world_of
from robobt.cli.option_groups.page import Page as Page
from robobt.cli.option_groups.spread import spread
from robobt.cli.options import option
from robobt.cli.outputs import make_folders as make_folders
from robobt.config.compiling import compile_nothing
from robobt.config.telling import tell_warnings
from robobt.signals import leave_after_signal

_COMMANDS = {
    "match": ("match:match", "Play a scenario and count goals; --live shows it."),
    "compare": ("compare:compare", "Compare variants of a scenario, trial by trial."),
    "list": ("list_:list_", "List plays, skills, models, scenarios and more."),
    "show": ("show:show", "Show a play, scenario, model or recording."),
    "what-if": ("what_if:what_if", "Play a moment of a match on with other decisions."),
    "train": ("train:train", "Train a skill by reinforcement learning."),
    "evaluate": ("evaluate:evaluate", "Judge trained policies on fresh starts."),
    "export": ("export:export", "Write a trained policy as a model file."),
    "challenge": ("challenge:challenge", "Play the league's challenges, and score them."),
    "serve": ("league:serve", "Serve a simulated field to other software."),
    "log": ("league:log_packets", "Write a log of a field's network traffic."),
}
"""The commands by name: a function of a module here, and what the list of commands says of it."""

_COMMAND_GROUPS = {
    "tournament": (
        "Let teams play each other, and rate them.",
        {
            "run": ("tournament.tournament:run", "Let teams play each other, and rate them."),
            "results": ("tournament.results:results", "Sum up, compare and merge what was played."),
            "sweep": ("tournament.sweep:sweep", "Tune the parameters of a play."),
        },
    ),
    "record": (
        "Use recordings, and make demonstrations.",
        {
            "export": ("record:export", "Write a recording for other tools."),
            "case": ("record:case", "Save a tick as a regression case."),
            "statistics": ("record:statistics", "Count goals, passes, fouls and more."),
            "identify": ("identify:identify", "Identify ball, robots, delay and noise."),
            "demonstrations": ("record:demonstrations", "Record a script or skill doing a task."),
        },
    ),
    "shots": (
        "Collect shots; train and judge predictors of goals.",
        {
            "collect": ("collect:collect", "Play, and record one row a shot."),
            "train": ("shots:train", "Train a shot predictor."),
            "score": ("shots:score", "Judge a shot predictor on recorded shots."),
            "map": ("shots:draw", "Draw the probability of a goal over the field."),
        },
    ),
}
"""The groups of commands, each with its help and its commands."""

_START_OF_LISTS = {"OPENBLAS_NUM_THREADS": "1", "PYDANTIC_DISABLE_PLUGINS": "__all__"}
"""Environment of commands that only list names: numpy starts no threads, which would wait in a busy loop, and
pydantic does not look for plugins among all installed packages; together a sixth of such a command."""

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
    engine: Annotated[str, option("--engine")] = "local",
    debug: Annotated[bool, option("--debug")] = False,
    _shown: Annotated[bool, option("--version", callback=_version, is_eager=True)] = False,
) -> None:
    """Do what the options say that stand before a command."""
    tell_warnings(debug)
    for stream in (sys.stdout, sys.stderr):
        # A terminal or file that lacks a sign is shown a question mark for it.
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")
    if engine != "local":
        one_line_errors(_run_on)(context, engine)


def add_commands(
    group: typer.Typer, commands: Mapping[str, str | tuple[str, str]], package: str = "robobt.cli"
) -> None:
    """Give an application commands by name: each a "module:function" of the package, and its summary."""
    for name, given in commands.items():
        place, summary = (given, None) if isinstance(given, str) else given
        module, _, function = place.partition(":")
        command = getattr(import_module(f"{package}.{module}"), function)
        group.command(name, short_help=summary)(one_line_errors(spread(command)))


def application(only: str | None = None) -> typer.Typer:
    """Make the application; of one command or group alone where that is all that is asked for."""
    known = only in _COMMANDS or only in _COMMAND_GROUPS
    made = typer.Typer(
        no_args_is_help=True,
        add_completion=not known,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        help="Behaviour trees for robot soccer: play scenarios, look at plays and skills, measure.",
    )
    made.callback()(global_options)
    add_commands(made, {name: place for name, place in _COMMANDS.items() if name == only or not known})
    for name, (about, commands) in _COMMAND_GROUPS.items():
        if name == only or not known:
            group = typer.Typer(no_args_is_help=True, help=about)
            # A group of its own even with a single command.
            group.callback()(lambda: None)
            add_commands(group, commands)
            made.add_typer(group, name=name)
    return made


def main() -> None:
    """Run the command ``robobt``."""
    if _only_names(sys.argv[1:]):
        compile_nothing()
        os.environ.update(_START_OF_LISTS)
    run(application, "robobt")


def _only_names(words: Sequence[str]) -> bool:
    """Return whether a command line only asks what there is, and runs no code of the user's own."""
    completes = any(name in os.environ for name in ("_ROBOBT_COMPLETE", "_TYPER_COMPLETE_ARGS"))
    return completes or ([*words, ""][0] == "list" and not any(word.startswith("--import") for word in words))


def run(make: Callable[[str | None], typer.Typer], name: str) -> None:
    """Run an application as a program of this name; ``make`` is given the first word of the command line."""
    # What a start imports stays; looking through its 270,000 objects for garbage took an eighth of the start.
    gc.set_threshold(400_000, *gc.get_threshold()[1:])
    words = [word for word in sys.argv[1:] if word != "--debug"]
    debug = ["--debug"] if len(words) < len(sys.argv) - 1 else []
    try:
        # To make all commands takes as long as many a command itself.
        make(words[0] if words else None)([*debug, *words], prog_name=name)
    except SystemExit as end:
        leave_after_signal(end.code)
        raise
    finally:
        # All of it ends with the process; taking it apart object by object took a quarter of a short match.
        gc.freeze()
