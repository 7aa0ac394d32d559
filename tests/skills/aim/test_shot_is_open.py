from math import pi

import pytest

from robobt.skills.aim.shot_is_open import ShotIsOpen
from robobt.testing import frame, held, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone, shot_at

ME = robot(1.9, 0.0)
OPEN = frame(ME, held(ME))
GUARDED = frame(ME, held(ME), opponents=(robot(4.2, 0.0, pi),))
WALLED = frame(ME, held(ME), opponents=tuple(robot(2.6, -0.5 + 0.2 * i, number=i) for i in range(6)))


@pytest.mark.parametrize("rater", ["segment_clearance", "open_angle", "moving_horizon", "gaussian"])
def test_it_holds_before_an_open_goal_and_not_before_a_wall(rater: str) -> None:
    assert Alone(ShotIsOpen(rater=rater, min_score=0.1)).tick(OPEN) is Status.SUCCESS
    assert Alone(ShotIsOpen(rater=rater, min_score=0.1)).tick(WALLED) is Status.FAILURE


def test_it_writes_nothing() -> None:
    alone = Alone(ShotIsOpen())
    kept = alone.store.shot = shot_at(4.5, 0.3)
    alone.tick(OPEN)
    assert alone.store.shot is kept
    alone.tick(WALLED)
    assert alone.store.shot is kept


def test_how_open_is_a_parameter() -> None:
    skill = ShotIsOpen(rater="open_angle", min_score=0.9)
    assert Alone(skill).tick(GUARDED) is Status.FAILURE
    assert "scores" in skill.feedback_message
    assert Alone(ShotIsOpen(rater="open_angle", min_score=0.5)).tick(GUARDED) is Status.SUCCESS
    wide = ShotIsOpen(rater={"name": "segment_clearance", "tolerance": 0.486})
    assert Alone(wide).tick(GUARDED) is Status.FAILURE


def test_how_near_is_a_parameter() -> None:
    assert Alone(ShotIsOpen(max_distance=2.0)).tick(OPEN) is Status.FAILURE
    assert Alone(ShotIsOpen(max_distance=3.0)).tick(OPEN) is Status.SUCCESS
