"""Whether a tree runs only robobt's own code, so that nobody has to watch its effects on shared objects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property, partialmethod
from types import FunctionType

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from pydantic import BaseModel

from robobt.tree.engine.closures import has_method_of
from robobt.tree.leaf import Bound
from robobt.tree.registry import Registry

_PY_TREES = (composites.__name__, decorators.__name__)
_OWN_PACKAGES = ("robobt", "py_trees")


def only_own_code(nodes: Iterable[Behaviour]) -> bool:
    """Return whether all nodes are robobt's or py_trees' own, and made from plain values or robobt's objects.

    In doubt the answer is False: for a function among the parameters, for a name under which another package
    or a user's file has registered something, and for a node, or a class, with a method from elsewhere.
    """
    each = list(nodes)
    methods = {cls: _methods(cls) for cls in set(map(type, each))}
    return all(_is_own(node, methods[type(node)]) for node in each)


def _methods(cls: type) -> list[str] | None:
    """Return the names of the class's methods; None if any of them is not robobt's or py_trees'."""
    if cls.__module__ not in _PY_TREES and _package(cls) != "robobt":
        return None
    names: set[str] = set()
    for base in cls.__mro__:
        if _package(base) not in _OWN_PACKAGES:
            continue
        for name, value in vars(base).items():
            function = _function(value)
            if not callable(function) or isinstance(function, type):
                continue
            # Tests and users put functions of their own in the place of methods.
            if _package(function) not in _OWN_PACKAGES:
                return None
            if isinstance(value, FunctionType) and not name.startswith("__"):
                names.add(name)
    return sorted(names)


def _function(value: object) -> object:
    """Return the function behind a property or method of a class, or what is no such thing itself."""
    if isinstance(value, property):
        return value.fget
    if isinstance(value, partialmethod | cached_property):
        return value.func
    return getattr(value, "__func__", value)


def _is_own(node: Behaviour, methods: list[str] | None) -> bool:
    cls = type(node)
    if methods is None or cls is decorators.EternalGuard:
        return False
    if not all(has_method_of(cls, node, name) for name in methods):
        return False
    if not isinstance(node, Bound):
        return True
    if Registry.foreign:
        # A default may name something in whose place a user has registered something else.
        return _is_own_value(node.parameters())
    args, kwargs = node._given
    return _is_own_value(args) and _is_own_value(kwargs)


def _is_own_value(value: object) -> bool:
    if isinstance(value, str):
        return value not in Registry.foreign
    if value is None or isinstance(value, int | float):
        return True
    if isinstance(value, tuple | list | set | frozenset):
        return all(map(_is_own_value, value))
    if isinstance(value, Mapping):
        return all(map(_is_own_value, (*value.keys(), *value.values())))
    if isinstance(value, Behaviour):
        # Nodes are looked at for themselves.
        return True
    if _package(type(value)) != "robobt" or callable(value):
        return False
    return not isinstance(value, BaseModel) or all(map(_is_own_value, vars(value).values()))


def _package(thing: object) -> str:
    """Return the package of a class or function."""
    return (getattr(thing, "__module__", None) or "").partition(".")[0]
