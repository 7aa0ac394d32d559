"""The command ``robobt``: thin over the rest, and where worlds, plays and matches are wired together.

Each module here holds a group of commands and enters them with
``add_to(app)``; what they share is in ``common``. Measurements (``robobt bench
...``) are one module each in ``bench``. Everything heavy is imported by the
command that needs it, so that ``robobt --help`` is quick.
"""

from __future__ import annotations

import logging
import sys
from importlib import import_module
from io import TextIOWrapper
from typing import Annotated

import typer

from robobt.cli.common import console, log
from robobt.signals import leave_after_signal

_GROUPS = (
    "match",
    "replay",
    "record",
    "scenarios",
    "lists",
    "tree",
    "train",
    "export",
    "league",
    "collect",
    "shots",
    "paper",
    "bench",
)
"""The modules that hold the commands, in the order of ``robobt --help``."""

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Behaviour trees for robot soccer: play scenarios, look at plays and skills, measure.",
)


def _version(show: bool) -> None:
    if show:
        from robobt import __version__

        console.print(f"robobt {__version__}")
        raise typer.Exit


@app.callback()
def _main(
    debug: Annotated[bool, typer.Option("--debug", hidden=True, help="Show tracebacks.")] = False,
    _shown: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    log.setLevel(logging.DEBUG if debug else logging.ERROR)
    for stream in (sys.stdout, sys.stderr):
        # A terminal or file that lacks a sign is shown a question mark for it.
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")


for _group in _GROUPS:
    import_module(f"robobt.cli.{_group}").add_to(app)


def main() -> None:
    """Run the command ``robobt``."""
    try:
        app(prog_name="robobt")
    except SystemExit as end:
        leave_after_signal(end.code)
        raise
