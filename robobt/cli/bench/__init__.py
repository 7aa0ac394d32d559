"""``robobt bench``: measurements, one module each, which enters its command with ``add_to(bench)``."""

from __future__ import annotations

from importlib import import_module

import typer

_COMMANDS = (
    "sim",
    "match",
    "tree",
    "policy",
    "env",
    "shots",
    "train",
    "league",
)


def add_to(app: typer.Typer) -> None:
    """Enter the group and all its commands."""
    bench = typer.Typer(no_args_is_help=True, help="Measure how fast things are, on one core.")
    for command in _COMMANDS:
        import_module(f"robobt.cli.bench.{command}").add_to(bench)
    app.add_typer(bench, name="bench")
