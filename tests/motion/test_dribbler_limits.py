"""Learned skills keep to what the robot's dribbler takes and holds."""

from __future__ import annotations

from math import hypot, sqrt
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from robobt.learning.envs.soccer.suite import SUITE
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.models.actions import ActionScaling
from robobt.models.card import action_outputs
from robobt.sim.settings import preset, settings_from
from robobt.skills import GoToBall, Score, Shoot
from robobt.testing import frame, held, robot
from robobt.world import RobotLimits
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS
from tests.models.made_models import Straight, go_to_ball_card, shoot_card, team_card, write_model
from tests.skills.fixed_world import Alone, moved

PERIOD = 0.03
TOUCHING = ROBOT_RADIUS + BALL_RADIUS


class Spinning(nn.Module):
    """Turns as fast as it can and never kicks."""

    def forward(self, observation: Tensor) -> Tensor:
        one = 0.0 * observation[:, :1] + 1.0
        return torch.cat([one, -one], 1)


class Aside(nn.Module):
    """Drives ahead and to the left, as fast as it can, and never kicks."""

    def forward(self, observation: Tensor) -> Tensor:
        one = 0.0 * observation[:, :1] + 1.0
        return torch.cat([0.6 * one, 0.8 * one, 0.0 * one, -one], 1)


def approach(folder: Path) -> GoToBall:
    action = ActionScaling(kind="drive", max_speed=3.0, max_turn=6.0, dribbler=True)
    card = go_to_ball_card(action=action, outputs=action_outputs(action))
    return GoToBall(policy=str(write_model(folder, Straight(), card)))


@pytest.mark.parametrize("catch_speed", [0.3, 1.0, 4.0])
@pytest.mark.parametrize("braking", [4.0, 8.0])
def test_an_approach_arrives_no_faster_than_the_dribbler_takes_the_ball(
    tmp_path: Path, catch_speed: float, braking: float
) -> None:
    limits = RobotLimits(acceleration=4.0, braking=braking, catch_speed=catch_speed)
    alone, me = Alone(approach(tmp_path)), robot(-3.0, limits=limits)
    fastest = 0.0
    while me.x < -0.2:
        alone.tick(frame(me, ball=(0.0, 0.0), period=PERIOD))
        me = moved(me, alone.command, PERIOD)
        fastest = max(fastest, me.vx)
    assert fastest == pytest.approx(3.0, abs=1e-6)
    # What is left beyond the hand-over is braked away before the robot touches the ball.
    left = -me.x - TOUCHING
    assert me.vx <= sqrt(catch_speed**2 + 2.0 * braking * max(0.0, left)) + 1e-6


def test_an_approach_is_not_held_up_where_the_dribbler_takes_the_ball_at_any_speed(tmp_path: Path) -> None:
    limits = RobotLimits(catch_speed=4.0)
    alone = Alone(approach(tmp_path))
    alone.tick(frame(robot(-0.25, velocity=(3.0, 0.0, 0.0), limits=limits), ball=(0.0, 0.0), period=PERIOD))
    assert alone.command.vx == pytest.approx(3.0)


def test_a_rolling_ball_may_be_followed_as_fast_as_it_rolls(tmp_path: Path) -> None:
    alone = Alone(approach(tmp_path))
    me = robot(-0.2, limits=RobotLimits(catch_speed=0.3))
    alone.tick(frame(me, ball=(0.0, 0.0, 1.5, 0.0), period=PERIOD))
    assert alone.command.vx == pytest.approx(1.8)


@pytest.mark.parametrize("hold", [0.5, 4.0])
def test_a_shot_turns_no_faster_than_the_ball_is_held(tmp_path: Path, hold: float) -> None:
    alone = Alone(Shoot(policy=str(write_model(tmp_path, Spinning(), shoot_card()))))
    me = robot(2.0, contact=True, limits=RobotLimits(hold_acceleration=hold))
    alone.tick(frame(me, ball=held(me), period=PERIOD))
    assert alone.command.omega**2 * TOUCHING == pytest.approx(hold)


def test_a_shot_turns_as_the_policy_says_where_the_ball_is_held_fast(tmp_path: Path) -> None:
    alone = Alone(Shoot(policy=str(write_model(tmp_path, Spinning(), shoot_card()))))
    me = robot(2.0, contact=True, limits=RobotLimits(hold_acceleration=50.0))
    alone.tick(frame(me, ball=held(me), period=PERIOD))
    assert alone.command.omega == pytest.approx(10.0)


@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_a_shot_brakes_no_harder_than_the_ball_is_held(tmp_path: Path, heading: float) -> None:
    alone = Alone(Shoot(policy=str(write_model(tmp_path, Spinning(), shoot_card()))))
    limits = RobotLimits(hold_acceleration=0.5)
    me = robot(2.0, heading=heading, velocity=(0.3, 0.1, 0.0), contact=True, limits=limits)
    alone.tick(frame(me, ball=held(me), period=PERIOD))
    asked = hypot(alone.command.vx, alone.command.vy)
    assert asked == pytest.approx(me.speed - 0.5 * PERIOD)
    slow = robot(2.0, heading=heading, velocity=(0.01, 0.0, 0.0), contact=True, limits=limits)
    alone.tick(frame(slow, ball=held(slow), period=PERIOD))
    assert hypot(alone.command.vx, alone.command.vy) == 0.0


@pytest.mark.parametrize(("contact", "aside"), [(True, 1.1), (False, 2.4)])
def test_a_policy_carries_the_ball_no_faster_sideways_than_it_is_held(
    tmp_path: Path, contact: bool, aside: float
) -> None:
    alone = Alone(Score(policy=str(write_model(tmp_path, Aside(), team_card("Score", 0, 2)))))
    me = robot(2.0, contact=contact, limits=RobotLimits(carry_aside=1.1))
    alone.tick(frame(me, ball=held(me), period=PERIOD))
    assert (alone.command.vx, alone.command.vy) == pytest.approx((1.8, aside))


def test_an_environment_carries_it_as_the_policy_does() -> None:
    """In grSim's preset: learners slow down with the ball, and without it they do not."""
    task = SoccerTask(SUITE["Duel"].model_validate({"simulator": "grsim"}), n=1, seed=0)
    start = np.zeros(len(task.start_columns))
    blue, yellow, ball = (0.0, 0.0, 0.0, 0, 0, 0), (-2.0, 0.0, 0.0, 0, 0, 0), (0.092, 0.0, 0, 0)
    start[:16] = (*blue, *yellow, *ball)
    task.reset_to(start, seed=0)
    for _ in range(12):
        task.advance(np.tile([0.0, 1.0, 0.0, -1.0], 2)[None])
    assert task.arenas.contact[0].tolist() == [True, False]
    assert task.arenas.robots[0, 0, 4] == pytest.approx(1.1, abs=0.02)
    assert task.arenas.robots[0, 1, 4] > 1.5


def test_a_robot_that_does_not_turn_holds_the_ball_no_less_than_one_that_does() -> None:
    weak = preset("erforce").limits
    assert weak.holds_straight > weak.hold_acceleration
    strong = settings_from({"preset": "erforce", "limits": {"hold_acceleration": 3.0}}).limits
    assert strong.holds_straight == 3.0
