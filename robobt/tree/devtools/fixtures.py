"""Fixtures of pytest for tests of leaves and trees.

They are not there by themselves; a ``conftest.py`` or a test module names those it wants::

    from robobt.tree.devtools.fixtures import before_tick, make_store, tick_on

and defines ``make_store`` and ``before_tick`` anew where leaves work on a store of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from types import SimpleNamespace
from typing import Any, Protocol

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.runner import TreeRunner


class TickOn(Protocol):
    """What the fixture :func:`tick_on` is."""

    def __call__(self, tree: Behaviour, frames: Iterable[object], store: object = None) -> list[Status]:
        """Tick a leaf or a tree once on each frame and return its statuses.

        A second call with the same tree goes on where the first one ended.

        Args:
            tree: the leaf or tree.
            frames: one for each tick.
            store: what it works on; None keeps that of the call before, or makes one.

        Raises:
            TreeError: a node raised.
        """


@pytest.fixture
def make_store() -> Callable[..., Any]:
    """Return a function that makes a store of the entries given by name; the time is 0 unless it is given."""

    def make(**entries: Any) -> Any:
        return SimpleNamespace(**{"time": 0.0, **entries})

    return make


@pytest.fixture
def before_tick() -> Callable[[Any, Any], None]:
    """Return a function that puts a frame, and its ``time`` where it has one, into a store."""

    def put(store: Any, frame: Any) -> None:
        store.frame = frame
        if hasattr(frame, "time"):
            store.time = frame.time

    return put


@pytest.fixture
def tick_on(make_store: Callable[..., Any], before_tick: Callable[[Any, Any], None]) -> Iterator[TickOn]:
    """Return a function that ticks a leaf or a tree on frames, see :class:`TickOn`."""
    runners: dict[Behaviour, tuple[TreeRunner, Any]] = {}

    def tick(tree: Behaviour, frames: Iterable[object], store: object = None) -> list[Status]:
        if tree not in runners or store is not None:
            if tree in runners:
                runners[tree][0].shutdown()
            own = make_store() if store is None else store
            runners[tree] = (TreeRunner(tree, own, on_error="raise"), own)
        runner, own = runners[tree]
        statuses = []
        for frame in frames:
            before_tick(own, frame)
            statuses.append(runner.tick())
        return statuses

    yield tick
    for runner, _ in runners.values():
        runner.shutdown()
