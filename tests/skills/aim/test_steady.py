"""ShotIsSteady and PassIsSteady, which do the same with another entry of the store."""

from __future__ import annotations

import pytest

from robobt.skills import PassIsSteady, ShotIsSteady
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone, pass_to, shot_at

PERIOD = 0.02

EACH = pytest.mark.parametrize(
    ("made", "entry", "found"),
    [(ShotIsSteady, "shot", shot_at(4.5, 0.1)), (PassIsSteady, "pass_", pass_to(3, 1.0, 1.0))],
    ids=["shot", "pass"],
)


def after_20_ticks(made: type[ShotIsSteady], entry: str, found: object) -> Alone:
    alone = Alone(made(rise=0.1, fall=0.2))
    for tick in range(20):
        setattr(alone.store, entry, found)
        assert alone.tick(frame(robot(), time=tick * PERIOD)) is Status.SUCCESS
    return alone


@EACH
def test_the_last_one_bridges_a_gap(made: type[ShotIsSteady], entry: str, found: object) -> None:
    alone = after_20_ticks(made, entry, found)
    setattr(alone.store, entry, None)
    assert alone.tick(frame(robot(), time=20 * PERIOD)) is Status.SUCCESS
    assert getattr(alone.store, entry) == found


@EACH
def test_a_long_gap_ends_it(made: type[ShotIsSteady], entry: str, found: object) -> None:
    alone = after_20_ticks(made, entry, found)
    for tick in range(20, 40):
        setattr(alone.store, entry, None)
        status = alone.tick(frame(robot(), time=tick * PERIOD))
    assert status is Status.FAILURE
    assert getattr(alone.store, entry) is None


@EACH
def test_without_one_it_fails(made: type[ShotIsSteady], entry: str, found: object) -> None:
    assert Alone(made()).tick(frame(robot())) is Status.FAILURE
