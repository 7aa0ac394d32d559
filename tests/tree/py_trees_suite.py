"""Runs py_trees' own tests with this package's engine ticking their trees.

    python -m tests.tree.py_trees_suite

downloads the source distribution of py_trees, which carries the tests, and runs
them with this file as a pytest plugin. It prints how many tests there are, how
many of them tick a tree at all, and how many tick one through the engine.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

VERSION = "2.6.0"


class UnavailableError(Exception):
    """The source distribution cannot be had here."""


@dataclass(frozen=True)
class Outcome:
    """What came of it, in numbers of tests.

    Attributes:
        passed, failed: as pytest counts.
        through: tests that tick a tree through the engine.
        past: tests that tick a tree past it, by its own generator.
        ticking: tests that tick a tree either way.
        output: what pytest said.
    """

    passed: int
    failed: int
    through: int
    past: int
    ticking: int
    output: str


def run_suite() -> Outcome:
    """Download and run.

    Raises:
        UnavailableError: pip cannot get the distribution.
    """
    with tempfile.TemporaryDirectory() as folder:
        source = _download(Path(folder))
        # Their package is called `tests` like ours, so they are to see this file's folder only.
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent), "PYTEST_ADDOPTS": ""}
        done = subprocess.run(
            [
                sys.executable,
                "-m",
                "pytest",
                "-q",
                "-p",
                Path(__file__).stem,
                "-p",
                "no:cacheprovider",
                "tests",
            ],
            cwd=source,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
    return _read(done.stdout + done.stderr)


def _download(folder: Path) -> Path:
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", ":all:"]
    done = subprocess.run(
        [*pip, "--dest", str(folder), f"py_trees=={VERSION}"], capture_output=True, text=True, check=False
    )
    archives = list(folder.glob("*.tar.gz"))
    if done.returncode != 0 or not archives:
        raise UnavailableError(done.stderr.strip() or "pip found no source distribution")
    with tarfile.open(archives[0]) as archive:
        archive.extractall(folder, filter="data")
    return next(folder.glob("*/PKG-INFO")).parent


def _read(output: str) -> Outcome:
    counts = {word: int(number) for number, word in re.findall(r"(\d+) (passed|failed|errors?)\b", output)}
    ticks = {
        word: int(number) for word, number in re.findall(r"^(through|past|ticking)=(\d+)$", output, re.M)
    }
    failed = counts.get("failed", 0) + counts.get("error", 0) + counts.get("errors", 0)
    if "passed" not in counts or len(ticks) != 3:
        raise RuntimeError(f"the tests of py_trees did not run:\n{output}")
    return Outcome(counts["passed"], failed, ticks["through"], ticks["past"], ticks["ticking"], output)


# What follows is the plugin's side.


class _Watch:
    """Which test ticks how."""

    def __init__(self) -> None:
        self.test = ""
        self.inside = 0
        self.through: set[str] = set()
        self.past: set[str] = set()

    def engine(self, tick: Callable[[], object]) -> None:
        """Tick by the engine."""
        self.through.add(self.test)
        self.inside += 1
        try:
            tick()
        finally:
            self.inside -= 1

    def generator(self, tick: Callable[..., Iterator[Any]]) -> Callable[..., Iterator[Any]]:
        """The same generator, noticed when it begins outside the engine."""

        def watched(*args: Any, **kwargs: Any) -> Iterator[Any]:
            if not self.inside:
                self.past.add(self.test)
            yield from tick(*args, **kwargs)

        return watched


_watch = _Watch()


def pytest_configure() -> None:
    """Put the engine in py_trees' place, wherever it ticks a tree."""
    from py_trees import behaviour, composites, decorators, trees
    from py_trees import tests as helpers

    kinds = [behaviour.Behaviour]
    for module in (composites, decorators):
        kinds += [kind for kind in vars(module).values() if isinstance(kind, type)]
    for kind in kinds:
        if "tick" in vars(kind):
            kind.tick = _watch.generator(kind.tick)
    # Only now, for the engine knows py_trees' classes by their ticks.
    from robobt.tree.engine import FastTree, compile_tree

    class Tree(FastTree):
        def tick(self, *args: Any, **kwargs: Any) -> None:
            _watch.engine(lambda: super(Tree, self).tick(*args, **kwargs))

    def tick_once(node: behaviour.Behaviour) -> None:
        _watch.engine(compile_tree(node))

    def tick_tree(
        root: behaviour.Behaviour, from_tick: int, to_tick: int, *, visitors: Any = (), **_: Any
    ) -> None:
        def visit(node: behaviour.Behaviour) -> None:
            for visitor in visitors:
                node.visit(visitor)

        for _count in range(from_tick, to_tick + 1):
            for visitor in visitors:
                visitor.initialise()
            _watch.engine(compile_tree(root, visit))

    trees.BehaviourTree = Tree
    behaviour.Behaviour.tick_once = tick_once
    helpers.tick_tree = tick_tree


def pytest_runtest_setup(item: Any) -> None:
    """Know which test it is."""
    _watch.test = item.nodeid


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say what was seen."""
    terminalreporter.write_line(f"through={len(_watch.through)}")
    terminalreporter.write_line(f"past={len(_watch.past)}")
    terminalreporter.write_line(f"ticking={len(_watch.through | _watch.past)}")


if __name__ == "__main__":
    outcome = run_suite()
    print(
        f"py_trees {VERSION}: {outcome.passed} tests passed, {outcome.failed} failed; "
        f"{outcome.ticking} tick a tree, {outcome.through} through the engine, {outcome.past} past it"
    )
    sys.exit(outcome.failed > 0)
