"""Several robots that learn with one policy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robobt.learning.envs import GoToBallSettings, GoToBallTask, ShootTask, run_starts
from robobt.learning.envs.per_robot import PerRobot, SeveralWorlds
from robobt.learning.envs.soccer.suite import SUITE
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.training.export_run import export_run
from robobt.learning.training.problems import problem_for, problem_of
from robobt.learning.training.run_folder import load_run
from robobt.learning.training.settings import SettingsError, load_settings, worlds_of
from robobt.learning.training.train import train
from robobt.models.file import read_model_file
from robobt.skills import Duel, Goalkeeper, LearnedSkill, Score
from robobt.skills.ball.policy_skill import PolicySkill
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.learning.tiny import broken_off_and_resumed
from tests.skills.fixed_world import Alone

TINY = {
    "steps": 480,
    "collection.num_envs": 12,
    "ppo.num_steps": 10,
    "ppo.hidden_sizes": [8],
    "ppo.minibatch_size": 60,
    "evaluation.every": 240,
    "evaluation.starts": 4,
    "evaluation.held_out": 4,
    "rebuild_every": 120,
    "checkpoint_seconds": 0,
    "tensorboard": False,
    "environment.time_limit": 20,
}


@pytest.mark.integration
@pytest.mark.parametrize("critic", ["own", "central"])
def test_a_run_of_several_learners_that_is_broken_off_ends_as_if_it_had_not_been(
    tmp_path: Path, critic: str
) -> None:
    settings = load_settings("small3v3", "fast", TINY | {"ppo.critic": critic})
    whole = train(settings, tmp_path / "whole")
    resumed = broken_off_and_resumed(settings, tmp_path / "broken", 240)
    assert resumed.figures["weights"] == whole.figures["weights"]
    # What is kept of it is the policy, which is told what a robot sees, whatever the critic was told.
    assert len(load_run(tmp_path / "whole").actor.build["scale"]) == 19 + 4 * 5
    (model,) = export_run(tmp_path / "whole", "mine", tmp_path, starts=2)
    assert LearnedSkill(model=str(model)).model == str(model)


@pytest.mark.integration
@pytest.mark.parametrize(
    ("task", "leaf"), [("save", Goalkeeper), ("duel", Duel), ("score_on_goalkeeper_and_defenders", Score)]
)
def test_what_was_trained_is_a_leaf_by_its_name(
    task: str, leaf: type[PolicySkill], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tiny = {**TINY, "steps": 240}
    train(load_settings(task, "fast", tiny), tmp_path / "run")
    monkeypatch.chdir(tmp_path)
    (path,) = export_run("run", "mine", starts=2)
    card = read_model_file(path).card
    assert (card.skill, card.period) == (leaf.__name__, 0.06)
    assert Alone(leaf(policy="mine")).tick(frame(robot(), (1.0, 0.0))) is Status.RUNNING


def test_one_policy_decides_for_every_learner() -> None:
    task = SoccerTask(SUITE["Duel"](time_limit=10), 3)
    asked = []

    def policy(seen: np.ndarray) -> np.ndarray:
        asked.append(seen.shape)
        return np.zeros((len(seen), 4))

    run_starts(task, task.jointly(policy), task.sample_starts(0, 3))
    assert set(asked) == {(6, task.observation.size)}


def test_a_problem_has_a_row_for_each_learner() -> None:
    environment = load_settings("attack3v2").environment
    problem = problem_of(environment)
    made = problem.make(6)
    assert isinstance(made, PerRobot)
    assert (made.n, made.task.n, len(problem.scale)) == (6, 2, made.observation_size)
    with pytest.raises(SettingsError, match=r"collection\.num_envs: 128 learners do not fill whole arenas"):
        load_settings("attack3v2", "fast", {"collection.num_envs": 128})


def test_every_world_has_an_arena() -> None:
    with pytest.raises(SettingsError, match="worlds: more than there are arenas to share"):
        load_settings("small3v3", "fast", {"worlds": [{}] * 49})


def test_a_central_critic_needs_several_robots() -> None:
    with pytest.raises(SettingsError, match=r"ppo\.critic: a central critic is for tasks of several robots"):
        load_settings("score_on_goalkeeper", "fast", {"ppo.critic": "central"})


def test_what_a_central_critic_is_told_has_a_scale_for_each_entry() -> None:
    settings = load_settings("attack3v2", "fast", {"ppo.critic": "central", "environment.yellow": ["wall"]})
    problem = problem_for(settings)
    made = problem.make(6)
    assert made.reset(0).shape == (6, len(problem.scale) + len(problem.state_scale))
    assert settings.algorithm == "mappo"


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
