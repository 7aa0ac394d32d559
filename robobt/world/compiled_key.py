"""The cache key of compiled code: everything that it depends on.

Numba's own key has only the file of the compiled function. After a change of another file, a function called
from it would keep running as compiled before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from hashlib import sha256
from types import CodeType, FunctionType

import numpy as np
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.dispatcher import Dispatcher
from numba.core.event import Event, Listener, register, trigger_event

from robobt.world.compiled_lock import CompilingTurn

COMPILING = "numba:compile"
"""Numba's name for the event that a function is compiled."""

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
    """Numba's cache index, which may name types that no longer exist."""

    def _load_index(self) -> dict[object, str]:
        try:
            kept: dict[object, str] = super()._load_index()  # type: ignore[no-untyped-call]
        except (AttributeError, ImportError):
            return {}
        return kept


class DeepCache(FunctionCache):
    """Numba's cache of a function's compiled code, with the called functions in its key."""

    def __init__(self, function: Callable[..., object]) -> None:
        super().__init__(function)  # type: ignore[no-untyped-call]
        base, stamp = self._impl.filename_base, self._impl.locator.get_source_stamp()
        self._cache_file = _Index(self._cache_path, base, stamp)  # type: ignore[no-untyped-call]

    def load_overload(self, sig: object, target_context: object) -> object:
        """Return the code kept for these types; None if this process has to compile it.

        If another process is compiling, this one waits for it.

        Args:
            sig: the types.
            target_context: numba's, of the machine.
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
        """Keep compiled code, and let other processes go on.

        Args:
            sig: the types that it is for.
            data: the code.
        """
        try:
            super().save_overload(sig, data)  # type: ignore[no-untyped-call]
        finally:
            COMPILING_TURN.end(self._py_func)

    def _index_key(self, sig: object, codegen: object) -> tuple[object, ...]:
        own: tuple[object, ...] = super()._index_key(sig, codegen)  # type: ignore[no-untyped-call]
        return (*own, self._key)

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
        function = function.py_func
    if not isinstance(function, FunctionType) or id(function) in seen:
        return
    seen.add(id(function))
    yield from _code(function.__code__)
    yield _told(function.__defaults__)
    for name in sorted(_names(function.__code__)):
        value = function.__globals__.get(name)
        if isinstance(value, np.ndarray):
            yield f"{name}={value.tolist()!r}"
        elif isinstance(value, _CONSTANTS):
            yield f"{name}={_told(value)}"
        elif isinstance(value, type):
            # A named tuple's fields are read by their places, an enumeration's members by their values.
            members = {key: one.value for key, one in getattr(value, "__members__", {}).items()}
            yield f"{name}={getattr(value, '_fields', ())}{members}"
        elif not str(getattr(value, "__module__", "")).startswith(("numpy", "numba")):
            yield from _parts(value, seen)


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
