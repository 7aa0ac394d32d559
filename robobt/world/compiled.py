"""The decorator of everything that numba compiles."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

from numba import njit

Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """Compile on first use, and keep what was compiled where a folder can be written to."""
    try:
        made = njit(cache=True)(function)
    except RuntimeError:
        # A read-only installation, run by somebody without a home: compile anew each time.
        made = njit(function)
    return cast(Function, made)
