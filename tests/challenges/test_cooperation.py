"""The cooperation challenge: points for the junior robot's touch, shot and goal, and what rules cost."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from robobt.challenges.cooperation import JUNIOR, MAJOR, Cooperation, CooperationJudge
from robobt.challenges.run import ChallengeEntry, play_run
from robobt.world.field import DIVISION_B
from robobt.world.game import OPEN_PLAY
from robobt.world.state import BallState, Frame, RobotId, RobotState
from robobt.worlds import sim_world

Seen = tuple[float, BallState, RobotId | None]
"""A time [s], the ball, and the robot that touched it last."""


def judged(
    seen: Sequence[Seen], junior: tuple[float, float] = (0.0, -2.0), speed: float = 0.0
) -> dict[str, float]:
    judge = CooperationJudge()
    for time, ball, last in seen:
        own = (RobotState(0, -2.5, 1.0), RobotState(1, *junior, 0.0, speed))
        if judge.see(Frame(time, DIVISION_B, ball, own, last_touch=last), OPEN_PLAY):
            break
    return dict(judge.figures())


PASS: Seen = (1.0, BallState(0.0, 0.0, 2.0), MAJOR)


def goal(time: float) -> list[Seen]:
    """Return a shot of the junior robot that is in the goal at ``time``."""
    return [
        (time - 0.4, BallState(3.0, 0.0, 3.0), JUNIOR),
        (time - 0.2, BallState(3.8, 0.0, 3.0), JUNIOR),
        (time - 0.05, BallState(4.4, 0.0, 3.0), JUNIOR),
        (time, BallState(4.6, 0.0, 3.0), JUNIOR),
    ]


@pytest.mark.parametrize(
    ("time", "points"), [(14.0, 42.0), (15.0, 42.0), (15.02, 32.0), (19.0, 32.0), (20.04, 22.0), (25.0, 22.0)]
)
def test_a_goal_earns_more_the_sooner_it_falls(time: float, points: float) -> None:
    told = judged([PASS, *goal(time)])
    assert (told["points"], told["time"]) == (points, time)


def test_a_touch_in_the_attacked_half_earns_four_more() -> None:
    touch = (1.5, BallState(0.1, -2.0, 0.0), JUNIOR)
    assert judged([PASS, touch])["points"] == 10.0
    assert judged([PASS, (1.5, BallState(-0.1, -2.0), JUNIOR)])["points"] == 6.0


def test_a_goal_of_the_other_robot_earns_nothing() -> None:
    shots = [(time, ball, MAJOR) for time, ball, _ in goal(5.0)]
    assert judged([PASS, *shots])["points"] == 0.0


def test_a_junior_robot_that_moves_too_early_costs_four_points() -> None:
    early = (0.5, BallState(-1.5, 0.0), None)
    assert judged([early, PASS, *goal(14.0)], speed=0.5)["points"] == 38.0
    assert judged([PASS, *goal(14.0)], speed=0.5)["points"] == 42.0


def test_a_robot_in_a_defence_area_costs_a_point() -> None:
    assert judged([PASS, *goal(14.0)], junior=(3.5, 0.9))["broken rules"] == 1.0


def test_a_robot_that_is_too_fast_costs_a_point() -> None:
    assert judged([PASS, *goal(14.0)], speed=2.6)["points"] == 41.0


def test_a_chip_ends_the_try_without_points() -> None:
    told = judged([PASS, (2.0, BallState(1.0, 0.0, 2.0, 0.0, 0.12), JUNIOR), *goal(14.0)])
    assert (told["points"], told["goals"]) == (0.0, 0.0)


def test_the_best_three_of_five_tries_count() -> None:
    tries = [
        {"points": points, "goals": 1.0, "broken rules": 0.0, "time": 20.0 - points}
        for points in (1.0, 5.0, 3.0, 2.0, 4.0)
    ]
    assert Cooperation().score(tries) == {"points": 12.0, "goals": 5.0, "broken rules": 0.0, "fastest": 15.0}


@pytest.mark.integration
def test_the_play_scores_by_the_rules() -> None:
    result = play_run(ChallengeEntry("cooperation", ("pass_and_score", {})), 0, 1, sim_world)
    assert (result.score, result.figures["broken rules"]) == (Cooperation.most, 0.0)
