"""Whether functions are compiled: a command that only lists names starts sooner without the compiler."""

from __future__ import annotations

COMPILING_TOLD = "ROBOBT_COMPILING_TOLD"
"""Set in the environment, which workers inherit, once the user knows that a run waits for the compiler."""

_compiling = True


def compile_nothing() -> None:
    """Leave every function that is defined from now on to Python: it gives the same results, slowly.

    For a process that lists what there is and ends. To import numba takes a quarter of its time.
    """
    global _compiling
    _compiling = False


def compiles() -> bool:
    """Return whether a function that is defined now is compiled."""
    return _compiling
