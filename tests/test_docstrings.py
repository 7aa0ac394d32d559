"""Every public name has a docstring that speaks of each parameter and of what is returned.

Public is what ``import robobt`` and the rooms below it export, the plays and the skills. Docstrings
here are prose: a parameter is documented where its name occurs, in the docstring of the function, of
the class for a constructor, or of what a method overrides. That there is a docstring at all is ruff's
business (rules D); this is what no rule of it can see. `make lint` runs it.
"""

from __future__ import annotations

import inspect
import pkgutil
import re
from collections.abc import Callable, Iterator
from importlib import import_module
from pydoc import locate

import pytest

import robobt
from robobt.plays import PLAYS
from robobt.skills import SKILLS

INNER = (
    "tree.nodes",
    "match.scenario",
    "match.referee",
    "match.results",
    "match.recording",
    "shots.data",
    "shots.collect",
    "shots.predict",
    "learning.envs",
    "learning.agents",
    "learning.training",
    "tournament.sweeps",
)
ROOMS = [
    *(name for _, name, _ in pkgutil.iter_modules(robobt.__path__) if name not in ("cli", "__main__")),
    *INNER,
]
RESULT = re.compile(
    r"\b[Rr]eturn|\b[Yy]ield|^(Build|Compute|Load|Make|Read|Sample|Summarise)\b", re.MULTILINE
)
"""How a docstring says what comes back: in words, or by a verb whose object it is."""


def exported() -> dict[int, object]:
    found: list[object] = [getattr(robobt, name) for name in robobt.__all__]
    for room in ROOMS:
        module = import_module(f"robobt.{room}")
        names = {*dir(module), *getattr(module, "_HOMES", ())}  # those imported on first use too
        found += [getattr(module, name) for name in names if not name.startswith("_")]
    found += [*(SKILLS[name] for name in SKILLS), *(PLAYS[name] for name in PLAYS)]
    return {id(one): one for one in found if (getattr(one, "__module__", None) or "").startswith("robobt.")}


REFERENCE = re.compile(r"(?:See|see|as for) :\w+:`~?([\w.]+)`")
"""How a docstring refers to another one, which then counts too."""


def text(documented: object, module: str) -> str:
    """Return a docstring with those that it refers to."""
    doc = inspect.getdoc(documented) or ""
    for name in REFERENCE.findall(doc):
        found = locate(name) or locate(f"{module}.{name}")
        doc += "\n" + (inspect.getdoc(found) or "") if found is not documented else ""
    return doc


def texts(owner: type, method: str) -> str:
    """Return the docstrings of a method and of those that it overrides."""
    found = (cls.__dict__.get(method) for cls in owner.__mro__)
    return "\n".join(text(one, owner.__module__) for one in found if one is not None)


def unsaid(function: Callable[..., object], doc: str, *, returns: bool) -> Iterator[str]:
    signature = inspect.signature(inspect.unwrap(function))
    for name in signature.parameters:
        if name not in ("self", "cls") and name[0] != "_" and not re.search(rf"\b{name}\b", doc):
            yield name
    nothing = (None, "None", "NoReturn", inspect.Signature.empty)
    if returns and signature.return_annotation not in nothing and not RESULT.search(doc):
        yield "what is returned"


def of_class(owner: type) -> Iterator[tuple[str, list[str]]]:
    for name, member in vars(owner).items():
        function = getattr(member, "__func__", member.fget if isinstance(member, property) else member)
        if not inspect.isfunction(function) or not function.__module__.startswith("robobt."):
            continue  # made by a decorator, a dataclass's constructor for one
        if name == "__init__":
            doc = "\n".join(cls.__doc__ or "" for cls in owner.__mro__[:-1]) + texts(owner, name)
            yield name, list(unsaid(function, doc, returns=False))
        elif not name.startswith("_"):
            told = list(unsaid(function, texts(owner, name), returns=not isinstance(member, property)))
            yield name, told


def missing() -> dict[str, list[str]]:
    found, plays = {}, [PLAYS[name] for name in PLAYS]
    for one in exported().values():
        where = f"{getattr(one, '__module__', '')}.{getattr(one, '__qualname__', '')}"
        if inspect.isclass(one):
            found.update({f"{where}.{name}": told for name, told in of_class(one)})
        elif inspect.isfunction(one):
            # What a play returns is said once, of all.
            found[where] = list(unsaid(one, text(one, one.__module__), returns=one not in plays))
    return found


def test_each_parameter_and_result_is_spoken_of() -> None:
    found = missing()
    assert len(found) > 300
    assert {name: told for name, told in found.items() if told} == {}


def example(speed: float, limit: float) -> float:
    """Drive with a speed [m/s]."""
    return min(speed, limit)


@pytest.mark.parametrize(
    ("doc", "left"),
    [
        (example.__doc__, ["limit", "what is returned"]),
        ("Return the speed within a limit.", []),
        ("Return what the speeds are.", ["speed", "limit"]),
    ],
)
def test_what_is_not_spoken_of_is_found(doc: str, left: list[str]) -> None:
    assert list(unsaid(example, doc, returns=True)) == left


ENTRY = re.compile(r"[.;\]] ([a-z_]\w*(, [a-z_]\w*)+|[A-Z]\w*Error): ")
"""An entry of a section that goes on behind another one, where readers and documentation do not find it."""


def test_each_entry_of_a_section_has_a_line_of_its_own() -> None:
    found = []
    for one in exported().values():
        for member in (one, *(vars(one).values() if inspect.isclass(one) else ())):
            doc = inspect.getdoc(member) if callable(member) else None
            sections = re.search(r"^(Args|Attributes|Raises):.*", doc or "", re.MULTILINE | re.DOTALL)
            if sections and (run_on := ENTRY.search(sections[0])):
                found.append((getattr(member, "__qualname__", ""), run_on[1]))
    assert found == []


def test_an_entry_behind_another_is_found() -> None:
    assert ENTRY.search("    time: simulated duration [s]. blue_score, yellow_score: goals.")
    assert ENTRY.search("    ModelError: it is damaged. OSError: it cannot be read.")
    assert not ENTRY.search("    low, high: its interval; None: unknown.")
