"""Observations that remember what was seen and done."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs import make_task
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.world.features import SHOOT, find_observation
from robobt.world.memory import Memory, MemorySize, memory_of

SIZE = MemorySize("shoot", 2, 2, 1)


def test_its_name_says_how_much_is_remembered() -> None:
    spec = find_observation(SIZE.name)
    assert spec is not None
    assert memory_of(spec.name) == SIZE
    assert spec.size == SHOOT.size + 2 * 2 + SHOOT.size
    assert find_observation("nothing_memory_2x2_1") is None
    assert find_observation("shoot_memory_99x2_1") is None
    assert memory_of("shoot") is None


def test_the_latest_comes_first_and_a_beginning_forgets() -> None:
    memory = Memory(SIZE, 1, rows=2)
    memory.begin(np.array([[5.0], [6.0]]), slice(None))
    for step in (1.0, 2.0, 3.0):
        memory.remember(np.full((2, 1), 10 * step), np.full((2, 2), step))
    assert memory.recall(np.full((2, 1), 40.0)).tolist() == [[40.0, 3.0, 3.0, 2.0, 2.0, 30.0]] * 2
    memory.begin(np.array([[7.0]]), np.array([1]))
    assert memory.recall(np.array([[7.0]]), np.array([1])).tolist() == [[7.0, 0.0, 0.0, 0.0, 0.0, 7.0]]
    assert memory.recall(np.full((1, 1), 40.0), np.array([0])).tolist() == [[40.0, 3.0, 3.0, 2.0, 2.0, 30.0]]


def test_a_task_shows_what_it_showed_and_what_was_done() -> None:
    given = {"time_limit": 4, "gentle": True}
    settings = given | {"memory": {"actions": 2, "observations": 1}}
    plain, with_it = (make_task(ShootSettings.model_validate(one), 3) for one in (given, settings))
    seen, recalled = plain.reset(seed=4), with_it.reset(seed=4)
    n, rng = SHOOT.size, np.random.default_rng(0)
    assert recalled[:, :n].tolist() == seen.tolist()
    assert not recalled[:, n : n + 4].any()
    assert recalled[:, n + 4 :].tolist() == seen.tolist()
    before, last = seen, np.zeros((3, 2))
    for _ in range(3):
        action = rng.uniform(-1, 0, (3, 2))
        one, other = plain.step(action), with_it.step(action)
        assert other.observation[:, :n].tolist() == one.observation.tolist()
        assert other.observation[:, n : n + 2].tolist() == action.tolist()
        assert other.observation[:, n + 2 : n + 4].tolist() == last.tolist()
        assert other.observation[:, n + 4 :].tolist() == before.tolist()
        before, last = one.observation, action
    # After its end an episode begins without a memory.
    result = with_it.step(np.full((3, 2), -0.5))
    assert result.truncated.all()
    assert result.final_observation[:, n : n + 2].tolist() == [[-0.5, -0.5]] * 3
    assert not result.observation[:, n : n + 4].any()


def test_its_space_and_scale_fit_it() -> None:
    task = make_task(
        ShootSettings.model_validate({"memory": {"actions": 3, "observations": 2}, "gentle": True}), 1
    )
    assert task.space.shape == (task.observation_size,) == (len(task.scale),)
    assert task.space.contains(task.reset(seed=0)[0].astype(np.float32))
