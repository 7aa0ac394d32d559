"""What numba compiles runs wherever it is installed."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
from numba import njit
from pydantic import BaseModel

from robobt.world.compiled import compiled, numbers_dtype, numbers_of, timing_compilation


def test_code_that_cannot_be_kept_is_compiled_all_the_same() -> None:
    # numba finds no folder for code that is in no file, as for that of a read-only installation.
    words: dict[str, Any] = {}
    exec("def double(x): return 2 * x", words)
    assert compiled(words["double"])(3) == 6


class _Limits(BaseModel):
    speed: float = 2.0
    rule: str = "near"
    ticks: int = 3
    always: bool = True
    longest: float | None = None


_LIMITS = numbers_dtype(_Limits)


@compiled
def _read(numbers: np.ndarray) -> float:
    limits = numbers.view(_LIMITS)[0]
    return limits.speed * limits.ticks if limits.always else limits.longest


def test_compiled_code_reads_settings_by_name() -> None:
    assert _read(numbers_of(_Limits())) == 6.0
    assert _read(numbers_of(_Limits(always=False))) == inf
    assert _read(numbers_of(_Limits(always=False, longest=0.5))) == 0.5


def test_compiling_is_timed_and_what_is_compiled_already_is_not() -> None:
    @njit
    def grown(x: float) -> float:
        return x + 1.0

    with timing_compilation() as compiling:
        assert compiling() == 0.0
        grown(1.0)
        first = compiling()
        grown(2.0)
        assert compiling() == first > 0.0
