from math import atan2, hypot, inf

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.skills.aim.pass_rater import PassRater, resting_point
from robobt.skills.aim.raters import Gaussian
from robobt.skills.base import Skill
from robobt.skills.store import Pass
from robobt.testing import alone, eventually, frame, held, robot
from robobt.testing.frames import HELD
from robobt.tree import Status
from robobt.world import Frame, RobotCommand, RobotState
from robobt.world.ball_model import DEFAULT_BALL

ME = robot(-0.1, 0.0)
RATER = PassRater()


def passes(
    mates: tuple[RobotState, ...], opponents: tuple[RobotState, ...] = (), rater: PassRater = RATER
) -> list[Pass]:
    return rater.rate_all(frame(ME, (0.0, 0.0), mates, opponents), ME)


def score(mate: RobotState, *opponents: RobotState) -> float:
    (only,) = passes((mate,), opponents)
    return only.score


def test_a_free_mate_ahead_is_passed_to_where_it_stands() -> None:
    (only,) = passes((robot(2.0, 1.0, number=3),))
    assert only.receiver == 3
    assert only.target == (2.0, 1.0)
    assert only.score > 0.7


def test_a_moving_mate_is_passed_to_where_it_can_stop() -> None:
    mate = robot(2.0, 1.0, number=1, velocity=(0.0, -1.2, 0.0))
    (only,) = passes((mate,))
    assert only.target == resting_point(mate)
    assert only.target == pytest.approx((2.0, 1.0 - 1.2**2 / (2 * 6.0)))


class Kick(Skill):
    """Kicks a held ball straight ahead."""

    def __init__(self, speed: float) -> None:
        super().__init__()
        self.speed = speed

    def on_running(self) -> Status:
        self.store.command = RobotCommand(kick_speed=self.speed)
        return self.run()


@pytest.mark.parametrize("length", [1.2, 2.2, 3.2])
def test_the_ball_arrives_at_a_speed_that_can_be_received(length: float) -> None:
    (only,) = passes((robot(length, 0.0, number=1),))
    kicker = robot(-HELD, 0.0)
    trial = alone(Kick(only.speed), (kicker.x, 0.0, 0.0), held(kicker))
    there = trial.run(4.0, eventually("the ball is there", lambda frame: frame.ball.x >= length))
    assert there.ball.speed == pytest.approx(RATER.receive_speed, abs=0.1)


def test_no_pass_is_faster_than_allowed() -> None:
    rater = PassRater(receive_speed=4.0, max_speed=5.0)
    (only,) = passes((robot(3.2, 0.0, number=1),), rater=rater)
    assert only.speed == 5.0
    assert passes((robot(3.2, 0.0, number=1),), rater=PassRater(max_speed=0.5)) == []


@pytest.mark.parametrize(
    ("x", "y", "why"),
    [
        (0.6, 0.0, "too near"),
        (2.0, 3.2, "outside the field"),
        (3.8, 0.5, "in the opponent's defence area"),
        (-4.2, 0.0, "in the own defence area"),
    ],
)
def test_a_mate_that_may_or_need_not_receive_is_no_receiver(x: float, y: float, why: str) -> None:
    assert passes((robot(x, y, number=1),)) == [], why


def test_a_robot_in_the_lane_blocks_it_and_one_behind_the_ball_does_not() -> None:
    mate = robot(2.0, 0.0, number=1)
    assert passes((mate,), (robot(1.0, 0.2),)) == []
    assert [p.receiver for p in passes((mate, robot(1.0, -0.1, number=2)))] == [2]
    assert [p.receiver for p in passes((mate,), (robot(-0.35, 0.0),))] == [1]


def test_the_mate_nearer_to_the_goal_is_the_better_receiver() -> None:
    ahead, beside, behind = robot(2.5, 1.0, number=1), robot(0.0, -1.5, number=2), robot(-2.0, 1.0, number=3)
    assert [p.receiver for p in passes((ahead, beside, behind))] == [1, 2, 3]


def test_the_mate_with_the_better_shot_is_the_better_receiver() -> None:
    blockers = tuple(robot(3.2, 0.5 + 0.15 * i, number=i) for i in range(4))
    mates = (robot(2.4, 1.2, number=1), robot(2.4, -1.2, number=2))
    best, worst = passes(mates, blockers)
    assert (best.receiver, worst.receiver) == (2, 1)
    assert best.score > worst.score + 0.2


