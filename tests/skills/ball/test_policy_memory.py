"""A policy with a memory is asked in a match as it was in training."""

from __future__ import annotations

from math import hypot, sqrt
from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from robobt.learning.envs import make_task
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.models.card import ObservationCard
from robobt.models.policy import load_policy
from robobt.skills.ball.learned_control import LearnedControl
from robobt.skills.ball.shoot import Shoot
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import DIVISION_B, BallState, Frame, RobotState
from tests.models.made_models import Aimed, shoot_card, write_model
from tests.skills.fixed_world import Alone

SETTINGS = ShootSettings.model_validate({"memory": {"actions": 3, "observations": 2}, "gentle": True})


class Recalling(nn.Module):
    """Answers what depends on everything that it sees and remembers."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self.layer = nn.Linear(size, 2)
        with torch.no_grad():
            self.layer.weight.copy_(torch.linspace(-0.4, 0.4, 2 * size).reshape(2, size))
            self.layer.bias.fill_(-0.1)

    def forward(self, observation: Tensor) -> Tensor:
        return torch.tanh(self.layer(observation))


@pytest.fixture
def model(tmp_path: Path) -> Path:
    spec = make_task(SETTINGS, 1).observation
    card = shoot_card(observation=ObservationCard.of(spec), period=SETTINGS.period, action=SETTINGS.action)
    return write_model(tmp_path, Recalling(spec.size), card)


def frame_of(state: list[float], ball: list[float], time: float, period: float) -> tuple[Frame, RobotState]:
    me = RobotState(0, *state)
    return Frame(time, DIVISION_B, BallState(*ball), (me,), period=period), me


def test_it_decides_as_in_the_arena(model: Path) -> None:
    task, policy, control = make_task(SETTINGS, 1), load_policy(model), LearnedControl(model)
    observation = task.reset(seed=2)
    for tick in range(12):
        action = np.asarray(policy(observation))
        frame, me = frame_of(
            task.arenas.robots[0, 0].tolist(), task.arenas.balls[0].tolist(), tick * 0.03, SETTINGS.period
        )
        command = control.decide(frame, me)
        assert command.omega == pytest.approx(action[0, 0] * SETTINGS.action.max_turn, rel=1e-5)
        observation = task.step(action).observation


def test_between_its_decisions_it_remembers_nothing_more(model: Path) -> None:
    """At twice the rate of training, every second decision counts."""
    slow, quick = LearnedControl(model), LearnedControl(model)
    for tick in range(10):
        frame, me = frame_of([0.1 * tick, 0, 0, 1, 0, 0], [1, 0, 0, 0], 0.03 * tick, 0.015)
        expected = slow.decide(frame, me)
        assert quick.decide(frame, me) == expected
        between, _ = frame_of([0.1 * tick + 0.05, 0, 0, 1, 0, 0], [1, 0, 0, 0], 0.03 * tick + 0.015, 0.015)
        quick.decide(between, between.own[0])


def test_after_a_pause_it_has_forgotten(model: Path) -> None:
    used, fresh = LearnedControl(model), LearnedControl(model)
    for tick in range(5):
        used.decide(*frame_of([0.1 * tick, 0, 0, 1, 0, 0], [1, 0, 0, 0], 0.03 * tick, 0.03))
    later = frame_of([0.5, 0.2, 0, 0, 0, 0], [1, 0, 0, 0], 3.0, 0.03)
    assert used.decide(*later) == fresh.decide(*later)


@pytest.mark.parametrize("remembers", [True, False])
def test_a_shot_with_a_memory_brakes_a_late_robot_on_and_on(
    model: Path, tmp_path: Path, remembers: bool
) -> None:
    """Measured from its own late speed each command would brake by as little as the first one."""
    given = model if remembers else write_model(tmp_path, Aimed(), shoot_card("forgetful"))
    alone = Alone(Shoot(policy=str(given)))
    me = robot(0.0, 0.0, 2.0, velocity=(2.0, 0.0, 0.0), contact=True)
    for start in range(2):
        for tick in range(4):
            time = 10.0 * start + 0.03 * tick
            assert alone.tick(frame(me, ball=held(me), time=time, period=0.03)) is Status.RUNNING
            braked = 0.09 * ((tick + 1) * sqrt(0.5) if remembers else 1)
            assert hypot(alone.command.vx, alone.command.vy) == pytest.approx(2.0 - braked)
        alone.stop()
