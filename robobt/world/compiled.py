"""Compiling with numba: the decorator, and settings that compiled code can read."""

from __future__ import annotations

import logging
import multiprocessing
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from math import inf
from typing import Annotated, Any, TypeVar, cast, get_args, get_origin, get_type_hints

import numpy as np
from numba import njit
from numba.core.event import Event, TimingListener, install_listener, register
from numba.extending import register_jitable
from numpy.typing import NDArray
from pydantic import BaseModel

from robobt.world.compiled_key import COMPILING, DeepCache

_log = logging.getLogger(__name__)

_COMPILING_VARIABLE = "ROBOBT_COMPILING_TOLD"
"""Set in the environment, which workers inherit."""

_REPORTED_COMPILE_TIME = 2.0
"""Compilation time after which a message is printed [s]."""
FloatArray = NDArray[np.float64]
Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """Compile at first use, and cache the result if a folder is writable."""
    return _compiled(function)


def compiled_lean(function: Function) -> Function:
    """Compile a function that makes no arrays, without counting references to those it sees.

    Each view of an array that compiled code looks at is counted, atomically, which costs more than most of
    what an inner loop does with it. Numba refuses to compile a function so that makes an array after all, or
    one that it calls. An array that such a function is given by another would never be freed: a test looks
    for such calls.
    """
    return _compiled(function, _nrt=False)


def compiled_inline(function: Function) -> Function:
    """Compile as :func:`compiled_lean` does a part of a larger function, into which it goes without a call.

    A call passes each array as seven numbers, and all those of a named tuple.
    """
    return _compiled(function, _nrt=False, forceinline=True)


def _compiled(function: Function, **options: Any) -> Function:
    made = njit(**options)(function)
    # A read-only installation, run by a user without a home folder, has no cache and compiles each time.
    with suppress(RuntimeError):
        made._cache = DeepCache(function)
    return cast(Function, made)


@contextmanager
def timing_compilation() -> Iterator[Callable[[], float]]:
    """Yield a function that returns numba's compilation time since then [s], without loading from cache."""
    listener = TimingListener()  # type: ignore[no-untyped-call]
    with install_listener(COMPILING, listener):
        yield lambda: float(listener.duration) if listener.done else 0.0


class CompilingTold(TimingListener):
    """Prints once, on a terminal, that a run waits for the compiler; short waits are not reported."""

    def __init__(self, patience: float = _REPORTED_COMPILE_TIME) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._patience = patience
        # The first worker prints for all, unless the process that started it has done so.
        name = multiprocessing.current_process().name
        worker = multiprocessing.parent_process() is not None
        self._told = worker and (_COMPILING_VARIABLE in os.environ or not name.endswith("-1"))

    def on_start(self, event: Event) -> None:
        """Note that a function is being compiled, and how long those before it took."""
        super().on_start(event)  # type: ignore[no-untyped-call]
        if self._told or not self.done or self.duration < self._patience or not sys.stderr.isatty():
            return
        self._told = True
        os.environ[_COMPILING_VARIABLE] = "1"
        _log.warning(
            "compiling for this machine, as on the first run after an installation or an update: "
            "a minute or more, once; later runs load what was compiled"
        )


TOLD = CompilingTold()
# Code that was kept and is only loaded does not count as compiled.
register(COMPILING, TOLD)  # type: ignore[no-untyped-call]


def compilable(function: Function) -> Function:
    """Leave a function as it is for Python, which calls it faster so, and let compiled code call it too."""
    return register_jitable(function)


@cache
def numbers_dtype(model: type[BaseModel]) -> np.dtype[np.void]:
    """Return the record of a settings model's numbers, as which compiled code reads :func:`numbers_of`.

    ``numbers.view(DTYPE)[0]`` has the fields by name. Compiled functions take the plain array: numba needs
    many times as long to look at the type of a record when it is called.
    """
    kinds = (bool, int, float, int | None, float | None)
    return np.dtype([(name, "f8") for name, field in model.model_fields.items() if field.annotation in kinds])


def record_dtype(kind: type) -> np.dtype[np.record]:
    """Return the record with a class's annotated fields: numbers, other records, and settings' numbers.

    ``Annotated[Sequence[X], 4]`` are four of them, and an :data:`Index` is stored as an integer.
    """
    hints = get_type_hints(kind, include_extras=True)
    fields = [(name, _field_dtype(hint)) for name, hint in hints.items()]
    return cast("np.dtype[np.record]", np.dtype((np.record, fields)))


Index = Annotated[int, np.int64]
"""A record's field that is stored as an integer; other numbers are stored as floats."""


def _field_dtype(hint: Any) -> np.dtype[Any]:
    if hint == Index:
        return np.dtype(np.int64)
    if get_origin(hint) is Annotated:
        several, count = get_args(hint)
        return np.dtype((_field_dtype(*get_args(several)), (count,)))
    if hint in (float, int, bool):
        return np.dtype(np.float64)
    return numbers_dtype(hint) if issubclass(hint, BaseModel) else record_dtype(hint)


@compilable
def records(count: int, dtype: np.dtype[np.record]) -> Any:
    """Return this number of records, not filled in."""
    return np.empty(count, dtype=dtype)


def numbers_of(settings: BaseModel, dtype: np.dtype[np.void] | None = None) -> FloatArray:
    """Return the numbers among a settings model's fields, (m,); None, for no limit, becomes infinity.

    ``dtype`` is that of a class which the model is derived from, for its fields alone.
    """
    names = (numbers_dtype(type(settings)) if dtype is None else dtype).names or ()
    values = [getattr(settings, name) for name in names]
    return np.array([inf if value is None else value for value in values], dtype=np.float64)
