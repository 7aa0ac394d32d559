"""``python -m paper``: the tables of the paper, its figures beside ours, and what they rest on."""

from __future__ import annotations

import typer

from robobt.cli import add_commands, global_options, run

_COMMANDS = {
    "table2": "shot_tables:table2",
    "table3": "shot_tables:table3",
    "table4": "table4:table4",
    "deployed": "deployed:deployed",
    "goalkeepers": "goalkeepers:goalkeepers",
}
"""The commands by name, each a function of a module in ``commands``."""


def application(only: str | None = None) -> typer.Typer:
    """Make the application; of one command alone where that is all that is asked for."""
    made = typer.Typer(
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        help="The tables of the paper, its figures beside ours.",
    )
    made.callback()(global_options)
    asked = {name: place for name, place in _COMMANDS.items() if name == only}
    add_commands(made, asked or _COMMANDS, "paper.commands")
    return made


if __name__ == "__main__":
    run(application, "python -m paper")
