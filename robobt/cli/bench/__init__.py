"""``robobt bench``: measurements; each module enters its commands with ``add_to(bench)``."""

from __future__ import annotations

from importlib import import_module

import typer

_GROUPS = ("parts", "match", "shots", "train", "league")


def add_to(app: typer.Typer) -> None:
    """Enter the group and all its commands."""
    bench = typer.Typer(no_args_is_help=True, help="Measure how fast things are, on one core.")
    for group in _GROUPS:
        import_module(f"robobt.cli.bench.{group}").add_to(bench)
    app.add_typer(bench, name="bench")
