"""numba: how functions are compiled and kept, how long it takes, and a message where a run waits for it."""

from __future__ import annotations

import logging
import multiprocessing
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar, cast
from weakref import WeakSet

from numba.core.event import Event, TimingListener, register
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.types import unliteral
from numba.extending import register_jitable

from robobt.config.compiling import COMPILING_TOLD
from robobt.world import compiled_views as compiled_views
from robobt.world.compiled_key import COMPILING, DeepCache

_log = logging.getLogger(__name__)

_REPORTED_COMPILE_TIME = 2.0
"""Compilation time after which a message is printed [s]."""

Function = TypeVar("Function", bound=Callable[..., object])


CALLED_BY_PYTHON: WeakSet[CalledByPython] = WeakSet()
"""All compiled functions that there are."""


class CalledByPython(CPUDispatcher):
    """A function that Python calls; compiled code that calls it is given another, without Python's way in.

    That way, which takes Python's objects apart and checks them, is a fifth of the work of compiling.

    Args:
        function: the function.
        variables: types of its variables; numba asks for them where it makes one that was pickled.
        options: numba's.
    """

    def __init__(
        self, function: Callable[..., object], variables: dict[str, Any] | None, options: dict[str, Any]
    ) -> None:
        super().__init__(function, variables, options)
        self._part: Any = CPUDispatcher(function, variables, {**options, "no_cpython_wrapper": True})
        made: Any
        for made in (self, self._part):
            # A read-only installation, run by a user without a home folder, compiles each time.
            with suppress(RuntimeError):
                made._cache = DeepCache(function, made.targetoptions)
        CALLED_BY_PYTHON.add(self)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """See numba: of these types, what compiled code calls."""
        # One version serves a constant and any other argument of that type.
        args, kws = tuple(map(unliteral, args)), {name: unliteral(kind) for name, kind in kws.items()}  # type: ignore[no-untyped-call]
        return self._for(args).get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        """See numba: of these types, the place of what compiled code calls."""
        return self._for(normalize_signature(sig)[0]).get_overload(sig)  # type: ignore[no-untyped-call]

    def _for(self, args: Any) -> Any:
        # What has been compiled for Python already is not compiled again.
        return super() if args in self.overloads else self._part


def compile_function(function: Function, **options: Any) -> Function:
    """Return a function that is compiled at first use, by numba's ``options``, and kept if possible."""
    made: Any = CalledByPython(function, None, {"nopython": True, "no_cfunc_wrapper": True, **options})
    return cast(Function, made)


def inlined_function(function: Function) -> Function:
    """Return a function as it is, which becomes part of each compiled function that calls it."""
    # By two attributes numba knows that the code of a function is to go into its callers. That the function
    # is registered gives its name a type there.
    made: Any = register_jitable(function)
    made.targetoptions, made.py_func = {"inline": "always"}, function
    return cast(Function, made)


class CompilingTold(TimingListener):
    """Prints once, on a terminal, that a run waits for the compiler; short waits are not reported."""

    def __init__(self, patience: float = _REPORTED_COMPILE_TIME) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._patience = patience
        # The first worker prints for all, unless the process that started it has done so.
        name = multiprocessing.current_process().name
        worker = multiprocessing.parent_process() is not None
        self._told = worker and (COMPILING_TOLD in os.environ or not name.endswith("-1"))

    def on_start(self, event: Event) -> None:
        """Note that a function is being compiled, and how long those before it took."""
        super().on_start(event)  # type: ignore[no-untyped-call]
        if self._told or not self.done or self.duration < self._patience or not sys.stderr.isatty():
            return
        self._told = True
        os.environ[COMPILING_TOLD] = "1"
        _log.warning(
            "compiling for this machine, as on the first run after an installation or an update: "
            "a minute or more, once; later runs load what was compiled"
        )


TOLD = CompilingTold()
# Code that was kept and is only loaded does not count as compiled.
register(COMPILING, TOLD)  # type: ignore[no-untyped-call]