def test_an_opponent_that_can_get_to_the_lane_makes_it_unsafe() -> None:
    mate = robot(3.0, 0.0, number=1)
    far, near = score(mate, robot(1.5, 2.5)), score(mate, robot(1.5, 0.8))
    assert near < far < score(mate)


def test_an_opponent_running_at_the_lane_is_worse_than_one_running_away() -> None:
    mate = robot(3.0, 0.0, number=1)
    towards, away = (score(mate, robot(1.5, 1.0, velocity=(0.0, vy, 0.0))) for vy in (-1.5, 1.5))
    assert towards < away


def test_the_head_start_is_the_balls_time_against_the_opponents() -> None:
    """An opponent at rest abeam of the lane's end: s = a t^2 / 2, then the ball's own time."""
    opponent = robot(3.0, 0.8)
    here = frame(ME, (0.0, 0.0), opponents=(opponent,))
    (start,) = RATER.head_starts(here, [(3.0, 0.0)], [4.0])
    by_then = (2 * (0.8 - 0.1115) / 3.0) ** 0.5 + RATER.reaction
    assert start == pytest.approx(by_then - DEFAULT_BALL.time_to(3.0, 4.0))
    assert RATER.head_starts(frame(ME, (0.0, 0.0)), [(3.0, 0.0)], [4.0]) == [inf]


def test_the_judge_of_the_receivers_shot_goes_by_name_too() -> None:
    assert PassRater.model_validate({"shot_rater": "gaussian"}).shot_rater == Gaussian()
    with pytest.raises(ValueError, match="shot_rater"):
        PassRater.model_validate({"shot_rater": "crystal_ball"})


places = st.tuples(st.floats(-4.4, 4.4), st.floats(-2.9, 2.9))


@settings(max_examples=50)
@given(mates=st.lists(places, max_size=5), opponents=st.lists(places, max_size=6), ball=places)
def test_passes_come_best_first_and_scores_are_shares(
    mates: list[tuple[float, float]], opponents: list[tuple[float, float]], ball: tuple[float, float]
) -> None:
    others = tuple(robot(x, y, number=i + 1) for i, (x, y) in enumerate(mates))
    me = robot(ball[0] - 0.1, ball[1])
    rated = RATER.rate_all(
        frame(me, ball, others, tuple(robot(x, y, number=i) for i, (x, y) in enumerate(opponents))), me
    )
    assert [p.score for p in rated] == sorted((p.score for p in rated), reverse=True)
    for each in rated:
        assert 0.0 <= each.score <= 1.0
        assert 0.0 < each.speed <= RATER.max_speed
        assert hypot(each.target[0] - ball[0], each.target[1] - ball[1]) >= RATER.min_distance


@settings(max_examples=50)
@given(mates=st.lists(places, min_size=1, max_size=3), opponents=st.lists(places, max_size=4), more=places)
def test_one_opponent_more_improves_no_pass(
    mates: list[tuple[float, float]], opponents: list[tuple[float, float]], more: tuple[float, float]
) -> None:
    others = tuple(robot(x, y, number=i + 1) for i, (x, y) in enumerate(mates))
    few, many = (
        {
            p.receiver: p.score
            for p in passes(others, tuple(robot(x, y, number=i) for i, (x, y) in enumerate(o)))
        }
        for o in (opponents, [*opponents, more])
    )
    assert set(many) <= set(few)
    assert all(many[receiver] <= few[receiver] + 1e-9 for receiver in many)


def test_a_mirrored_scene_has_the_mirrored_passes() -> None:
    def scene(side: float) -> Frame:
        me = robot(0.5, 0.2 * side, 0.3 * side)
        mates = (
            robot(2.0, 1.4 * side, number=1, velocity=(0.3, -0.5 * side, 0.0)),
            robot(2.6, -1.0 * side, number=2),
        )
        opponents = (robot(2.0, 0.4 * side), robot(4.3, -0.1 * side, velocity=(0.0, 0.4 * side, 0.0)))
        return frame(me, held(me), mates, opponents)

    left, right = (RATER.rate_all(scene(side), scene(side).own[0]) for side in (1.0, -1.0))
    assert [p.receiver for p in left] == [p.receiver for p in right]
    for a, b in zip(left, right, strict=True):
        assert a.target == pytest.approx((b.target[0], -b.target[1]))
        assert (a.speed, a.score) == pytest.approx((b.speed, b.score))
        assert atan2(a.target[1], a.target[0]) != 0.0
