"""``robobt plays`` and ``robobt skills``: what is registered, with parameters."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape

from robobt.cli.common import Json, console, one_line_errors, print_json, unknown

if TYPE_CHECKING:
    from robobt.tree.parameters import Parameter

    _Entries = Mapping[str, tuple[str, list[Parameter], dict[str, list[str]]]]


def add_to(app: typer.Typer) -> None:
    """Enter the group's commands."""
    app.command()(plays)
    app.command()(skills)


@one_line_errors
def plays(
    name: Annotated[str | None, typer.Argument(help="One play, with its whole description.")] = None,
    as_json: Json = False,
) -> None:
    """List the plays with their parameters.

    Keys of --json: plays, a list with name, description and parameters (name,
    type, required, default).
    """
    from robobt.plays import PLAYS
    from robobt.tree.parameters import parameters_of

    builders = {entry: PLAYS[entry] for entry in PLAYS if name in (None, entry)}
    if not builders:
        raise unknown("play", name, PLAYS)
    entries: _Entries = {
        entry: (_doc(builder), parameters_of(builder), {}) for entry, builder in builders.items()
    }
    _list_things("plays", entries, whole=name is not None, as_json=as_json)


@one_line_errors
def skills(
    name: Annotated[str | None, typer.Argument(help="One skill, with its whole description.")] = None,
    as_json: Json = False,
) -> None:
    """List the skills and conditions: parameters, what they read and write in the robot's store.

    Keys of --json: skills, a list with name, description, parameters (name,
    type, required, default), reads and writes.
    """
    from robobt.skills import SKILLS
    from robobt.tree.parameters import parameters_of

    classes = {entry: SKILLS[entry] for entry in SKILLS if name in (None, entry)}
    if not classes:
        raise unknown("skill", name, SKILLS)
    entries = {
        entry: (
            _doc(cls),
            [parameter for parameter in parameters_of(cls) if parameter.name != "name"],
            {"reads": list(cls.reads), "writes": list(cls.writes)},
        )
        for entry, cls in classes.items()
    }
    _list_things("skills", entries, whole=name is not None, as_json=as_json)


def _list_things(
    kind: str,
    entries: _Entries,
    *,
    whole: bool,
    as_json: bool,
) -> None:
    if as_json:
        things = [
            {
                "name": name,
                "description": doc,
                "parameters": [
                    {
                        "name": parameter.name,
                        "type": parameter.kind,
                        "required": parameter.required,
                        "default": None if parameter.required else _plain(parameter.default),
                    }
                    for parameter in parameters
                ],
                **store,
            }
            for name, (doc, parameters, store) in entries.items()
        ]
        print_json({kind: things})
        return
    for name, (doc, parameters, store) in entries.items():
        console.print(f"[bold]{escape(name)}[/bold]")
        console.print(
            f"  {escape(doc if whole else doc.partition(chr(10))[0])}".replace("\n", "\n  "), soft_wrap=True
        )
        for parameter in parameters:
            console.print(f"    [cyan]{escape(str(parameter))}[/cyan]", soft_wrap=True)
        for verb, names in store.items():
            if names:
                console.print(f"    {verb} {', '.join(names)}", style="dim")


def _doc(thing: object) -> str:
    import inspect

    return inspect.getdoc(thing) or ""


def _plain(value: object) -> Any:
    """A default as JSON has it."""
    try:
        return json.loads(json.dumps(value))
    except (TypeError, ValueError):
        return str(value)
