from __future__ import annotations

from robobt.skills.aim.shot_is_steady import ShotIsSteady
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone, shot_at

PERIOD = 0.02


def test_the_last_shot_bridges_a_gap() -> None:
    me, alone = robot(), Alone(ShotIsSteady(rise=0.1, fall=0.2))
    for tick in range(20):
        alone.store.shot = shot_at(4.5, 0.1)
        assert alone.tick(frame(me, time=tick * PERIOD)) is Status.SUCCESS
    alone.store.shot = None
    assert alone.tick(frame(me, time=20 * PERIOD)) is Status.SUCCESS
    assert alone.store.shot == shot_at(4.5, 0.1)


def test_a_long_gap_ends_it() -> None:
    me, alone = robot(), Alone(ShotIsSteady(rise=0.1, fall=0.2))
    for tick in range(20):
        alone.store.shot = shot_at(4.5, 0.1)
        alone.tick(frame(me, time=tick * PERIOD))
    for tick in range(20, 40):
        alone.store.shot = None
        status = alone.tick(frame(me, time=tick * PERIOD))
    assert status is Status.FAILURE
    assert alone.store.shot is None


def test_without_a_shot_it_fails() -> None:
    assert Alone(ShotIsSteady()).tick(frame(robot())) is Status.FAILURE
