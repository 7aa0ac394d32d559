"""The state of objects is put back, wherever they keep it."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
import pytest

from robobt.match.checkpoint import Checkpoint
from robobt.match.loop import MatchLoop
from robobt.worlds import sim_world
from tests.what_if.made import small_match


@dataclass(slots=True, frozen=True)
class Frozen:
    inner: list[int] = field(default_factory=list)
    number: int = 0


class Plain:
    def __init__(self) -> None:
        self.count = 0
        self.names = {"a": [1]}
        self.members = {1, 2}
        self.line = deque([1, 2], maxlen=3)
        self.array = np.zeros(3)
        self.frozen = Frozen([1])
        self.generator = np.random.default_rng(1)
        self.dice = random.Random(1)
        self.counter = counter()
        self.bound = partial(self.line.append, 9)


def counter() -> Callable[[], int]:
    now = 0

    def count() -> int:
        nonlocal now
        now += 1
        return now

    return count


def change(one: Plain) -> list[object]:
    """Change all of it, and return what came of its random numbers and of its closure."""
    one.count += 1
    one.names["b"] = one.names.pop("a")
    one.names["b"].append(2)
    one.members.add(3)
    one.bound()
    one.array += 1.0
    one.frozen.inner.append(7)
    object.__setattr__(one.frozen, "number", 5)
    one.__dict__["new"] = 1
    return [one.generator.random(), one.dice.random(), one.counter()]


def test_everything_is_put_back_in_place_any_number_of_times() -> None:
    one = Plain()
    parts = one.names, one.members, one.line, one.array, one.frozen
    kept = Checkpoint(one)
    first = change(one)
    for _ in range(2):
        kept.restore()
        assert (one.count, one.names, one.members, list(one.line)) == (0, {"a": [1]}, {1, 2}, [1, 2])
        assert one.array.tolist() == [0.0, 0.0, 0.0]
        assert one.frozen == Frozen([1])
        assert not hasattr(one, "new")
        assert all(now is then for now, then in zip((one.names, one.members, one.line), parts, strict=False))
        assert one.array is parts[3]
        assert change(one) == first


def test_objects_that_know_each_other_are_looked_at_once() -> None:
    one: list[object] = [1]
    one.append(one)
    kept = Checkpoint(one)
    one.clear()
    kept.restore()
    assert one[0] == 1
    assert one[1] is one
    assert len(kept) == 1


@pytest.mark.integration
def test_the_trees_of_a_match_decide_the_same_again() -> None:
    match = MatchLoop(small_match(3.0), 4, sim_world)
    with match:
        for _ in range(60):
            match.tick()
        kept = match.checkpoint()
        frames = []
        for _ in range(40):
            match.world.act(match.decide(frame := match.world.observe()))
            frames.append(frame)
        kept.restore()
        first = [match.decide(frame) for frame in frames]
        kept.restore()
        assert [match.decide(frame) for frame in frames] == first


def test_a_dictionary_gets_its_order_back() -> None:
    one = {"a": True, "b": True}
    checkpoint = Checkpoint(one)
    one["a"] = one.pop("a")
    checkpoint.restore()
    assert list(one) == ["a", "b"]
