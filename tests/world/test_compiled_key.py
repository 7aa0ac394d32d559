"""Compiled code is kept for what it was made of, and for nothing else."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from enum import IntEnum
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np
import pytest

from robobt.world.compiled_key import _Index, key_of
from tests.waiting import LIMIT

INNER = """
from robobt.world.compiled import compilable
from constants import FACTOR
@compilable
def inner(x):
    return FACTOR * x + {added}
"""
OUTER = """
from robobt.world.compiled import compiled
from inner import inner
@compiled
def outer(x):
    return inner(x)
if __name__ == "__main__":
    print(outer(10.0), *outer.stats.cache_hits)
"""


FORKING = """
import os, runpy, sys
import robobt.world.compiled
sys.path.insert(0, "")
for line in sys.stdin:
    if os.fork() == 0:
        folder, script = line.strip().split("\\t")
        os.chdir(folder)
        runpy.run_path(script, run_name="__main__")
        sys.stdout.flush()
        os._exit(0)
    assert os.wait()[1] == 0
"""
"""Runs scripts, each in a process of its own which has imported numba: that takes longer than they do."""

Run = Callable[[str], list[str]]


@pytest.fixture(scope="module")
def forking() -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, "-B", "-c", FORKING]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        yield process
        process.stdin.close()
        assert process.wait(LIMIT) == 0


@pytest.fixture
def run(forking: subprocess.Popen[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run a script of the test's folder and return the words of the line that it prints."""
    monkeypatch.chdir(tmp_path)
    assert forking.stdin is not None
    assert forking.stdout is not None
    scripts, printed = forking.stdin, forking.stdout

    def run(script: str) -> list[str]:
        print(tmp_path, script, sep="\t", file=scripts, flush=True)
        return printed.readline().split()

    return run


def answer(run: Run, factor: float, added: float) -> list[str]:
    Path("constants.py").write_text(f"FACTOR = {factor}\n")
    Path("inner.py").write_text(INNER.format(added=added))
    Path("outer.py").write_text(OUTER)
    return run("outer.py")


def test_code_is_compiled_anew_where_something_that_it_calls_has_changed(run: Run) -> None:
    assert answer(run, 2.0, 0.5) == ["20.5"]
    value, *hits = answer(run, 2.0, 0.5)
    assert value == "20.5"
    assert len(hits) == 1
    assert answer(run, 2.0, 0.75) == ["20.75"]
    assert answer(run, 3.0, 0.75) == ["30.75"]
    # And what was there before is there still.
    assert len(answer(run, 2.0, 0.5)) == 2


def test_an_edit_that_changes_no_code_leaves_compiled_code_as_it_is(run: Run) -> None:
    assert answer(run, 2.0, 0.5) == ["20.5"]
    Path("outer.py").write_text("# A comment, which moves all lines.\n" + OUTER)
    assert len(run("outer.py")) == 2
    Path("outer.py").write_text(OUTER.replace("return inner(x)", "return inner(x) + 1.0"))
    assert run("outer.py") == ["21.5"]


def test_code_is_compiled_anew_with_other_options(run: Run) -> None:
    assert answer(run, 2.0, 0.5) == ["20.5"]
    for file, decorator in (("outer.py", "compiled"), ("inner.py", "compilable")):
        text = Path(file).read_text().replace(f"import {decorator}", "import compiled_lean")
        Path(file).write_text(text.replace(f"@{decorator}", "@compiled_lean"))
        assert run("outer.py") == ["20.5"]


def test_few_versions_are_kept(tmp_path: Path) -> None:
    index = _Index(str(tmp_path), "function", "")
    for key in range(20):
        index.save(key, str(key))
    index.save(10, "ten")
    assert [index.load(key) for key in (3, 4, 10, 19)] == [None, "4", "ten", "19"]
    assert len(list(tmp_path.glob("*.nbc"))) == 16


KINDS = """
from typing import NamedTuple
class {name}(NamedTuple):
    x: float
def made():
    return {name}(2.0)
"""
USER = """
from kinds import made
from robobt.world.compiled import compiled
@compiled
def double(kind):
    return 2.0 * kind.x
print(double(made()), len(double.stats.cache_hits))
"""


def test_what_was_kept_for_a_type_that_is_no_more_is_left_alone(run: Run) -> None:
    Path("user.py").write_text(USER)
    for name, hits in (("Old", 0), ("Old", 1), ("New", 0), ("New", 1)):
        Path("kinds.py").write_text(KINDS.format(name=name))
        assert run("user.py") == ["4.0", str(hits)]


