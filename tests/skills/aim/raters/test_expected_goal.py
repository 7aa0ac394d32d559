from math import pi

import numpy as np
import pytest

from robobt.shots.data.schema import GOALKEEPERS as KINDS
from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch, SeenShot
from robobt.skills.aim.raters import ExpectedGoal
from robobt.skills.aim.raters.goal_line import goal_candidates
from robobt.testing import frame, held, robot
from robobt.world import DIVISION_B, RobotState

ME = robot(2.6, 0.0, contact=True)
BALL = held(ME)
POINTS = goal_candidates(DIVISION_B)
RATER = ExpectedGoal()


def chances(*opponents: RobotState, me: RobotState = ME) -> np.ndarray:
    found = RATER.chances(frame(me, held(me), opponents=opponents), held(me), me, POINTS)
    assert found is not None
    return found


def test_an_aim_near_a_post_is_worth_less_than_one_inside():
    open_goal = chances()
    assert open_goal[47] > 0.99
    assert open_goal[0] < open_goal[8]


@pytest.mark.integration
def test_a_robot_in_the_lane_stops_the_shot():
    assert chances(robot(3.5, 0.0, pi))[47] == 0.0


def test_a_goalkeeper_that_moves_away_leaves_more_than_one_that_comes():
    away = robot(4.2, 0.25, pi, velocity=(0.0, 1.0, 0.0))
    comes = robot(4.2, 0.25, pi, velocity=(0.0, -1.0, 0.0))
    assert chances(away)[45] > chances(comes)[45]


def test_where_the_shooter_points_makes_no_difference_to_what_a_kick_would_be_worth():
    turned = robot(2.6, 0.0, 0.4, contact=True)
    keeper = robot(4.2, 0.25, pi)
    straight = RATER.rate(frame(ME, held(ME), opponents=(keeper,)), held(ME), ME)
    askew = RATER.rate(frame(turned, held(turned), opponents=(keeper,)), held(turned), turned)
    assert straight is not None
    assert askew is not None
    assert askew.score == pytest.approx(straight.score, abs=0.02)


def test_any_aim_within_the_tolerance_reaches_the_threshold():
    keeper = robot(4.2, 0.3, pi)
    scene = frame(ME, BALL, opponents=(keeper,))
    shot = RATER.rate(scene, BALL, ME)
    assert shot is not None
    assert shot.score > RATER.threshold
    aims = np.arctan2(POINTS[:, 1] - BALL[1], POINTS[:, 0] - BALL[0])
    aim = np.arctan2(shot.target[1] - BALL[1], shot.target[0] - BALL[0])
    within = np.abs(aims - aim) <= shot.tolerance - (aims[1] - aims[0])
    assert within.sum() > 3
    assert chances(keeper)[within].min() >= RATER.threshold - 1e-3


def test_more_robots_than_a_scene_has_room_for_all_count():
    far = [robot(4.3, -2.8 + 0.25 * i, pi, number=i) for i in range(7)]
    blocker = robot(3.4, 0.0, pi, number=9)
    assert chances(*far, blocker)[47] == 0.0
    assert np.all(chances(*far, robot(4.2, 0.3, pi, number=9)) <= chances(robot(4.2, 0.3, pi)) + 1e-6)


def test_robots_behind_the_shooter_do_not_count():
    assert np.array_equal(chances(robot(2.4, 0.2)), chances())


def test_a_model_that_judges_something_else_is_refused():
    with pytest.raises(ValueError, match=r"shot_nn.*takes the observation"):
        ExpectedGoal(model="shot_nn")


def test_the_better_the_goalkeeper_the_less_a_shot_past_it_is_worth():
    keeper = robot(4.2, 0.3, pi)
    scene = frame(ME, BALL, opponents=(keeper,))
    found = [ExpectedGoal(goalkeeper=kind).chances(scene, BALL, ME, POINTS) for kind in KINDS]
    weak, *_, strong = [chances.mean() for chances in found if chances is not None]
    unknown = RATER.chances(scene, BALL, ME, POINTS)
    assert unknown is not None
    assert strong < unknown.mean() < weak


def test_what_a_match_says_of_the_goalkeeper_changes_what_a_shot_is_worth():
    keeper, watch = robot(4.2, 0.3, pi), GoalkeeperWatch()
    scene = frame(ME, BALL, opponents=(keeper,))
    before = RATER.chances(scene, BALL, ME, POINTS, watch)
    # Where only a weak goalkeeper lets it in.
    weak, strong = [
        ExpectedGoal(goalkeeper=kind).chances(scene, BALL, ME, POINTS) for kind in (KINDS[0], KINDS[-1])
    ]
    assert weak is not None
    assert strong is not None
    y = float(POINTS[np.argmax(weak - strong), 1])
    watch.shots += [SeenShot(scene, ME, y, scored=True)] * 5
    after = RATER.chances(scene, BALL, ME, POINTS, watch)
    assert before is not None
    assert after is not None
    assert before == pytest.approx(RATER.chances(scene, BALL, ME, POINTS))
    assert after.mean() > before.mean()


def test_a_kind_of_goalkeeper_that_the_model_does_not_know_is_refused():
    with pytest.raises(ValueError, match=r"shot_expected knows no 'quick'.*full_speed"):
        ExpectedGoal(goalkeeper="quick")
