"""Compiling with numba: the decorators, and settings that compiled code can read.

numba itself is imported by the first function that is decorated, and by none where nothing is compiled
(:mod:`robobt.config.compiling`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from math import inf
from typing import Annotated, Any, TypeVar, cast, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from robobt.config.compiling import compiles

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


def compiled_merged(function: Function) -> Function:
    """Make a function part of the compiled functions that call it, each of which is compiled with its code.

    For small functions, and for those with one caller: to compile them on their own takes longer. One that
    is large makes its callers slow to compile. Python can call it too.
    """
    return _compiled(function, inline="always")


def _compiled(function: Function, **options: Any) -> Function:
    if not compiles():
        return function
    from robobt.world.compiler import compile_function

    return compile_function(function, **options)


@contextmanager
def timing_compilation() -> Iterator[Callable[[], float]]:
    """Yield a function that returns numba's compilation time since then [s], without loading from cache."""
    from numba.core.event import TimingListener, install_listener

    from robobt.world.compiled_key import COMPILING

    listener = TimingListener()  # type: ignore[no-untyped-call]
    with install_listener(COMPILING, listener):
        yield lambda: float(listener.duration) if listener.done else 0.0


def compilable(function: Function) -> Function:
    """Leave a function as it is for Python, which calls it faster so, and let compiled code call it too."""
    if not compiles():
        return function
    from robobt.world.compiler import inlined_function

    return inlined_function(function)


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
