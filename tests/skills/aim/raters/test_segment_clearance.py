from math import atan2, inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.skills.aim.raters import SegmentClearance
from robobt.skills.aim.raters.goal_line import goal_candidates, lane_clearances, runs
from robobt.testing import frame, robot
from robobt.world import DIVISION_A, DIVISION_B
from robobt.world.geometry import segment_distance


def test_a_goal_of_one_metre_has_the_papers_94_target_points_10_mm_apart() -> None:
    points = goal_candidates(DIVISION_B)
    assert points.shape == (94, 2)
    assert set(points[:, 0]) == {4.5}
    assert np.diff(points[:, 1]) == pytest.approx(0.01)
    assert points[:, 1] == pytest.approx(-points[::-1, 1])
    assert points[-1, 1] <= 0.5 - 0.0215 - 0.01


def test_a_wider_goal_has_more_and_a_coarser_grid_fewer() -> None:
    assert len(goal_candidates(DIVISION_A)) == 174
    assert len(goal_candidates(DIVISION_B, 0.05)) == 19


def test_groups_are_runs_of_clear_points() -> None:
    clear = np.array([True, True, False, True, False, False, True])
    assert runs(clear) == [(0, 2), (3, 4), (6, 7)]
    assert runs(np.zeros(5, dtype=bool)) == []
    assert runs(np.ones(5, dtype=bool)) == [(0, 5)]


coordinates = st.tuples(st.floats(-4.0, 4.5), st.floats(-3.0, 3.0))


@settings(max_examples=50)
@given(origin=coordinates, centres=st.lists(coordinates, min_size=1, max_size=6))
def test_clearance_is_the_distance_from_the_lane_with_or_without_what_is_behind(
    origin: tuple[float, float], centres: list[tuple[float, float]]
) -> None:
    targets = np.array([(4.5, -0.4), (4.5, 0.0), (4.5, 0.3)])
    got = lane_clearances(origin, targets, np.array(centres))
    counted = lane_clearances(origin, targets, np.array(centres), behind=True)
    for row, target in enumerate(targets.tolist()):
        for column, centre in enumerate(centres):
            ahead = (centre[0] - origin[0]) * (target[0] - origin[0])
            ahead += (centre[1] - origin[1]) * (target[1] - origin[1])
            expected = segment_distance(centre, origin, tuple(target)) if ahead > 0.0 else inf
            assert got[row, column] == pytest.approx(expected, abs=1e-6)
            assert counted[row, column] == pytest.approx(
                segment_distance(centre, origin, tuple(target)), abs=1e-6
            )


def test_the_target_is_the_middle_of_the_largest_group() -> None:
    """A robot at (3.5, 0.2) on the line from (2, 0): the paper's rule, point by point."""
    tolerance = 0.1965
    me, keeper, ball = robot(1.9, 0.0), robot(3.5, 0.2), (2.0, 0.0)
    points = goal_candidates(DIVISION_B)[:, 1].tolist()
    clear = [y for y in points if segment_distance(keeper.position, ball, (4.5, y)) > tolerance]
    low = [y for y in clear if y < 0.2]
    shot = SegmentClearance(tolerance=tolerance).rate(frame(me, ball, opponents=(keeper,)), ball, me)
    assert shot is not None
    assert shot.target == pytest.approx((4.5, sum(low) / len(low)))
    assert shot.score == pytest.approx(len(low) / 94)


def test_the_tolerance_is_half_the_angle_of_the_group() -> None:
    me = robot(2.4, 0.0)
    shot = SegmentClearance().rate(frame(me, (2.5, 0.0)), (2.5, 0.0), me)
    assert shot is not None
    assert shot.tolerance == pytest.approx(atan2(0.47, 2.0))


def test_a_wider_corridor_leaves_less() -> None:
    me, keeper, ball = robot(1.9, 0.0), robot(4.0, 0.25), (2.0, 0.0)
    here = frame(me, ball, opponents=(keeper,))
    scores = []
    for tolerance in (0.1965, 0.243, 0.3645, 0.486):
        shot = SegmentClearance(tolerance=tolerance).rate(here, ball, me)
        scores.append(shot.score if shot else 0.0)
    assert scores == sorted(scores, reverse=True)
    assert len(set(scores)) == 4


def test_motion_does_not_count() -> None:
    me, ball = robot(1.9, 0.0), (2.0, 0.0)
    still, moving = (robot(4.0, 0.25, velocity=(0.0, vy, 0.0)) for vy in (0.0, -1.5))
    rater = SegmentClearance()
    assert rater.rate_all(frame(me, ball, opponents=(still,)), ball, me) == rater.rate_all(
        frame(me, ball, opponents=(moving,)), ball, me
    )


def test_a_robot_close_behind_the_ball_blocks_every_shot_as_in_the_paper() -> None:
    me, ball = robot(1.9, 0.0), (2.0, 0.0)
    blocked = frame(me, ball, opponents=(robot(1.95, 0.15),))
    assert SegmentClearance(tolerance=0.1965).rate(blocked, ball, me) is None
