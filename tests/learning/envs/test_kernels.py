"""The compiled kernels say what the definitions say that the skills use."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from robobt.learning.envs import kernels as k
from robobt.models.actions import GO_TO_BALL_ACTION, SHOOT_ACTION, commands_of
from robobt.world.features import go_to_ball_observation, shoot_observation


def states(count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    robots = rng.uniform(-5, 5, (count, 1, 6))
    robots[:, 0, 2] = rng.uniform(-pi, pi, count)
    balls = rng.uniform(-5, 5, (count, 4))
    balls[0, :2] = robots[0, 0, :2]
    return robots, balls


def test_go_to_ball_is_observed_as_the_skills_do() -> None:
    robots, balls = states(500)
    seen = np.empty((500, 6))
    k.observe_go_to_ball(robots, balls, seen)
    np.testing.assert_allclose(seen, go_to_ball_observation(robots[:, 0], balls), rtol=0, atol=1e-12)


def test_shoot_is_observed_as_the_skills_do() -> None:
    robots, balls = states(500)
    seen = np.empty((500, 10))
    k.observe_shoot(robots, balls, 4.5, 0.5, seen)
    expected = shoot_observation(robots[:, 0], balls, (4.5, 0.5), (4.5, -0.5))
    np.testing.assert_allclose(seen, expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("dribbler", [False, True])
def test_drive_actions_mean_what_they_mean_to_the_skill(dribbler: bool) -> None:
    actions = np.random.default_rng(2).uniform(-1.5, 1.5, (300, 3))
    scaling = GO_TO_BALL_ACTION.model_copy(update={"dribbler": dribbler})
    commands = np.full((300, 1, 6), 9.0)
    assert k.drive_commands(actions, scaling.max_speed, scaling.max_turn, float(dribbler), commands)
    np.testing.assert_allclose(commands[:, 0], commands_of(actions, scaling), rtol=0, atol=1e-12)
    assert np.hypot(commands[..., 0], commands[..., 1]).max() <= scaling.max_speed + 1e-12


def test_kick_actions_mean_what_they_mean_to_the_skill() -> None:
    actions = np.random.default_rng(3).uniform(-1.5, 1.5, (300, 2))
    actions[0, 1] = 0.0
    scaling, commands = SHOOT_ACTION, np.full((300, 1, 6), 9.0)
    assert k.kick_commands(actions, scaling.max_turn, scaling.kick_speed, 1.0, np.ones(300), commands)
    np.testing.assert_allclose(commands[:, 0], commands_of(actions, scaling), rtol=0, atol=1e-12)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_an_action_that_is_not_finite_is_refused(bad: float) -> None:
    drive, kick = np.zeros((3, 3)), np.zeros((3, 2))
    drive[1, 2] = kick[1, 1] = bad
    assert not k.drive_commands(drive, 1.5, 1.0, 0.0, np.zeros((3, 1, 6)))
    assert not k.kick_commands(kick, 1.0, 5.0, 1.0, np.ones(3), np.zeros((3, 1, 6)))
