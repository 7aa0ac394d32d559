from math import pi

import pytest

from robobt.skills.raters import MovingHorizon
from robobt.skills.select_shot import SelectShot
from robobt.tree import Status
from robobt.world import Frame
from tests.skills.fixed_world import Alone, frame, held, robot, shot_at

ME = robot(1.9, 0.0)


def guarded(keeper_y: float, x: float = 4.2) -> Frame:
    return frame(ME, held(ME), opponents=(robot(x, keeper_y, pi),))


def test_a_free_way_is_written_as_the_shot() -> None:
    alone = Alone(SelectShot())
    assert alone.tick(frame(ME, held(ME))) is Status.SUCCESS
    shot = alone.store.shot
    assert shot is not None
    assert shot.target == pytest.approx((4.5, 0.0), abs=1e-6)
    assert shot.score == 1.0


def test_it_moves_nothing() -> None:
    alone = Alone(SelectShot())
    before = alone.command
    alone.tick(frame(ME, held(ME)))
    assert alone.command == before


def test_without_a_free_way_it_fails_and_clears_the_shot() -> None:
    skill = SelectShot()
    alone = Alone(skill)
    alone.store.shot = shot_at(4.5, 0.0)
    wall = tuple(robot(2.6, -0.5 + 0.2 * i, number=i) for i in range(6))
    assert alone.tick(frame(ME, held(ME), opponents=wall)) is Status.FAILURE
    assert alone.store.shot is None
    assert "free" in skill.feedback_message


def test_a_shot_worse_than_asked_for_is_none() -> None:
    skill = SelectShot(rater="open_angle", min_score=0.9)
    alone = Alone(skill)
    assert alone.tick(guarded(0.0)) is Status.FAILURE
    assert alone.store.shot is None
    assert "0.7" in skill.feedback_message
    assert Alone(SelectShot(rater="open_angle", min_score=0.5)).tick(guarded(0.0)) is Status.SUCCESS


def test_from_too_far_it_does_not_look() -> None:
    skill = SelectShot(max_distance=2.0)
    assert Alone(skill).tick(frame(ME, held(ME))) is Status.FAILURE
    assert "2 m" in skill.feedback_message
    assert Alone(SelectShot(max_distance=3.0)).tick(frame(ME, held(ME))) is Status.SUCCESS


def test_it_rates_from_the_ball_and_not_from_the_robot() -> None:
    far = robot(-3.0, 2.0)
    skill = Alone(SelectShot())
    blocker = robot(0.0, 1.0)
    assert skill.tick(frame(far, (2.0, 0.0), opponents=(blocker,))) is Status.SUCCESS
    assert skill.store.shot is not None
    assert skill.store.shot.score == 1.0


def test_the_tolerance_is_that_of_the_corridor() -> None:
    narrow, wide = Alone(SelectShot(tolerance=0.15)), Alone(SelectShot(tolerance=0.486))
    assert narrow.tick(guarded(0.0)) is Status.SUCCESS
    assert wide.tick(guarded(0.0)) is Status.FAILURE


@pytest.mark.parametrize("rater", ["open_angle", "moving_horizon", "gaussian", MovingHorizon(kick_speed=6.0)])
def test_any_rater_will_do_by_name_or_as_an_object(rater: str | MovingHorizon) -> None:
    alone = Alone(SelectShot(rater=rater))
    assert alone.tick(guarded(0.2)) is Status.SUCCESS
    assert alone.store.shot is not None
    assert alone.store.shot.target[1] < 0.0


def test_a_keeper_that_wavers_does_not_make_the_aim_jump() -> None:
    steady, eager = Alone(SelectShot()), Alone(SelectShot(keep=0.0))
    sides: dict[str, set[bool]] = {"steady": set(), "eager": set()}
    for wobble in (0.02, -0.02, 0.02, -0.02):
        for name, alone in (("steady", steady), ("eager", eager)):
            assert alone.tick(guarded(wobble)) is Status.SUCCESS
            assert alone.store.shot is not None
            sides[name].add(alone.store.shot.target[1] > 0.0)
    assert len(sides["steady"]) == 1
    assert len(sides["eager"]) == 2


def test_a_clearly_better_opening_wins_over_the_last_one() -> None:
    alone = Alone(SelectShot())
    alone.tick(guarded(0.1))
    assert alone.store.shot is not None
    assert alone.store.shot.target[1] < 0.0
    alone.tick(guarded(-0.2))
    assert alone.store.shot is not None
    assert alone.store.shot.target[1] > 0.0


def test_a_mistaken_setting_is_refused_when_the_tree_is_made() -> None:
    with pytest.raises(KeyError, match="segment_clearance"):
        SelectShot(rater="segment_clearence")
    with pytest.raises(ValueError, match="tolerance"):
        SelectShot(rater="gaussian", tolerance=0.2)
