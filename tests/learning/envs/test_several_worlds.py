"""One task whose arenas are in several worlds."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.learning.envs import GoToBallSettings, GoToBallTask, ShootTask
from robobt.learning.envs.several_worlds import SeveralWorlds
from robobt.learning.training.problems import problem_of
from robobt.learning.training.settings import SettingsError, load_settings, worlds_of

SLOW = {"limits": {"max_speed": 0.5}}


def test_each_arena_goes_its_way_in_its_own_world() -> None:
    def parts() -> list[GoToBallTask]:
        return [GoToBallTask(GoToBallSettings.model_validate(change), 2) for change in ({}, SLOW)]

    whole, again = SeveralWorlds(parts()), SeveralWorlds(parts())
    seen = whole.reset(7)
    np.testing.assert_array_equal(seen, again.reset(7))
    alone = parts()[1]
    alone.reset_to(np.column_stack((whole.parts[1].arenas.robots[:, 0], whole.parts[1].arenas.balls)), seed=0)
    ahead = np.tile([1.0, 0.0, 0.0], (4, 1))
    for _ in range(30):
        result = whole.step(ahead)
        own = alone.step(ahead[:2])
    np.testing.assert_array_equal(result.observation[2:], own.observation)
    np.testing.assert_array_equal(result.reward[2:], own.reward)
    assert result.observation[0, 3] > 1.0 > 0.51 > result.observation[2, 3]


def test_worlds_are_of_one_task() -> None:
    with pytest.raises(ValueError, match="one task"):
        SeveralWorlds([GoToBallTask(), ShootTask()])


def test_arenas_and_validation_starts_are_shared_among_a_runs_worlds() -> None:
    settings = load_settings("go_to_ball", "fast", {"worlds": [{}, SLOW, {"simulator": "grsim"}]})
    worlds = worlds_of(settings)
    assert [world.robot_limits.max_speed for world in worlds][:2] == [3.0, 0.5]
    problem = problem_of(worlds[0], worlds=worlds)
    made = problem.make(8)
    assert isinstance(made, SeveralWorlds)
    assert [part.n for part in made.parts] == [3, 3, 2]
    stay = problem.evaluate(lambda seen: np.zeros((len(seen), 3)), "validation", 5)
    assert len(stay.success) == 5


def test_a_world_that_is_none_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"worlds\[1\]"):
        load_settings("go_to_ball", "fast", {"worlds": [{}, {"simulator": "nowhere"}]})
