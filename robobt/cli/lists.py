"""``robobt plays``, ``skills``, ``raters`` and ``policies``: list what is registered by name."""

from __future__ import annotations

import inspect
import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer
from rich.markup import escape

from robobt.cli.common import Imports, Json, console, import_files, print_json, unknown, warn

if TYPE_CHECKING:
    from collections.abc import Callable

    from pydantic.fields import FieldInfo

    from robobt.skills.base import Skill
    from robobt.tree.parameters import Parameter
    from robobt.tree.registry import Registry

_T = TypeVar("_T")


def plays(
    name: Annotated[str | None, typer.Argument(help="One play, with its whole description.")] = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """List the plays with their parameters.

    Keys of --json: plays, a list with name, description, parameters (name,
    type, required, default) and package (the distribution it came with, null
    for robobt's own and imported files'); problems: what is wrong with other
    packages' plays.
    """
    from robobt.plays import PLAYS
    from robobt.tree.parameters import parameters_of

    import_files(imports)
    _list("plays", PLAYS, name, as_json, lambda play: _Listed(_doc(play), parameters_of(play)))


def skills(
    name: Annotated[str | None, typer.Argument(help="One skill, with its whole description.")] = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """List the skills and conditions: parameters, what they read and write in the robot's store.

    Keys of --json: skills, a list with name, description, parameters (name,
    type, required, default), reads and writes, condition (whether it is one),
    and package (the distribution it came with, null for robobt's own and imported
    files'); problems: what is wrong with other packages' skills.
    """
    import robobt.plays  # noqa: F401  (baselines have leaves of their own)
    from robobt.skills import SKILLS
    from robobt.tree.parameters import parameters_of

    import_files(imports)

    def listed(cls: type[Skill]) -> _Listed:
        own = [parameter for parameter in parameters_of(cls) if parameter.name != "name"]
        store = {"reads": list(cls.reads), "writes": list(cls.writes)}
        return _Listed(_doc(cls), own, store, condition=cls.condition)

    _list("skills", SKILLS, name, as_json, listed)


def raters(
    name: Annotated[str | None, typer.Argument(help="One rater, with its whole description.")] = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """List the shot raters, which judge shots for SelectShot and others, with their settings.

    A file names one alone or with settings, as rater: {name: expected_goal, threshold: 0.8}.

    Keys of --json: raters, a list with name, description, parameters (name,
    type, required, default) and package (the distribution it came with, null
    for robobt's own and imported files'); problems: what is wrong with other
    packages' raters.
    """
    from robobt.skills.aim.raters import RATERS

    import_files(imports)
    _list("raters", RATERS, name, as_json, _with_settings)


def policies(
    name: Annotated[str | None, typer.Argument(help="One policy, with its whole description.")] = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """List the policies of GoToBall, which may stand in its parameter policy, with their settings.

    A file names one alone or with settings, as policy: {name: geometric, arrival_speed: 0.3}.

    Keys of --json: policies, a list with name, description, parameters (name,
    type, required, default) and package (null); problems (none).
    """
    from robobt.skills.ball.go_to_ball import POLICIES

    import_files(imports)
    _list("policies", POLICIES, name, as_json, _with_settings)


def _with_settings(entry: object) -> _Listed:
    """Describe what may be named alone or with settings, which are the fields of a pydantic model."""
    from robobt.tree.parameters import Parameter

    fields: dict[str, FieldInfo] = getattr(entry, "model_fields", {})
    own = [
        Parameter(key, given.annotation, inspect.Parameter.empty if given.is_required() else given.default)
        for key, given in fields.items()
    ]
    return _Listed(_doc(entry), own, meanings={key: given.description or "" for key, given in fields.items()})


@dataclass
class _Listed:
    """The description of an entry.

    Attributes:
        store: verb and entries of the store.
        meanings: what parameters mean, where their type does not carry the description.
        condition: whether a skill is a condition; None for what is no skill.
    """

    doc: str
    parameters: list[Parameter]
    store: dict[str, list[str]] = field(default_factory=dict)
    meanings: dict[str, str] = field(default_factory=dict)
    condition: bool | None = None


def _list(
    kind: str, registry: Registry[_T], name: str | None, as_json: bool, listed: Callable[[_T], _Listed]
) -> None:
    if name is not None and name not in registry:
        raise unknown(name, registry)
    entries = {entry: listed(registry[entry]) for entry in registry if name in (None, entry)}
    if as_json:
        things = [_data(entry, one, registry.source(entry)) for entry, one in entries.items()]
        print_json({kind: things, "problems": list(registry.problems)})
    else:
        for entry, one in entries.items():
            _print(entry, one, registry.source(entry), whole=name is not None)
    for problem in registry.problems:
        warn(problem)


def _data(name: str, listed: _Listed, package: str | None) -> dict[str, object]:
    parameters = [
        {
            "name": parameter.name,
            "type": parameter.kind,
            "required": parameter.required,
            "default": None if parameter.required else _plain(parameter.default),
        }
        for parameter in listed.parameters
    ]
    return {
        "name": name,
        "description": listed.doc,
        "parameters": parameters,
        **listed.store,
        **({} if listed.condition is None else {"condition": listed.condition}),
        "package": package,
    }


def _print(name: str, listed: _Listed, package: str | None, *, whole: bool) -> None:
    origin = "" if package is None else f"  from {escape(package)}"
    marked = "  [cyan]condition[/cyan]" if listed.condition else ""
    console.print(f"[bold]{escape(name)}[/bold]{marked}{origin}")
    doc = listed.doc if whole else listed.doc.partition("\n")[0]
    console.print(f"  {escape(doc)}".replace("\n", "\n  "), soft_wrap=True)
    for parameter in listed.parameters:
        meaning = listed.meanings.get(parameter.name, "")
        console.print(
            f"    [cyan]{escape(str(parameter))}[/cyan]" + (f"  {escape(meaning)}" if meaning else ""),
            soft_wrap=True,
        )
    for verb, names in listed.store.items():
        if names:
            console.print(f"    {verb} {', '.join(names)}", style="dim")


def _doc(thing: object) -> str:
    return inspect.getdoc(thing) or ""


def _plain(value: object) -> object:
    """Convert a default to what JSON has."""
    try:
        plain: object = json.loads(json.dumps(value))
        return plain
    except (TypeError, ValueError):
        return str(value)
