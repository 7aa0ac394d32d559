"""The fixtures for tests of leaves: a store, and a leaf ticked on frames."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from robobt.skills import FaceBall, HasBall
from robobt.skills.store import Store
from robobt.tree import Leaf, Status, TreeError
from robobt.tree.devtools.fixtures import TickOn, before_tick, make_store, tick_on
from robobt.tree.nodes import Wait
from robobt.world import RobotCommand
from tests.skills.fixed_world import frame, held, robot

__all__ = ["before_tick", "make_store", "tick_on"]

S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING


class Positive(Leaf[Any]):
    """Succeeds on positive frames."""

    def on_running(self) -> Status:
        return self.succeed() if 1 / self.store.frame > 0 else self.fail("it is not")


def test_a_store_has_the_entries_it_is_made_with_and_a_time(make_store: Callable[..., Any]) -> None:
    assert make_store(shot=3) == SimpleNamespace(time=0.0, shot=3)
    assert make_store(time=2.0).time == 2.0


def test_a_leaf_is_ticked_once_on_each_frame(tick_on: TickOn) -> None:
    assert tick_on(Positive(), [1, -1, 2]) == [S, F, S]


def test_the_time_of_the_frames_is_the_stores(tick_on: TickOn) -> None:
    frames = [SimpleNamespace(time=time) for time in (5.0, 5.5, 6.0)]
    assert tick_on(Wait(seconds=1.0), frames) == [R, R, S]


def test_a_second_call_goes_on_where_the_first_ended(tick_on: TickOn) -> None:
    wait = Wait(seconds=1.0)
    frames = [SimpleNamespace(time=time) for time in (5.0, 5.5, 6.0)]
    assert [tick_on(wait, [one]) for one in frames] == [[R], [R], [S]]


def test_the_store_may_be_given(tick_on: TickOn) -> None:
    store = SimpleNamespace()
    tick_on(Positive(), [7], store)
    assert store.frame == 7


def test_a_leaf_that_raises_fails_the_test(tick_on: TickOn) -> None:
    with pytest.raises(TreeError, match="Positive: ZeroDivisionError"):
        tick_on(Positive(), [0])


class TestOnAStoreOfItsOwn:
    """A robot's store, as a suite for skills defines the fixtures anew."""

    @pytest.fixture
    def make_store(self) -> Callable[..., Any]:
        me = robot()
        return lambda **entries: Store(**{"frame": frame(me), "me": me, **entries})

    @pytest.fixture
    def before_tick(self) -> Callable[[Any, Any], None]:
        def put(store: Store, frame: Any) -> None:
            store.frame, store.me, store.command = frame, frame.robot(0), RobotCommand()

        return put

    def test_a_skill_is_ticked_on_frames(self, tick_on: TickOn) -> None:
        me = robot(1.0)
        assert tick_on(HasBall(), [frame(me, held(me)), frame(me, (3.0, 0.0))]) == [S, F]

    def test_the_command_is_in_the_store(self, tick_on: TickOn, make_store: Callable[..., Any]) -> None:
        store = make_store()
        assert tick_on(FaceBall(), [frame(robot(), (0.0, 2.0))], store) == [R]
        assert store.command.omega > 0.0
