"""What numba compiles runs wherever it is installed."""

from __future__ import annotations

import ast
import pickle
import sys
from collections.abc import Iterator
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba import TypingError, njit
from numba.core.caching import NullCache
from numba.core.event import Event, Listener, install_listener, register, unregister
from pydantic import BaseModel

import robobt
from robobt.config import compiling as config_compiling
from robobt.config.compiling import compile_nothing
from robobt.world.compiled import (
    compilable,
    compiled,
    compiled_inline,
    compiled_lean,
    compiled_merged,
    numbers_dtype,
    numbers_of,
    record_dtype,
    timing_compilation,
)
from robobt.world.compiler import TOLD, CompilingTold


def test_where_nothing_is_compiled_functions_stay_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(config_compiling, "_compiling", True)
    compile_nothing()

    def double(x: float) -> float:
        return 2.0 * x

    for decorator in (compiled, compiled_lean, compiled_inline, compiled_merged, compilable):
        assert decorator(double) is double


def test_code_that_cannot_be_kept_is_compiled_all_the_same() -> None:
    # numba finds no folder for code that is in no file, as for that of a read-only installation.
    words: dict[str, Any] = {}
    exec("def double(x): return 2 * x", words)
    assert compiled(words["double"])(3) == 6


def test_code_without_counted_references_makes_no_arrays() -> None:
    words: dict[str, Any] = {"np": np}
    exec("def make(n): return np.zeros(n).sum()", words)
    with pytest.raises(TypingError):
        compiled_lean(words["make"])(3)


def test_nor_does_it_call_what_returns_some() -> None:
    """It would never free them."""
    texts = [file.read_text() for file in Path(robobt.__file__).parent.rglob("*.py")]
    trees = [ast.parse(text) for text in texts if "@compiled" in text]
    functions = [
        (node, [ast.unparse(each) for each in node.decorator_list])
        for tree in trees
        for node in tree.body
        if isinstance(node, ast.FunctionDef)
    ]
    making = {
        node.name
        for node, decorators in functions
        if node.returns and "Array" in ast.unparse(node.returns) and "compiled" in decorators
    }
    lean = [node for node, decorators in functions if {"compiled_lean", "compiled_inline"} & set(decorators)]
    called = {
        each.func.id
        for node in lean
        for each in ast.walk(node)
        if isinstance(each, ast.Call) and isinstance(each.func, ast.Name)
    }
    assert len(lean) > 40
    assert "team_view_rows" in making
    assert not called & making


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


@compilable
def _halved(x: float) -> float:
    return 0.5 * x


@compiled_merged
def _lifted(x: float) -> float:
    return _halved(x) + 1.0


@compiled
def _scaled(x: float, twice: bool) -> float:
    return 2.0 * x if twice else x


@compiled
def _summed(x: float) -> float:
    return _lifted(x) + _scaled(x, True) + _scaled(x, False)


class _Compilations(Listener):
    """The names of the functions that are compiled."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def on_start(self, event: Event) -> None:
        if event.data is not None:
            self.names.append(event.data["dispatcher"].__name__)

    def on_end(self, event: Event) -> None:
        pass


def test_functions_are_compiled_once_and_merged_ones_with_their_callers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    listener = _Compilations()
    for function in (_summed, _scaled, _lifted):
        made: Any = function
        monkeypatch.setattr(made, "_cache", NullCache())
        monkeypatch.setattr(made._part, "_cache", NullCache())
    with install_listener("numba:compile", listener):
        assert _summed(3.0) == 11.5
    # The constants True and False are no types of their own.
    assert listener.names == ["_summed", "_scaled"]


def test_python_can_call_what_is_compiled_for_compiled_code_only() -> None:
    assert _summed(3.0) == 11.5
    assert _scaled(3.0, True) == 6.0
    assert _lifted(3.0) == 2.5
    assert _halved(3.0) == 1.5


def test_a_compiled_function_can_be_sent_to_another_process() -> None:
    made: Any = _scaled
    states = made._reduce_states()
    # As another process has not met it before.
    again = type(made)._rebuild(**{**states, "uuid": "of another process"})
    assert again is not made
    assert again(3.0, True) == 6.0
    assert pickle.loads(pickle.dumps(made)) is made


class _Pair:
    first: float
    second: float


_PAIR = record_dtype(_Pair)


@compiled
def _differences(rows: np.ndarray) -> np.ndarray:
    pairs = rows.view(_PAIR)
    return np.array([pair.second - pair.first for pair in pairs.ravel()])


def test_compiled_code_views_an_array_as_records() -> None:
    rows = np.arange(12.0).reshape(3, 4) ** 2
    assert _differences(rows).tolist() == [1.0, 5.0, 9.0, 13.0, 17.0, 21.0]
    assert _differences(rows[::2]).tolist() == [1.0, 5.0, 17.0, 21.0]
    assert _differences(rows[:, :0]).tolist() == []


@pytest.mark.parametrize("columns", [slice(3), slice(None, None, 2)])
def test_an_array_that_holds_no_records_is_refused(columns: slice) -> None:
    with pytest.raises(ValueError, match="does not hold records"):
        _differences(np.arange(12.0).reshape(3, 4)[:, columns])


@pytest.fixture
def _by_no_other() -> Iterator[None]:
    unregister("numba:compile", TOLD)
    yield
    register("numba:compile", TOLD)


@pytest.mark.usefixtures("_by_no_other")
@pytest.mark.parametrize(("terminal", "lines"), [(True, 1), (False, 0)])
def test_a_run_that_waits_for_the_compiler_is_told_so_once_on_a_terminal(
    terminal: bool, lines: int, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    # Set now, it is put back as it was.
    monkeypatch.setenv("ROBOBT_COMPILING_TOLD", "")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    functions = [njit(lambda x, by=by: x + by) for by in range(3)]
    with install_listener("numba:compile", CompilingTold(0.0)):
        for function in functions:
            function(1.0)
    assert [record.name for record in caplog.records] == ["robobt.world.compiler"] * lines


@pytest.mark.usefixtures("_by_no_other")
def test_what_is_compiled_already_or_in_a_moment_is_not_told(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with install_listener("numba:compile", CompilingTold(60.0)):
        njit(lambda x: x + 2.0)(1.0)
        njit(lambda x: x + 3.0)(1.0)
    with install_listener("numba:compile", CompilingTold(0.0)):
        _read(numbers_of(_Limits()))
        _read(numbers_of(_Limits()))
    assert not caplog.records
