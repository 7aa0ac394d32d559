"""Compiling functions before they are called: of each the name and the types of its arguments, in a line.

A line is ``robobt.motion.arrival:arrival_time (float64[::1], float64, float64, float64)``, the types as numba
writes them.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from numba.core import types
from numba.core.sigutils import normalize_signature

from robobt.world.compiler import CALLED_BY_PYTHON, CalledByPython


def compile_line(line: str) -> None:
    """Compile one function for given types and keep it, or load what is kept."""
    name, _, given = line.partition(" ")
    module, _, function = name.partition(":")
    made: CalledByPython = getattr(import_module(module), function)
    made.compile(normalize_signature(given)[0])  # type: ignore[no-untyped-call]


def compiled_lines() -> list[str]:
    """Return a line for each version of robobt's functions that Python has called in this process.

    Functions of records and other types that have no name are left out.
    """
    lines = []
    for function in CALLED_BY_PYTHON:
        if not function.__module__.startswith("robobt."):
            continue
        for kinds in function.overloads:
            text = f"({', '.join([_text(kind) for kind in kinds])},)"
            # Those that have no name cannot be read.
            with suppress(Exception):
                if normalize_signature(text)[0] == kinds:  # type: ignore[no-untyped-call]
                    lines.append(f"{function.__module__}:{function.py_func.__qualname__} {text}")
    return sorted(lines)


def is_kept(function: Callable[..., object]) -> bool:
    """Return whether some version of a compiled ``function`` is kept, or nothing can be kept."""
    index = getattr(getattr(function, "_cache", None), "_cache_file", None)
    return index is None or Path(index._index_path).exists()


def _text(kind: Any) -> str:
    if isinstance(kind, types.Array):
        last = "::1" if kind.layout == "C" else ":"
        return f"{_text(kind.dtype)}[{', '.join([*[':'] * (kind.ndim - 1), last])}]"
    if isinstance(kind, types.Tuple | types.UniTuple):
        return f"Tuple(({', '.join([_text(each) for each in kind.types])},))"
    return "boolean" if isinstance(kind, types.Boolean) else str(kind)
