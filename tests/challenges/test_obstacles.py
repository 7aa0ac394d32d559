"""The obstacle challenge: what counts as a touch, and the courses that are drawn."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.obstacle_course import KNOWN, unseen
from robobt.challenges.obstacles import ObstacleJudge, Obstacles, ObstaclesUnseen, PlacementState
from robobt.challenges.run import ChallengeEntry, play_run
from robobt.challenges.touching import CourseTouch
from robobt.plays.challenges.obstacle_run import OBSTACLE_TARGET
from robobt.world.field import DIVISION_B
from robobt.world.game import Restart, Team
from robobt.world.state import BallState, Frame, RobotState
from robobt.worlds import sim_world

SPOT = (0.5, 0.0)
BALL = (2.5, 0.0)


def judged(
    x: float, y: float, yellow: dict[int, tuple[float, float]] | None = None, time: float = 3.0
) -> ObstacleJudge:
    others = tuple(RobotState(number, *place) for number, place in (yellow or {}).items())
    frame = Frame(time, DIVISION_B, BallState(*BALL), (RobotState(0, x, y),), others)
    judge = ObstacleJudge()
    judge.see(frame, PlacementState(SPOT).update(frame).game)
    return judge


@pytest.mark.parametrize(
    ("x", "y", "yellow", "touch"),
    [
        (3.0, 2.0, {4: (3.19, 2.0)}, CourseTouch.NOTHING),
        (3.0, 2.0, {4: (3.181, 2.0)}, CourseTouch.ROBOT),
        (3.22, -1.0, {}, CourseTouch.AREA),
        (3.20, -1.0, {}, CourseTouch.NOTHING),
        (4.0, 1.28, {}, CourseTouch.AREA),
        (1.5, 0.58, {}, CourseTouch.BALL_WAY),
        (1.5, 0.60, {}, CourseTouch.NOTHING),
        (3.0, 2.08, {2: (2.7, 2.0), 3: (3.3, 2.0)}, CourseTouch.LINE),
        (3.0, 2.10, {2: (2.7, 2.0), 3: (3.3, 2.0)}, CourseTouch.NOTHING),
        (3.0, 2.08, {2: (2.7, 2.0), 4: (3.3, 2.0)}, CourseTouch.NOTHING),
    ],
)
def test_what_touches(x: float, y: float, yellow: dict[int, tuple[float, float]], touch: CourseTouch) -> None:
    assert judged(x, y, yellow).touched is touch


def test_the_score_is_the_time_left_at_the_target() -> None:
    x, y = OBSTACLE_TARGET
    assert judged(x - 0.06, y).figures()["time left"] == 27.0
    assert judged(x - 0.08, y).figures()["time left"] == 0.0


def test_a_touch_at_the_target_leaves_nothing() -> None:
    x, y = OBSTACLE_TARGET
    assert judged(x, y, {4: (x, y + 0.1)}).figures()["time left"] == 0.0


def test_yellow_places_the_ball_all_the_time() -> None:
    game = PlacementState(SPOT).update(Frame(1.0, DIVISION_B, BallState(*BALL))).game
    assert (game.restart, game.restart_team, game.placement) == (Restart.BALL_PLACEMENT, Team.YELLOW, SPOT)


def test_a_seed_fixes_the_course_and_another_seed_draws_another() -> None:
    first, again, other = (unseen(np.random.default_rng(seed)) for seed in (3, 3, 4))
    assert first == again
    assert first != other


def test_no_course_begins_with_a_touch() -> None:
    for course in (*KNOWN, *(unseen(np.random.default_rng(seed)) for seed in range(20))):
        judge = ObstacleJudge()
        yellow = tuple(RobotState(one.number, *one.at) for one in course.obstacles)
        frame = Frame(0.0, DIVISION_B, BallState(*course.ball), (RobotState(0, *course.start),), yellow)
        assert not judge.see(frame, PlacementState(course.spot or course.ball).update(frame).game), course


def test_the_best_of_three_trials_counts() -> None:
    trials = [{"time left": left, "reached": float(left > 0)} for left in (1.0, 5.0, 0.0, 2.0, 0.0, 3.0)]
    assert Obstacles().score(trials) == {"time left": 8.0, "example_1": 5.0, "example_2": 3.0, "reached": 4.0}


def test_the_time_is_compared_with_the_free_drive_where_both_arrive() -> None:
    course, free = {"time left": 26.0, "time": 4.0}, {"time left": 28.0, "time": 2.0}
    assert ObstaclesUnseen().score([course, free])["of the free drive"] == 2.0
    assert "of the free drive" not in ObstaclesUnseen().score([{"time left": 0.0}, free])


@pytest.mark.integration
def test_the_play_drives_the_published_examples_without_a_touch() -> None:
    result = play_run(ChallengeEntry("obstacles", ("obstacle_run", {})), 0, 1, sim_world)
    assert result.figures["reached"] == 6.0


@pytest.mark.integration
def test_straight_on_touches() -> None:
    result = play_run(ChallengeEntry("obstacles", ("obstacle_run_straight", {})), 0, 1, sim_world)
    assert result.score == 0.0
