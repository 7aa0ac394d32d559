from base64 import b64decode
from math import pi

import numpy as np
import pytest

from robobt.skills.aim.raters import ExpectedGoal, MovingHorizon, NNFiltered
from robobt.skills.aim.raters.goal_line import goal_candidates, judged_goal_line
from robobt.skills.aim.select_shot import SelectShot
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import DIVISION_A, DIVISION_B, FieldGeometry, Frame
from tests.skills.fixed_world import Alone, shot_at

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
    narrow, wide = (
        Alone(SelectShot(rater={"name": "segment_clearance", "tolerance": tolerance}))
        for tolerance in (0.15, 0.486)
    )
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
    with pytest.raises(ValueError, match="segment_clearance"):
        SelectShot(rater="segment_clearence")
    with pytest.raises(ValueError, match="tolerance"):
        SelectShot(rater={"name": "gaussian", "tolerance": 0.2})


@pytest.mark.parametrize("rater", [NNFiltered(), ExpectedGoal()])
def test_what_a_learned_rater_thinks_of_every_target_point_is_written(
    rater: NNFiltered | ExpectedGoal,
) -> None:
    alone = Alone(SelectShot(rater=rater))
    assert alone.tick(guarded(0.4, 3.9)) is Status.SUCCESS
    line = alone.store.goal_line
    assert line is not None
    assert line.reach == pytest.approx(0.465)
    percent = np.frombuffer(b64decode(line.chances), dtype=np.uint8)
    assert len(percent) == 94
    # From right to left: the goalkeeper stands on the left.
    assert percent[20] > 90
    assert percent[-1] < 10
    _, chances = rater.judge(alone.store.frame, alone.store.frame.ball.position, ME)
    assert chances is not None
    np.testing.assert_allclose(percent / 100, chances[1], atol=0.0051)


def test_a_geometric_rater_judges_no_goal_line() -> None:
    alone = Alone(SelectShot())
    alone.tick(guarded(0.2))
    assert alone.store.goal_line is None


def test_a_goal_line_that_was_not_judged_is_not_kept() -> None:
    alone = Alone(SelectShot(rater="expected_goal", max_distance=3.0))
    alone.tick(guarded(0.3))
    assert alone.store.goal_line is not None
    far = robot(-1.0, 0.0)
    assert alone.tick(frame(far, held(far), opponents=(robot(4.2, 0.3, pi),))) is Status.FAILURE
    assert alone.store.goal_line is None


def test_a_goal_line_stays_the_same_object_until_a_difference_can_be_seen() -> None:
    points = goal_candidates(DIVISION_B)
    first = judged_goal_line(points, np.full(94, 0.5))
    assert judged_goal_line(points, np.full(94, 0.515), first) is first
    # What has crept away in small steps is noticed in the end.
    assert judged_goal_line(points, np.full(94, 0.53), first) != first
    elsewhere = np.full(94, 0.5)
    elsewhere[93] = 0.0
    assert judged_goal_line(points, elsewhere, first) != first


@pytest.mark.parametrize(("field", "spacing"), [(DIVISION_A, 0.01), (DIVISION_B, 0.001), (DIVISION_B, 1.0)])
def test_a_goal_line_of_any_number_of_points_fits_into_a_recording(
    field: FieldGeometry, spacing: float
) -> None:
    points = goal_candidates(field, spacing)
    line = judged_goal_line(points, np.linspace(0.0, 1.0, len(points)))
    percent = np.frombuffer(b64decode(line.chances), dtype=np.uint8)
    assert 1 <= len(percent) <= 100
    assert line.reach == pytest.approx(points[-1, 1])
    if len(points) > 1:
        assert (percent[0], percent[-1]) == (0, 100)
        assert (np.diff(percent.astype(int)) >= 0).all()
