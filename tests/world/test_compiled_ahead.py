"""Functions are compiled before they are called, from lines that name them."""

from __future__ import annotations

import numpy as np
import pytest
from numba import typeof
from numba.core.caching import NullCache

from robobt.motion.arrival import arrival_time
from robobt.world.compiled import compiled
from robobt.world.compiled_ahead import _text, compile_line, compiled_lines, is_kept
from robobt.world.compiler import CalledByPython


@compiled
def _thirds(values: np.ndarray, pair: tuple[int, bool]) -> float:
    return values.sum() / 3.0 if pair[1] else float(pair[0])


def test_a_line_compiles_a_function_for_its_types() -> None:
    made = _thirds
    assert isinstance(made, CalledByPython)
    compile_line(f"{__name__}:_thirds (float64[:, ::1], Tuple((int64, boolean,)),)")
    kinds = typeof(np.zeros((1, 1))), typeof((1, True))
    assert list(made.overloads) == [kinds]
    assert _thirds(np.ones((1, 6)), (1, True)) == 2.0
    assert list(made.overloads) == [kinds]


def test_each_version_that_python_has_called_has_a_line() -> None:
    mover = np.array([0.0, 0.0, 0.0, 0.0, 2.0, 3.0, 3.0, 1.0])
    assert arrival_time(mover, 1.0, 0.0, 0.0) > 0.0
    line = "robobt.motion.arrival:arrival_time (float64[::1], float64, float64, float64,)"
    assert line in compiled_lines()
    compile_line(line)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (True, "boolean"),
        (1, "int64"),
        (0.5, "float64"),
        (np.zeros(2, np.int64), "int64[::1]"),
        (np.zeros((3, 4))[:, ::2], "float64[:, :]"),
        (np.zeros((1, 2, 2), np.bool_), "boolean[:, :, ::1]"),
        ((0.5, 0.5), "Tuple((float64, float64,))"),
        ((0.5, (1, True)), "Tuple((float64, Tuple((int64, boolean,)),))"),
    ],
)
def test_types_are_named(value: object, text: str) -> None:
    assert _text(typeof(value)) == text


def test_what_is_kept_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    def unused(x: float) -> float:
        return x

    assert not is_kept(compiled(unused))
    arrival_time(np.array([0.0, 0.0, 0.0, 0.0, 2.0, 3.0, 3.0, 1.0]), 1.0, 0.0, 0.0)
    assert is_kept(arrival_time)
    # Where nothing can be kept, nothing is missing.
    monkeypatch.setattr(arrival_time, "_cache", NullCache())
    assert is_kept(arrival_time)
