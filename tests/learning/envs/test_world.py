"""What a policy sees in training is what the skill sees in a match."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.learning.envs import GoToBallTask, ShootTask
from robobt.models.actions import command_of
from robobt.sim import SimWorld
from robobt.world import Placement, RobotId, Team
from robobt.world.features import go_to_ball_of, shoot_of

ME = RobotId(Team.BLUE, 0)


def in_a_match(task: GoToBallTask | ShootTask, start: np.ndarray) -> SimWorld:
    settings = task.settings
    world = SimWorld(settings.field, {ME: settings.robot_limits}, settings.stepped_simulator, settings.period)
    world.reset(Placement({ME: tuple(start[:3])}, tuple(start[6:])), seed=0)
    return world


@pytest.mark.parametrize("seed", range(5))
def test_go_to_ball_is_the_same_in_a_match(seed: int) -> None:
    task = GoToBallTask()
    start = task.sample_starts(seed, 1)[0]
    seen, world = task.reset_to(start, seed=0), in_a_match(task, start)
    rng = np.random.default_rng(seed)
    for _ in range(60):
        frame = world.observe()
        np.testing.assert_allclose(go_to_ball_of(frame, frame.own[0]), seen[0], rtol=0, atol=1e-9)
        action = rng.uniform(-1, 1, 3)
        world.act({ME: command_of(action, task.action)})
        seen = task.advance(action[None]).observation


@pytest.mark.parametrize("seed", range(5))
def test_shoot_is_the_same_in_a_match(seed: int) -> None:
    task = ShootTask()
    start = task.sample_starts(seed, 1)[0]
    seen, world = task.reset_to(start, seed=0), in_a_match(task, start)
    rng = np.random.default_rng(seed)
    for tick in range(40):
        frame = world.observe()
        np.testing.assert_allclose(shoot_of(frame, frame.own[0]), seen[0], rtol=0, atol=1e-9)
        action = np.array([0.5 * rng.uniform(-1, 1), 1.0 if tick == 20 else -1.0])
        world.act({ME: command_of(action, task.action)})
        seen = task.advance(action[None]).observation
    assert task.arenas.touch[0] == 0
