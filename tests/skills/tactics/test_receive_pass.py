from __future__ import annotations

from math import atan2, cos, nan, pi, sin

import numpy as np
import pytest

from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.testing import Trial, blue, frame, held, robot
from robobt.tree import Status
from robobt.world import RobotLimits
from robobt.world.rules import has_ball
from tests.skills.fixed_world import Alone
from tests.skills.refereed import OPEN


def test_it_needs_a_ball_that_rolls_towards_it() -> None:
    alone = Alone(ReceivePass())
    assert alone.tick(frame(robot(), (1.0, 0.0), game=OPEN)) is Status.FAILURE
    assert alone.tick(frame(robot(), (1.0, 0.0, 2.0, 0.0), game=OPEN)) is Status.FAILURE
    assert alone.tick(frame(robot(), (1.0, 0.0, -2.0, 0.0), game=OPEN)) is Status.RUNNING


def test_with_the_ball_it_is_done() -> None:
    me = robot(contact=True)
    assert Alone(ReceivePass()).tick(frame(me, held(me), game=OPEN)) is Status.FAILURE


def test_a_ball_in_the_air_is_not_sent_on_with_one_touch() -> None:
    # It comes from the wing; the goal is empty.
    ball = (4.2, 1.4, -1.9, -1.9)
    for height, hint in ((0.0, "sending it on"), (0.2, "taking the ball")):
        alone = Alone(ReceivePass())
        view = frame(robot(2.9, 0.1, heading=0.8), (*ball, height), game=OPEN)
        assert alone.tick(view) is Status.RUNNING
        assert alone.tree.feedback_message == hint


def test_a_ball_that_an_opponent_is_at_first_is_not_sent_on_with_one_touch() -> None:
    ball = (4.2, 1.4, -1.9, -1.9)
    for place, hint in (((4.3, 2.0), "sending it on"), ((4.2, 1.4), "taking the ball")):
        alone = Alone(ReceivePass())
        opponent = robot(*place, number=1, limits=RobotLimits(acceleration=0.1))
        view = frame(robot(2.9, 0.1, heading=0.8), ball, opponents=(opponent,), game=OPEN)
        assert alone.tick(view) is Status.RUNNING
        assert alone.tree.feedback_message == hint


@pytest.mark.parametrize("y", [-0.2, 0.0, 0.3])
def test_a_ball_that_comes_from_the_front_is_taken(y: float) -> None:
    # It comes out of the direction of the own goal: too far round for a shot with one touch.
    trial = Trial({blue(1): ReceivePass()}, {blue(1): (0.0, y, pi)}, (-2.5, 0.0, 2.4, 0.0))
    while trial.world.time < 3.0:
        view = trial.tick()
        me = view.robot(1)
        assert me is not None
        if has_ball(me, view.ball):
            return
    raise AssertionError("the ball was not taken")


def drill(seed: int, settings: str = "default") -> tuple[bool, float]:
    """A ball rolls to a robot before the goal: whether it goes on there with one touch, and its top speed."""
    rng = np.random.default_rng(seed)
    while True:
        x, y = rng.uniform(1.5, 3.0), rng.uniform(-1.8, 1.8)
        angle = rng.uniform(-0.9, 0.9) + atan2(-y, 4.5 - x)
        length = rng.uniform(1.8, 2.8)
        px, py = x + length * cos(angle), y + length * sin(angle)
        if abs(px) < 4.3 and abs(py) < 2.8 and not (px > 3.3 and abs(py) < 1.2):
            break
    speed = rng.uniform(2.0, 2.8)
    ball = (px, py, speed * (x - px) / length, speed * (y - py) / length)
    off, way = rng.uniform(0.0, 0.2), rng.uniform(-pi, pi)
    pose = (x + off * cos(way), y + off * sin(way), atan2(py - y, px - x))
    trial = Trial({blue(1): ReceivePass(redirect_at=0.0)}, {blue(1): pose}, ball, settings)
    fastest = 0.0
    while trial.world.time < 2.5:
        view = trial.tick()
        fastest = max(fastest, view.ball.speed)
        if trial.kicks and view.ball.vx > 0.5:
            at = view.ball.y + (4.5 - view.ball.x) * view.ball.vy / view.ball.vx
            return abs(at) < 0.5 and view.ball.speed > 4.0, fastest
    return False, fastest


@pytest.mark.integration
def test_a_pass_before_the_goal_goes_on_at_the_goal_with_one_touch() -> None:
    assert sum(drill(seed)[0] for seed in range(20)) >= 15


@pytest.mark.integration
def test_where_a_kick_adds_to_the_speed_at_which_a_ball_comes_the_rules_speed_is_kept() -> None:
    fastest = [drill(seed, "grsim")[1] for seed in range(12)]
    assert max(fastest) < 6.5
    assert sum(speed > 6.0 for speed in fastest) >= 2


@pytest.mark.parametrize(
    ("setting", "value"), [("slowest", 0.0), ("widest", -0.1), ("redirect_at", 1.1), ("redirect_at", nan)]
)
def test_a_setting_that_makes_no_sense_is_refused(setting: str, value: float) -> None:
    with pytest.raises(ValueError, match=setting):
        ReceivePass(**{setting: value})  # type: ignore[arg-type]
