"""Whether a tree runs only robobt's own code, so that nobody has to watch its effects on shared objects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour

from robobt.tree.engine.closures import has_method_of
from robobt.tree.registry import Registry

_PY_TREES = (composites.__name__, decorators.__name__)
_OWN_METHODS = ("initialise", "on_running", "stop", "terminate", "tick", "update")


def only_own_code(nodes: Iterable[Behaviour]) -> bool:
    """Return whether all nodes are robobt's or py_trees' own, and made from plain values or robobt's objects.

    In doubt the answer is False: for a function among the parameters, for a name under which another package
    or a user's file has registered something, and for a node with a method of its own.
    """
    return all(map(_is_own, nodes))


def _is_own(node: Behaviour) -> bool:
    cls = type(node)
    if cls.__module__ in _PY_TREES:
        return cls is not decorators.EternalGuard
    if _package(cls) != "robobt":
        return False
    if not all(has_method_of(cls, node, name) for name in _OWN_METHODS if hasattr(cls, name)):
        return False
    args, kwargs = getattr(node, "_given", ((), {}))
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
    # Nodes are looked at for themselves.
    return isinstance(value, Behaviour) or (_package(type(value)) == "robobt" and not callable(value))


def _package(cls: type) -> str:
    return cls.__module__.partition(".")[0]
