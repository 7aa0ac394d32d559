"""The passing challenge as a task: passes as the challenge counts them."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.learning import TASKS
from robobt.learning.envs.passing.task import PassingSettings, PassingTask
from robobt.learning.envs.soccer.suite import scripted
from robobt.learning.envs.starts import start_parts


def played(apart: float, passes: int = 1, kick: bool = True) -> tuple[PassingTask, list[float], list[bool]]:
    """Let the first robot kick the ball to its mate; return the task, its rewards and ends."""
    task = TASKS["passing"](PassingSettings(passes=passes, time_limit=60), n=1, seed=1)
    assert isinstance(task, PassingTask)
    start = np.zeros((1, len(task.start_columns)))
    robots, balls, _ = start_parts(start, task.robots)
    robots["x"][0], robots["y"][0] = (-1.0, -1.0 + apart, 0.0), (0.0, 0.0, 2.5)
    robots["heading"][0, 1] = np.pi
    balls["x"] = -1.0 + task.settings.simulator.body.face + 0.0218
    task.reset_to(start, seed=1)
    still = np.tile([0.0, 0.0, 0.0, -1.0], 2)
    kicking = still.copy()
    kicking[3] = 1.0
    rewards, ends = [], []
    for step in range(30):
        result = task.advance((kicking if kick and step == 0 else still)[None])
        rewards.append(float(result.reward[0]))
        ends.append(bool(result.success[0]))
        if result.terminated[0] or result.truncated[0]:
            break
    return task, rewards, ends


@pytest.mark.parametrize(("apart", "passes"), [(2.0, 1), (1.1, 0)])
def test_a_pass_counts_from_where_it_was_kicked_if_it_is_a_metre_long(apart: float, passes: int) -> None:
    task, rewards, ends = played(apart)
    assert (task.passes[0], ends[-1]) == (passes, passes == 1)
    assert (max(rewards) > 4.0) == (passes == 1)


def test_a_ball_that_is_kept_is_no_pass() -> None:
    task, _, ends = played(2.0, kick=False)
    assert task.passes[0] == 0
    assert len(ends) == 30
    assert not any(ends)


def test_an_episode_may_ask_for_more_passes() -> None:
    task, rewards, ends = played(2.0, passes=2)
    assert task.passes[0] == 1
    assert not any(ends)
    assert task.shares[0] == pytest.approx(rewards[-1])


@pytest.mark.integration
def test_the_script_passes() -> None:
    task = PassingTask(scripted(PassingSettings()), n=32, seed=2)
    task.reset(seed=2)
    succeeded: list[bool] = []
    while len(succeeded) < 64:
        task.step(np.zeros((32, 0)))
        if task.ended is not None:
            succeeded += task.ended.success.tolist()
    assert np.mean(succeeded) > 0.2
