"""The state of Python objects at one moment, which can be put back any number of times.

Trees keep their state in many places: nodes, stores, the cells of compiled closures, skills' own objects. So
all objects that can be reached are looked at, and what each of them holds is kept. Objects keep their
identity, because compiled ticks refer to them.
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from enum import Enum
from functools import partial
from types import BuiltinFunctionType, CellType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np
from pydantic import BaseModel

from robobt.world.field import FieldGeometry
from robobt.world.game import GameState
from robobt.world.state import BallState, Frame, RobotState

_CONSTANT = (
    *(bool, int, float, complex, str, bytes, type(None), range, type, ModuleType, BuiltinFunctionType, Enum),
    *(BaseModel, FieldGeometry, GameState, Frame, RobotState, BallState),
)
"""What nothing changes: values, settings, frames."""

_LEFT_OUT = (
    "torch",
    "numba",
    "llvmlite",
    "pymunk",
    "logging",
    "threading",
    "_thread",
    "pyarrow",
    "onnxruntime",
)
"""Modules whose objects are left alone: they hold no state of a match, or none that can be reached."""


class Checkpoint:
    """What objects, and all that can be reached from them, hold now.

    Put back are lists, dictionaries, sets, deques, arrays, attributes, closures and random generators.
    Generators, files, threads and objects of compiled modules are left alone, and so are frames, settings and
    classes, which nothing changes.
    """

    def __init__(self, *roots: object) -> None:
        self._restore: list[Callable[[], object]] = []
        # Held, so that no other object gets the identity of one that was looked at.
        self._known: dict[int, object] = {}
        waiting: list[object] = list(roots)
        while waiting:
            one = waiting.pop()
            if isinstance(one, _CONSTANT) or id(one) in self._known:
                continue
            self._known[id(one)] = one
            self._look(one, waiting)

    def __len__(self) -> int:
        """Return how many parts of objects are put back."""
        return len(self._restore)

    def restore(self) -> None:
        """Put everything back."""
        for restore in self._restore:
            restore()

    def _look(self, one: Any, waiting: list[object]) -> None:
        """Keep what an object holds, and let the objects that it holds wait to be looked at."""
        kind = type(one)
        if isinstance(one, tuple | frozenset):
            waiting += one
        elif isinstance(one, list):
            held = list(one)
            waiting += held
            self._restore.append(partial(one.__setitem__, slice(None), held))
        elif isinstance(one, dict):
            self._keep_dict(one, waiting)
        elif isinstance(one, set | deque):
            kept = list(one)
            waiting += kept
            self._restore.append(partial(_refill, one, kept))
        elif isinstance(one, np.ndarray):
            if one.flags.writeable:
                self._restore.append(partial(one.__setitem__, ..., one.copy()))
        elif isinstance(one, np.random.Generator):
            self._restore.append(partial(setattr, one.bit_generator, "state", one.bit_generator.state))
        elif isinstance(one, random.Random):
            self._restore.append(partial(one.setstate, one.getstate()))
        elif isinstance(one, FunctionType):
            waiting += one.__closure__ or ()
        elif isinstance(one, MethodType):
            waiting.append(one.__self__)
            waiting.append(one.__func__)
        elif isinstance(one, partial):
            waiting += [one.func, one.args, one.keywords]
        elif isinstance(one, CellType):
            self._keep_cell(one, waiting)
        elif kind.__module__.partition(".")[0] not in _LEFT_OUT:
            self._keep_attributes(one, kind, waiting)

    def _keep_dict(self, one: dict[Any, Any], waiting: list[object]) -> None:
        held = dict(one)
        waiting += held.keys()
        waiting += held.values()
        self._restore.append(partial(_refill_dict, one, held))

    def _keep_cell(self, cell: CellType, waiting: list[object]) -> None:
        try:
            held = cell.cell_contents
        except ValueError:
            # It is empty so far.
            return
        waiting.append(held)
        self._restore.append(partial(setattr, cell, "cell_contents", held))

    def _keep_attributes(self, one: object, kind: type, waiting: list[object]) -> None:
        if hasattr(one, "__dict__"):
            self._keep_dict(vars(one), waiting)
        slots = {}
        for base in kind.__mro__:
            names = vars(base).get("__slots__", ())
            for name in (names,) if isinstance(names, str) else names:
                if name not in ("__dict__", "__weakref__") and hasattr(one, name):
                    slots[name] = getattr(one, name)
        if slots:
            waiting += slots.values()
            self._restore.append(partial(_set_all, one, slots))


def _refill(one: set[Any] | deque[Any], held: list[Any]) -> None:
    one.clear()
    one.update(held) if isinstance(one, set) else one.extend(held)


def _refill_dict(one: dict[Any, Any], held: dict[Any, Any]) -> None:
    # By identity: values such as arrays do not compare to one truth. The order counts, as loops follow it.
    if len(one) != len(held) or any(
        key is not kept or value is not there
        for (key, value), (kept, there) in zip(one.items(), held.items(), strict=True)
    ):
        one.clear()
        one.update(held)


def _set_all(one: object, values: dict[str, object]) -> None:
    for name, value in values.items():
        # Also past a frozen class.
        object.__setattr__(one, name, value)
