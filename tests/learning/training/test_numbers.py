"""One policy for several numbers of players: worlds of unequal teams, other places, export."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from robobt.learning.agents.networks import policy_of
from robobt.learning.envs import make_task
from robobt.learning.envs.per_robot import SeveralWorlds
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.training.arenas import arenas_of, learners_in
from robobt.learning.training.export_run import export_run
from robobt.learning.training.run import TrainError
from robobt.learning.training.run_folder import load_actor
from robobt.learning.training.settings import SettingsError, load_settings
from robobt.learning.training.train import train
from robobt.models.policy import load_policy
from robobt.skills import LearnedSkill
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.learning.training.test_several_robots import TINY
from tests.skills.fixed_world import Alone

NUMBERS = TINY | {"ppo.network": "entities", "environment.mates": 2, "environment.opponents": 3}
WORLDS = [
    {"blue": ["learner"], "yellow": ["challenge"]},
    {"blue": ["goalkeeper", "learner", "learner"], "yellow": ["goalkeeper", "challenge", "challenge"]},
]


def world(learners: int) -> SoccerSettings:
    return SoccerSettings(blue=("learner",) * learners, mates=5, opponents=6)


@pytest.mark.parametrize(
    ("learners", "n", "expected"),
    [
        ([1, 2, 5], 12, [3, 4, 5]),
        ([1, 2, 5], 192, [64, 64, 64]),
        ([2, 2, 2], 14, [6, 4, 4]),
        ([3, 1], 4, [3, 1]),
    ],
)
def test_worlds_have_about_as_many_learners_each(learners: list[int], n: int, expected: list[int]) -> None:
    found = learners_in([world(count) for count in learners], n)
    assert sum(found) == n
    assert all(count % own == 0 for count, own in zip(found, learners, strict=True))
    assert max(found) - min(found) <= max(learners)
    if learners != [1, 2, 5] or n == 12:
        assert found == expected


@pytest.mark.parametrize(("learners", "n"), [([2, 4], 7), ([3, 3], 3), ([1, 5], 5)])
def test_learners_fill_whole_arenas(learners: list[int], n: int) -> None:
    with pytest.raises(ValueError, match="do not fill whole arenas"):
        learners_in([world(count) for count in learners], n)


def test_each_robot_of_teams_of_unequal_size_has_a_row() -> None:
    made = arenas_of([world(1), world(2)], 6, central=False)
    assert isinstance(made, SeveralWorlds)
    assert [part.n for part in made.parts] == [4, 2]
    seen = made.reset(0)
    assert seen.shape == (6, 19 + 4 * 11)
    # A robot that is alone sees no mate; two see each other.
    assert (seen[:4, 19] == -5.0).all()
    assert (seen[4:, 19] != -5.0).all()


def test_settings_name_what_does_not_fit() -> None:
    with pytest.raises(SettingsError, match=r"collection\.num_envs: 15 learners do not fill whole arenas"):
        load_settings("small3v3", "fast", NUMBERS | {"collection.num_envs": 15, "worlds": [WORLDS[1]] * 2})
    with pytest.raises(SettingsError, match=r"ppo\.network: entities is for tasks of several robots"):
        load_settings("score_on_goalkeeper", "fast", {"ppo.network": "entities"})


@pytest.mark.integration
def test_a_run_over_numbers_goes_on_with_other_numbers_and_plays_with_any(tmp_path: Path) -> None:
    first = train(load_settings("small3v3", "fast", NUMBERS | {"worlds": WORLDS}), tmp_path / "first")
    more = NUMBERS | {"init": str(tmp_path / "first"), "environment.mates": 4, "environment.opponents": 5}
    settings = load_settings("small3v3", "fast", more | {"ppo.critic_warmup_steps": 480, "steps": 240})
    second = train(settings, tmp_path / "second")
    given = load_actor(tmp_path / "first" / "actor.pt").state_dict()
    for name, weight in second.actor.state_dict().items():
        if name != "inverse_scale":
            torch.testing.assert_close(weight, given[name], rtol=0.0, atol=0.0)
    (path,) = export_run(tmp_path / "first", "any", tmp_path, starts=2)
    policy = load_policy(path)
    assert policy.card.observation.name == "team_view_10_11"
    # The card's environment has the places that the model observes, so that the model can be judged in it.
    environment = SoccerSettings.model_validate(policy.card.environment)
    assert make_task(environment, 1).observation.size == policy.card.observation.size
    few = np.random.default_rng(0).normal(size=(5, 19 + 4 * 5))
    empty = [-5.0, 0.0, 0.0, 0.0]
    many = np.column_stack((few[:, :27], [empty * 8] * 5, few[:, 27:], [empty * 8] * 5))
    np.testing.assert_allclose(policy(many), policy_of(first.actor)(few), atol=1e-6)
    leaf = Alone(LearnedSkill(model=str(path)))
    for mates in range(10):
        own = tuple(robot(x=-1.0 - 0.3 * k, number=1 + k) for k in range(mates))
        assert leaf.tick(frame(robot(), (1.0, 0.0), mates=own)) is Status.RUNNING


@pytest.mark.integration
def test_a_flat_network_is_not_taken_over(tmp_path: Path) -> None:
    train(load_settings("small3v3", "fast", TINY | {"steps": 120}), tmp_path / "flat")
    settings = load_settings("small3v3", "fast", NUMBERS | {"init": str(tmp_path / "flat")})
    with pytest.raises(TrainError, match="serves one number of robots only"):
        train(settings, tmp_path / "next")
