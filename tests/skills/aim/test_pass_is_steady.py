from __future__ import annotations

from robobt.skills.aim.pass_is_steady import PassIsSteady
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone, pass_to

PERIOD = 0.02


def test_the_last_pass_bridges_a_gap() -> None:
    me, alone = robot(), Alone(PassIsSteady(rise=0.1, fall=0.2))
    for tick in range(20):
        alone.store.pass_ = pass_to(3, 1.0, 1.0)
        assert alone.tick(frame(me, time=tick * PERIOD)) is Status.SUCCESS
    alone.store.pass_ = None
    assert alone.tick(frame(me, time=20 * PERIOD)) is Status.SUCCESS
    assert alone.store.pass_ == pass_to(3, 1.0, 1.0)


def test_a_long_gap_ends_it() -> None:
    me, alone = robot(), Alone(PassIsSteady(rise=0.1, fall=0.2))
    for tick in range(20):
        alone.store.pass_ = pass_to(3, 1.0, 1.0)
        alone.tick(frame(me, time=tick * PERIOD))
    for tick in range(20, 40):
        alone.store.pass_ = None
        status = alone.tick(frame(me, time=tick * PERIOD))
    assert status is Status.FAILURE
    assert alone.store.pass_ is None


def test_without_a_pass_it_fails() -> None:
    assert Alone(PassIsSteady()).tick(frame(robot())) is Status.FAILURE
