"""One name says one thing: no constant and no class of a module has the name of another module's.

A constant that several modules need has one home, which the others import it from. A name that says
what the thing is (``_CONNECT_TIMEOUT``, not ``_PATIENCE``) seldom meets another.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import robobt

PACKAGE = Path(robobt.__file__).parent
ALLOWED = {
    "_HOMES": "the table of a package that imports its names on first use, by convention",
}
"""Names that several modules may have, each with the reason."""


def names_of(source: str) -> Iterator[str]:
    """Yield the constants and classes that the top level of a module defines; type variables are neither."""
    for node in ast.parse(source).body:
        if isinstance(node, ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign) and not is_type_variable(node.value):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            found = [name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)]
            yield from (name for name in found if name.isupper())


def is_type_variable(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Call) and ast.unparse(value.func) in ("TypeVar", "ParamSpec")


def twice(sources: dict[str, str]) -> dict[str, list[str]]:
    """Return the names that several modules define, and these modules."""
    homes: dict[str, list[str]] = {}
    for module, source in sources.items():
        for name in dict.fromkeys(names_of(source)):
            homes.setdefault(name, []).append(module)
    return {name: modules for name, modules in homes.items() if len(modules) > 1}


def test_a_name_is_defined_in_one_module() -> None:
    sources = {
        str(path.relative_to(PACKAGE)): path.read_text()
        for path in sorted(PACKAGE.rglob("*.py"))
        if "_pb2" not in path.name
    }
    found = twice(sources)
    assert {name: modules for name, modules in found.items() if name not in ALLOWED} == {}
    assert sorted(ALLOWED) == sorted(found.keys() & ALLOWED.keys()), "a name is allowed that nobody has twice"


def test_what_counts_as_a_name_that_two_modules_have() -> None:
    one = "_NEAR = 0.2\n_A, _B = 1, 2\nT = TypeVar('T')\nlocal = 3\nclass Part: ...\n"
    other = "_NEAR: float = 0.3\n_B = 2\nT = TypeVar('T')\nlocal = 4\nclass Part: ...\ndef f():\n    _A = 1\n"
    both = ["one", "other"]
    assert twice({"one": one, "other": other}) == {"_NEAR": both, "_B": both, "Part": both}
    assert twice({"one": one, "other": "from one import _NEAR, Part\nOTHER = 1\n"}) == {}
