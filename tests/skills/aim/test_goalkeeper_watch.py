from dataclasses import replace

import numpy as np
import pytest

from robobt.skills.aim.goalkeeper_watch import LEAST_WEIGHT, GoalkeeperWatch, SeenShot, goalkeeper_of, updated
from robobt.testing import frame, robot
from robobt.world import BallState, Frame, RobotLimits, RobotState
from robobt.world.game import GameState, TeamStatus

KINDS = ("fitted", "half_speed", "full_speed")
ME = robot(2.0, 0.0, contact=True)


def seen(
    time: float, ball: BallState, keeper: RobotState | None = None, game: GameState | None = None
) -> Frame:
    scene = frame(ME, ball.position, opponents=(keeper or robot(4.3, 0.0, 3.0),))
    return replace(scene, time=time, ball=ball, game=game or scene.game)


def followed(*frames: Frame) -> GoalkeeperWatch:
    watch = GoalkeeperWatch()
    for each in frames:
        watch.follow(each)
    return watch


def shot(scored: bool, *, by_score: bool = False) -> tuple[Frame, ...]:
    """A ball that is shot at the goal, and goes in or comes back."""
    x = 4.55 if scored and not by_score else 4.1
    ended = BallState(x, 0.2, 6.0 if scored and not by_score else -1.0)
    return (
        seen(0.0, BallState(2.1, 0.0)),
        seen(0.03, BallState(2.3, 0.01, 6.5, 0.4)),
        seen(0.3, BallState(3.9, 0.1, 6.2, 0.4)),
        seen(0.36, ended, game=GameState(blue_score=1) if by_score else None),
    )


def weights(watch: GoalkeeperWatch, *chances: float) -> np.ndarray:
    return watch.weights("model", KINDS, lambda _: np.array(chances))


def test_before_anything_is_seen_every_kind_is_equally_likely():
    assert weights(GoalkeeperWatch(), 0.9, 0.5, 0.1) == pytest.approx(np.full(3, 1 / 3))


@pytest.mark.parametrize(("scored", "by_score"), [(True, False), (False, False), (True, True)])
def test_a_shot_of_the_own_team_is_noticed_with_its_outcome(scored: bool, by_score: bool):
    (found,) = followed(*shot(scored, by_score=by_score)).shots
    assert found.scored == scored
    assert found.frame.time == 0.0
    assert found.shooter.id == ME.id
    assert found.y == pytest.approx(0.145, abs=0.01)


def test_a_ball_that_nobody_kicked_or_that_goes_wide_is_no_shot():
    far = (
        seen(0.0, BallState(0.0, 0.0)),
        seen(0.03, BallState(0.2, 0.0, 6.0)),
        seen(2.0, BallState(4.6, 0.0)),
    )
    wide = (
        seen(0.0, BallState(2.1, 0.0)),
        seen(0.03, BallState(2.3, 0.2, 6.0, 4.0)),
        seen(2.0, BallState(4.6, 2.0)),
    )
    assert followed(*far).shots == []
    assert followed(*wide).shots == []


def test_a_save_makes_a_good_goalkeeper_likelier_and_a_goal_a_weak_one():
    saved, scored = followed(*shot(False)), followed(*shot(True))
    assert weights(saved, 0.9, 0.5, 0.1) == pytest.approx(np.array([0.1, 0.5, 0.9]) / 1.5)
    assert weights(scored, 0.9, 0.5, 0.1) == pytest.approx(np.array([0.9, 0.5, 0.1]) / 1.5)


def test_each_shot_counts_once_however_often_the_weights_are_asked_for():
    watch = followed(*shot(False))
    first = weights(watch, 0.9, 0.5, 0.1)
    assert np.array_equal(weights(watch, 0.9, 0.5, 0.1), first)


def test_a_goalkeeper_faster_than_a_kind_is_not_of_that_kind():
    fast = robot(4.3, 0.0, 3.0, velocity=(0.0, 1.6, 0.0))
    watch = followed(*[seen(0.03 * i, BallState(2.1, 0.0), fast) for i in range(3)])
    weak, half, full = weights(watch, 0.9, 0.5, 0.1)
    assert weak < 2 * LEAST_WEIGHT
    assert half < 2 * LEAST_WEIGHT
    assert full > 0.99


def test_a_speed_in_a_single_frame_is_taken_for_noise():
    fast, still = robot(4.3, 0.0, 3.0, velocity=(0.0, 1.6, 0.0)), robot(4.3, 0.0, 3.0)
    watch = followed(*[seen(0.03 * i, BallState(2.1, 0.0), fast if i == 2 else still) for i in range(6)])
    assert watch.fastest == 0.0


def test_a_goalkeeper_whose_robot_is_too_slow_is_not_the_fast_one():
    slow = replace(robot(4.3, 0.0, 3.0), limits=RobotLimits(max_speed=1.2))
    assert weights(followed(seen(0.0, BallState(2.1, 0.0), slow)), 0.9, 0.5, 0.1)[2] < 2 * LEAST_WEIGHT


def test_no_outcome_rules_a_kind_out_for_good():
    after = np.array([1.0, 0.0, 0.0])
    for _ in range(20):
        after = updated(after, np.array([1.0, 0.5, 0.0]), False)
    assert after[2] > 0.9
    assert after.min() >= LEAST_WEIGHT / 2


def test_the_goalkeeper_is_the_robot_that_the_game_names_else_the_one_at_home():
    near, far = robot(4.3, 0.0, 3.0, number=1), robot(3.0, 1.0, 3.0, number=2)
    scene = frame(ME, (2.1, 0.0), opponents=(near, far))
    assert goalkeeper_of(scene) is near
    assert goalkeeper_of(replace(scene, game=GameState(yellow=TeamStatus(keeper=2)))) is far
    assert goalkeeper_of(frame(ME, (2.1, 0.0), opponents=(far,))) is None


def test_what_was_seen_is_kept_by_frames_and_not_by_calls():
    frames = shot(False)
    once, twice = followed(*frames), followed(*[each for each in frames for _ in range(2)])
    assert [(one.y, one.scored) for one in once.shots] == [(one.y, one.scored) for one in twice.shots]
    assert isinstance(once.shots[0], SeenShot)
