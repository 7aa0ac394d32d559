"""Errors in the code of a play, with file and line."""

from __future__ import annotations

import inspect
import traceback
from collections.abc import Callable, Iterable
from pathlib import Path
from weakref import WeakValueDictionary

from py_trees.behaviour import Behaviour

from robobt.config.errors import RobobtError, message_of, short_repr
from robobt.plays.sources import NOBODYS
from robobt.tree.walk import fault_of, preorder


class PlayError(RobobtError):
    """A play's code raises while its tree is built, or returns no tree."""


_OTHERS = NOBODYS | {"py_trees"}
"""Top-level names of modules that contain no play."""


_built: WeakValueDictionary[int, Behaviour] = WeakValueDictionary()
"""The nodes of all trees that plays have returned, by id()."""


def mistake_in_play(error: BaseException) -> str:
    """Return the message of an exception from building a tree, with the play's file and line.

    An exception without code outside robobt and py_trees in its traceback is left unchanged.
    """
    places = [
        (Path(frame.f_code.co_filename).name, line)
        for frame, line in traceback.walk_tb(error.__traceback__)
        if str(frame.f_globals.get("__name__")).partition(".")[0] not in _OTHERS
        # If another package raises, the play called it.
        and "site-packages" not in frame.f_code.co_filename
        and frame.f_globals.get("__file__") is not None
    ]
    said = _wrong_child(error) or message_of(error)
    if not places:
        return said
    # robobt's errors are whole sentences; other errors need their type's name.
    whole = isinstance(error, RobobtError | ValueError) or not error.args
    kind = "" if whole else f"{type(error).__name__}: "
    file, line = places[-1]
    return f"{file}:{line}: {kind}{said}"


def check_returned(name: str, builder: Callable[..., object], returned: object) -> None:
    """Check that a play returned a tree: of nodes, each only once and in no earlier tree.

    Raises:
        PlayError: it is no tree; the message names the play, its file and its line.
    """
    problem = _no_tree(returned)
    if problem is None:
        assert isinstance(returned, Behaviour)
        nodes = preorder(returned)
        if any(_built.get(id(node)) is node for node in nodes):
            problem = "returns the same nodes each time; a play builds a new tree whenever it is called"
        _built.update({id(node): node for node in nodes})
    if problem is not None:
        code = getattr(inspect.unwrap(builder), "__code__", None)
        where = "" if code is None else f"{Path(code.co_filename).name}:{code.co_firstlineno}: "
        raise PlayError(f"{where}the play {name!r} {problem}")


def _no_tree(returned: object) -> str | None:
    if returned is None:
        return "returns nothing; return the root of its tree"
    if inspect.isgenerator(returned) or inspect.iscoroutine(returned):
        return f"is a {type(returned).__name__}; write 'def' and 'return', without 'yield' or 'async'"
    seen: set[int] = set()
    left = [(returned, "")]
    while left:
        node, where = left.pop()
        problem = _no_node(node)
        if problem is not None:
            return f"does not return a tree: {where}{problem}"
        assert isinstance(node, Behaviour)
        if id(node) in seen:
            continue
        seen.add(id(node))
        children: object = node.children
        if not isinstance(children, list | tuple):
            return f"does not return a tree: the children of {node.name!r} are not a list"
        left += [(child, f"below {node.name!r}, ") for child in children]
    assert isinstance(returned, Behaviour)
    fault = fault_of(returned)
    return None if fault is None else f"does not return a tree: {fault[0].name}: {fault[1]}"


def _no_node(given: object) -> str | None:
    """Return what is wrong with an object in place of a node, or None for a node."""
    if isinstance(given, Behaviour):
        name = type(given).__name__
        made = hasattr(given, "children")
        return None if made else f"{name} is not set up; let {name}.__init__ call super().__init__(...)"
    if isinstance(given, type) and issubclass(given, Behaviour):
        return f"{given.__name__} is a class; {given.__name__}() makes a node of it"
    if inspect.isfunction(given) or inspect.ismethod(given):
        return f"{given.__name__} is a function; call it, as {given.__name__}()"
    if isinstance(given, list | tuple | set | dict):
        return f"a {type(given).__name__} is not a node; put its nodes into a Sequence, Selector or Parallel"
    return f"{short_repr(given)} is not a node"


def _wrong_child(error: BaseException) -> str | None:
    """Return what is wrong with children that a py_trees node would refuse, or None."""
    for frame, _ in traceback.walk_tb(error.__traceback__):
        if not str(frame.f_globals.get("__name__")).startswith("py_trees."):
            continue
        children = frame.f_locals.get("children")
        if children is not None and (isinstance(children, str) or not isinstance(children, Iterable)):
            said = type(children).__name__ if isinstance(children, Behaviour) else short_repr(children)
            return f"children takes a list of nodes, as children=[...], not {said}"
        problem = _no_node(frame.f_locals["child"]) if "child" in frame.f_locals else None
        if problem is not None:
            return problem
    return None
