"""What is registered by name: plays, skills, raters, policies and tasks, as lists and one by one."""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any

from rich.markup import escape

from robobt.cli.common import console, print_json, unknown, warn

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from robobt.challenges import Challenge
    from robobt.learning.tasks import Tasks
    from robobt.skills.base import Skill
    from robobt.tree.parameters import Parameter
    from robobt.tree.registry import Registry


def list_registered(kind: str, name: str | None, *, as_json: bool) -> None:
    """List plays, skills, raters, policies or tasks, or describe the one of that name.

    Raises:
        typer.BadParameter: there is none of that name.
    """
    registry, describe = registry_of(kind), _KINDS[kind][1]
    if name is not None and name not in registry:
        raise unknown(name, registry)
    entries = {entry: describe(registry, entry) for entry in (registry if name is None else [name])}
    if as_json:
        things = [_data(entry, one, registry.source(entry)) for entry, one in entries.items()]
        print_json({kind: things, "problems": list(registry.problems)})
    else:
        for entry, one in entries.items():
            _print(entry, one, registry.source(entry), whole=name is not None)
    for problem in registry.problems:
        warn(problem)


def registry_of(kind: str) -> Registry[Any]:
    """Return where all things of that kind are registered by name."""
    if kind == "skills":
        # The baselines have leaves of their own.
        import_module("robobt.plays")
    module, _, name = _KINDS[kind][0].partition(":")
    registry: Registry[Any] = getattr(import_module(module), name)
    return registry


def _challenge(challenges: Registry[type[Challenge]], name: str) -> _Listed:
    cls = challenges[name]
    return _Listed(f"{_doc(cls)}\n\nRules: {cls.source}", [])


def _play(plays: Registry[Callable[..., object]], name: str) -> _Listed:
    from robobt.tree.parameters import parameters_of

    play = plays[name]
    return _Listed(_doc(play), parameters_of(play))


def _skill(skills: Registry[type[Skill]], name: str) -> _Listed:
    from robobt.tree.parameters import parameters_of

    cls = skills[name]
    own = [parameter for parameter in parameters_of(cls) if parameter.name != "name"]
    store = {"reads": list(cls.reads), "writes": list(cls.writes)}
    return _Listed(_doc(cls), own, store, condition=cls.condition)


def _task(tasks: Tasks, name: str) -> _Listed:
    return _Listed(_without_roles(tasks.documentation(name)), [])


def _with_settings(registry: Registry[object], name: str) -> _Listed:
    """Describe what may be named alone or with settings, which are the fields of a pydantic model."""
    from robobt.tree.parameters import Parameter

    entry = registry[name]
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


_KINDS: dict[str, tuple[str, Callable[[Any, str], _Listed]]] = {
    "plays": ("robobt.plays:PLAYS", _play),
    "skills": ("robobt.skills:SKILLS", _skill),
    "raters": ("robobt.skills.aim.raters:RATERS", _with_settings),
    "policies": ("robobt.skills.ball.go_to_ball:GO_TO_BALL_POLICIES", _with_settings),
    "tasks": ("robobt.learning:TASKS", _task),
    "challenges": ("robobt.challenges:CHALLENGES", _challenge),
}
"""Of each kind of thing where it is registered, and what is said of each."""

REGISTERED = tuple(_KINDS)
"""The kinds of things that are registered by name."""


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
    doc = listed.doc if whole else listed.doc.partition("\n")[0]
    lines = [f"[bold]{escape(name)}[/bold]{marked}{origin}", f"  {escape(doc)}".replace("\n", "\n  ")]
    for parameter in listed.parameters:
        meaning = listed.meanings.get(parameter.name, "")
        lines.append(
            f"    [cyan]{escape(str(parameter))}[/cyan]" + (f"  {escape(meaning)}" if meaning else "")
        )
    lines += [
        f"[dim]    {verb} {escape(', '.join(names))}[/dim]" for verb, names in listed.store.items() if names
    ]
    console.print("\n".join(lines), soft_wrap=True)


def _doc(thing: object) -> str:
    return _without_roles(inspect.getdoc(thing) or "")


def _without_roles(docstring: str) -> str:
    """Return a docstring with the last names of what it refers to, without the roles of Sphinx."""
    return re.sub(r":\w+:`~?(?:[\w.]+\.)?(\w+)`", r"\1", docstring)


def _plain(value: object) -> object:
    """Convert a default to what JSON has."""
    try:
        plain: object = json.loads(json.dumps(value))
        return plain
    except (TypeError, ValueError):
        return str(value)
