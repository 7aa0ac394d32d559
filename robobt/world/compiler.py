"""numba: how functions are compiled and kept, how long it takes, and a message where a run waits for it."""

from __future__ import annotations

import logging
import multiprocessing
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar, cast

from numba import njit
from numba.core.event import Event, TimingListener, register
from numba.extending import register_jitable as register_jitable

from robobt.world.compiled_key import COMPILING, DeepCache

_log = logging.getLogger(__name__)

_COMPILING_VARIABLE = "ROBOBT_COMPILING_TOLD"
"""Set in the environment, which workers inherit."""

_REPORTED_COMPILE_TIME = 2.0
"""Compilation time after which a message is printed [s]."""

Function = TypeVar("Function", bound=Callable[..., object])


def compile_function(function: Function, **options: Any) -> Function:
    """Return a function that is compiled at first use, and kept if a folder is writable.

    Args:
        function: the function.
        options: numba's.
    """
    made = njit(**options)(function)
    # A read-only installation, run by a user without a home folder, has no cache and compiles each time.
    with suppress(RuntimeError):
        made._cache = DeepCache(function)
    return cast(Function, made)


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
