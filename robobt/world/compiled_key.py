"""The cache key of compiled code: everything that it depends on, and nothing else.

Numba's own key has the compiled function, and the time and size of its file. After a change of another file,
a function called from it would keep running as compiled before; and after a change of a comment, all
functions of the file would be compiled again.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from uuid import uuid4

import numpy as np
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.dispatcher import Dispatcher
from numba.core.event import Event, Listener, register, trigger_event

from robobt.world import compiled_views
from robobt.world.compiled_lock import CompilingTurn

COMPILING = "numba:compile"
"""Numba's name for the event that a function is compiled."""

_MOST_VERSIONS = 16
"""Number of versions of a function that are kept: for other types, or from before a change."""

_GENERATED = sha256(Path(compiled_views.__file__).read_bytes()).hexdigest()
"""What changes with the instructions that this package generates itself."""

_CONSTANTS = (bool, int, float, str, tuple, frozenset, np.generic, np.dtype)


class _Failed(Listener):
    """Ends the turn of a function that cannot be compiled, and so is not kept."""

    def on_start(self, event: Event) -> None:
        """Do nothing."""

    def on_end(self, event: Event) -> None:
        """End the turn if the compilation raised."""
        if event._exc_details is not None and event.data is not None:
            COMPILING_TURN.end(event.data["dispatcher"].py_func)


COMPILING_TURN = CompilingTurn()
register(COMPILING, _Failed())  # type: ignore[no-untyped-call]


class _Index(IndexDataCacheFile):
    """Numba's cache index, which may name types that no longer exist.

    A data file never changes: a process that has read the index finds the version that it asks for, or none.
    """

    def _load_index(self) -> dict[object, str]:
        try:
            kept: dict[object, str] = super()._load_index()  # type: ignore[no-untyped-call]
        except (AttributeError, ImportError):
            return {}
        return kept

    def save(self, key: object, data: object) -> None:
        """Keep a version, and remove those that were kept first if there are too many."""
        kept = self._load_index()
        name = self._data_name(uuid4().int >> 64)  # type: ignore[no-untyped-call]
        # The code before the index that names it.
        self._save_data(name, data)  # type: ignore[no-untyped-call]
        removed = [kept.pop(key)] if key in kept else []
        removed += [kept.pop(next(iter(kept))) for _ in range(len(kept) + 1 - _MOST_VERSIONS)]
        self._save_index({**kept, key: name})  # type: ignore[no-untyped-call]
        for old in removed:
            with suppress(OSError):
                Path(self._data_path(old)).unlink()  # type: ignore[no-untyped-call]


class DeepCache(FunctionCache):
    """Numba's cache of a function's compiled code, with the called functions in its key."""

    def __init__(self, function: Callable[..., object], options: Mapping[str, object]) -> None:
        super().__init__(function)  # type: ignore[no-untyped-call]
        self._options = _told_options(options)
        # Not by line and time of the file: the key has what matters in it.
        name = f"{Path(function.__code__.co_filename).stem}.{function.__qualname__}".replace("<", "").replace(
            ">", ""
        )
        base = f"{name}.py{sys.version_info[0]}{sys.version_info[1]}"
        self._cache_file = _Index(self._cache_path, base, "")  # type: ignore[no-untyped-call]

    def load_overload(self, sig: object, target_context: object) -> object:
        """Return the code kept for these types; None if this process has to compile it.

        If another process is compiling, this one waits for it.
        """
        found = super().load_overload(sig, target_context)  # type: ignore[no-untyped-call]
        if found is not None:
            return found
        # Waiting for another process takes the time of compiling.
        with trigger_event(COMPILING):
            begun = COMPILING_TURN.begin(self._py_func, self._cache_path)
        if begun:
            found = super().load_overload(sig, target_context)  # type: ignore[no-untyped-call]
            if found is not None:
                COMPILING_TURN.end(self._py_func)
        return found

    def save_overload(self, sig: object, data: object) -> None:
        """Keep compiled code, and let other processes go on."""
        try:
            super().save_overload(sig, data)  # type: ignore[no-untyped-call]
        finally:
            COMPILING_TURN.end(self._py_func)

    def _index_key(self, sig: object, codegen: object) -> tuple[object, ...]:
        own: tuple[object, ...] = super()._index_key(sig, codegen)  # type: ignore[no-untyped-call]
        return (*own, self._key, self._options, _GENERATED)

    @cached_property
    def _key(self) -> str:
        # Not before it is asked: what a function calls may stand behind it in its module.
        return key_of(self._py_func)


def key_of(function: Callable[..., object]) -> str:
    """Return what changes with the code of a function, of those it calls, and of the constants they read."""
    found = sha256()
    for part in _parts(function, set()):
        found.update(part.encode())
    return found.hexdigest()


def _parts(function: object, seen: set[int]) -> Iterator[str]:
    if isinstance(function, Dispatcher):
        yield _told_options(function.targetoptions)
        function = function.py_func
    if not isinstance(function, FunctionType) or id(function) in seen:
        return
    seen.add(id(function))
    yield from _code(function.__code__)
    yield _told((function.__defaults__, sorted((function.__kwdefaults__ or {}).items())))
    names = _names(function.__code__)
    for name in sorted(names):
        yield from _value(name, function.__globals__.get(name), names, seen)
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        yield from _value(name, cell.cell_contents, names, seen)


def _value(name: str, value: object, names: set[str], seen: set[int]) -> Iterator[str]:
    """Yield what changes with a value that code reads by its name, itself or an attribute among ``names``."""
    if isinstance(value, np.ndarray):
        yield f"{name}={value.tolist()!r}"
    elif isinstance(value, _CONSTANTS):
        yield f"{name}={_told(value)}"
    elif isinstance(value, type):
        # A named tuple's fields are read by their places, an enumeration's members by their values.
        members = {key: one.value for key, one in getattr(value, "__members__", {}).items()}
        yield f"{name}={getattr(value, '_fields', ())}{members}"
    elif isinstance(value, ModuleType):
        if value.__name__.partition(".")[0] not in ("numpy", "numba", *sys.stdlib_module_names):
            for attribute in sorted(names & vars(value).keys()):
                yield from _value(f"{name}.{attribute}", vars(value)[attribute], names, seen)
    elif not str(getattr(value, "__module__", "")).startswith(("numpy", "numba")):
        yield from _parts(value, seen)


def _told_options(options: Mapping[str, object]) -> str:
    return repr(sorted(options.items()))


def _names(code: CodeType) -> set[str]:
    inner = (_names(constant) for constant in code.co_consts if isinstance(constant, CodeType))
    return {*code.co_names, *(name for names in inner for name in names)}


def _code(code: CodeType) -> Iterator[str]:
    yield f"{code.co_name}{code.co_code.hex()}{code.co_names}{code.co_varnames}"
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield _told(constant)


def _told(constant: object) -> str:
    # The order of a set differs from process to process.
    return repr(sorted(map(repr, constant)) if isinstance(constant, frozenset) else constant)