FACTORS = np.array([1.0, 2.0])


def scaled(x: float, by: float = 1.0) -> float:
    return float(FACTORS[0] * x * by)


def test_a_key_follows_the_constants_that_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    before = key_of(scaled)
    assert key_of(scaled) == before
    monkeypatch.setitem(scaled.__globals__, "FACTORS", np.array([1.0, 3.0]))
    assert key_of(scaled) != before


class Pair(NamedTuple):
    first: float
    second: float


def difference(pair: tuple[float, float]) -> float:
    named = Pair(*pair)
    return named.first - named.second


def test_a_key_follows_the_order_of_a_named_tuples_fields(monkeypatch: pytest.MonkeyPatch) -> None:
    before = key_of(difference)

    class Turned(NamedTuple):
        second: float
        first: float

    monkeypatch.setitem(difference.__globals__, "Pair", Turned)
    assert key_of(difference) != before


class Half(IntEnum):
    FIRST = 0
    SECOND = 1


def is_second(half: int) -> bool:
    return half == Half.SECOND


def test_a_key_follows_the_values_of_an_enumeration(monkeypatch: pytest.MonkeyPatch) -> None:
    before = key_of(is_second)
    monkeypatch.setitem(is_second.__globals__, "Half", IntEnum("Half", {"FIRST": 0, "SECOND": 2}))
    assert key_of(is_second) != before


def test_a_key_follows_defaults(monkeypatch: pytest.MonkeyPatch) -> None:
    before = key_of(scaled)
    monkeypatch.setattr(scaled, "__defaults__", (2.0,))
    assert key_of(scaled) != before


def test_a_key_follows_what_an_inner_function_refers_to() -> None:
    def adding(by: float, inner: Callable[[float], float]) -> Callable[[float], float]:
        return lambda x: inner(x) + by

    plain = key_of(adding(1.0, lambda x: x))
    assert key_of(adding(1.0, lambda x: x)) == plain
    assert key_of(adding(2.0, lambda x: x)) != plain != key_of(adding(1.0, lambda x: 2.0 * x))


def area(radius: float) -> float:
    return own_constants.PI * radius * radius


own_constants = ModuleType("own_constants")
own_constants.PI = 3.0  # type: ignore[attr-defined]


def test_a_key_follows_the_constants_of_another_module(monkeypatch: pytest.MonkeyPatch) -> None:
    before = key_of(area)
    monkeypatch.setattr(own_constants, "PI", 3.14)
    assert key_of(area) != before


def test_a_key_follows_sets() -> None:
    one, other = (eval(f"lambda x: x in {{{values}}}") for values in ("1, 2", "1, 3"))
    assert key_of(one) != key_of(other)


SLOW = """
import os, sys, time
from numba.core.event import Listener, register
from robobt.world.compiled import compiled
@compiled
def inner(x):
    return 2.0 * x
@compiled
def outer(x):
    return inner(x) + 1.0
class Sleep(Listener):
    def on_start(self, event):
        time.sleep(0.5)
    def on_end(self, event):
        global compilations
        compilations += event.data is not None
compilations = 0
register("numba:compile", Sleep())
if __name__ == "__main__":
    open(f"ready-{sys.argv[1]}", "w").close()
    while not os.path.exists(f"ready-{1 - int(sys.argv[1])}"):
        time.sleep(0.01)
    print(outer(10.0), compilations)
"""


def test_of_two_processes_one_compiles_and_the_other_loads_it(tmp_path: Path) -> None:
    (tmp_path / "outer.py").write_text(SLOW)
    runs = [
        subprocess.Popen(
            [sys.executable, "-B", "outer.py", str(number)], cwd=tmp_path, stdout=subprocess.PIPE, text=True
        )
        for number in range(2)
    ]
    said = [run.communicate(timeout=LIMIT)[0].split() for run in runs]
    assert sorted(said) == [["21.0", "0"], ["21.0", "2"]]


FAILS = """
from contextlib import suppress
from robobt.world.compiled import compiled
from robobt.world.compiled_key import COMPILING_TURN
@compiled
def fails(x):
    return x.nothing
with suppress(Exception):
    fails(1.0)
print(COMPILING_TURN.of)
"""


def test_what_cannot_be_compiled_keeps_nobody_waiting(tmp_path: Path) -> None:
    (tmp_path / "fails.py").write_text(FAILS)
    run = [sys.executable, "-B", "fails.py"]
    done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, check=True, timeout=LIMIT)
    assert done.stdout == "None\n"
