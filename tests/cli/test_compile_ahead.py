"""What a first match needs is compiled in several processes, before it begins."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from inspect import signature

import pytest
from numba.core.sigutils import normalize_signature

from robobt.cli import compile_ahead as module
from robobt.cli.compile_ahead import LINES, TRAINING, _groups, compile_ahead, compile_before_first_match
from robobt.config.compiling import COMPILING_TOLD
from robobt.config.errors import RobobtError
from robobt.world import compiled_ahead
from robobt.world.compiler import CalledByPython
from tests.waiting import LIMIT

TEXT = LINES.read_text("utf-8")
LISTED = [line for line in TEXT.splitlines() if line != TRAINING]


def test_each_line_names_a_function_and_the_types_of_its_arguments() -> None:
    assert len(LISTED) > 30
    for line in LISTED:
        name, _, types = line.partition(" ")
        place, _, function = name.partition(":")
        made = getattr(import_module(place), function)
        assert isinstance(made, CalledByPython)
        assert len(normalize_signature(types)[0]) == len(signature(made.py_func).parameters)


PLAYING = """
import robobt
from robobt.world.compiled_ahead import compiled_lines
robobt.play_match(robobt.load_scenario("six_v_six").lasting(6.0), 1)
print(*compiled_lines(), sep="\\n")
"""


@pytest.mark.integration
def test_a_match_calls_what_is_listed_and_nothing_else() -> None:
    """If this fails, ``python -m benchmarks first_run --write`` brings the list up to date."""
    run = subprocess.run(
        [sys.executable, "-c", PLAYING], capture_output=True, text=True, check=True, timeout=LIMIT
    )
    called = run.stdout.splitlines()
    assert len(called) > 10
    assert set(called) <= set(TEXT.partition(TRAINING)[0].splitlines())


def test_the_functions_of_a_folder_go_to_one_process() -> None:
    text = "a.b.c:f (x)\na.b.d:g (x)\na.e.f:h (x)\n[training]\na.e.g:k (x)\n"
    assert _groups(text, training=False) == [("a.b.d:g (x)", "a.b.c:f (x)"), ("a.e.f:h (x)",)]
    assert _groups(text, training=True) == [("a.b.d:g (x)", "a.b.c:f (x)"), ("a.e.g:k (x)", "a.e.f:h (x)")]


@pytest.fixture
def listed(monkeypatch: pytest.MonkeyPatch, tmp_path):  # type: ignore[no-untyped-def]
    """Return a function that replaces the list by other lines."""

    # Set now, it is put back as it was.
    monkeypatch.setenv(COMPILING_TOLD, "")

    def listed(text: str) -> None:
        (tmp_path / "lines.txt").write_text(text)
        monkeypatch.setattr(module, "LINES", tmp_path / "lines.txt")

    return listed


def test_what_is_listed_is_compiled(listed) -> None:  # type: ignore[no-untyped-def]
    from robobt.motion.arrival import arrival_time

    listed(
        "robobt.motion.arrival:arrival_time (float64[::1], float64, float64, float64,)\nabsent.extra:f (x)\n"
    )
    compile_ahead(workers=1)
    assert isinstance(arrival_time, CalledByPython)
    assert normalize_signature("(float64[::1], float64, float64, float64)")[0] in arrival_time.overloads


def test_what_cannot_be_compiled_is_an_error(listed) -> None:  # type: ignore[no-untyped-def]
    listed("robobt.motion.arrival:nothing (float64,)\n")
    with pytest.raises(RobobtError, match="nothing"):
        compile_ahead(workers=1)


@pytest.mark.parametrize(
    ("kept", "cores", "compiled"), [(False, 2, True), (True, 2, False), (False, 1, False)]
)
def test_a_first_match_compiles_ahead(
    kept: bool, cores: int, compiled: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[bool] = []
    monkeypatch.setattr(compiled_ahead, "is_kept", lambda _: kept)
    monkeypatch.setattr(module, "cores", lambda: cores)
    monkeypatch.setattr(module, "compile_ahead", lambda: calls.append(True))
    compile_before_first_match()
    assert bool(calls) == compiled
