"""Learning against a pool of past selves and scripts, in stages, and from another run's policy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from robobt.learning.agents.networks import Actor, policy_of
from robobt.learning.agents.past_selves import PastSelves
from robobt.learning.envs import ArenaTask
from robobt.learning.envs.per_robot import OneSide, PerRobot, SeveralWorlds
from robobt.learning.envs.soccer.suite import SUITE
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.training.arenas import opposed, opposed_arenas
from robobt.learning.training.problems import problem_for
from robobt.learning.training.run import TrainError
from robobt.learning.training.run_folder import load_actor
from robobt.learning.training.setting_groups import PoolSettings, Script
from robobt.learning.training.settings import SettingsError, load_settings, stage_after
from robobt.learning.training.train import train
from tests.learning.tiny import broken_off_and_resumed
from tests.learning.training.test_several_robots import TINY

SELF_PLAY = {
    **TINY,
    "ppo.critic": "central",
    "ppo.hidden_sizes": [8],
    "pool.every": 240,
    "pool.size": 2,
    "evaluation.held_out": 1,
}


def actor(seed: int) -> Actor:
    return Actor([1.0] * 3, 2, [4], generator=torch.Generator().manual_seed(seed))


def test_each_past_self_plays_in_as_many_arenas_and_the_oldest_goes() -> None:
    pool, actors = PastSelves(2), [actor(seed) for seed in range(3)]
    for steps, one in zip((0, 100, 1000), actors, strict=True):
        pool.add(one, steps)
    assert pool.taken == [100, 1000]
    seen = np.random.default_rng(0).normal(size=(4, 2, 3))
    expected = np.concatenate(
        [policy_of(one)(part) for one, part in ((actors[1], seen[:2]), (actors[2], seen[2:]))]
    )
    np.testing.assert_array_equal(pool.decide(seen), expected)
    # They are copies: what is learned afterwards does not change them.
    with torch.no_grad():
        actors[2].body[0].weight.mul_(2.0)
    np.testing.assert_array_equal(pool.decide(seen), expected)
    other = PastSelves(2)
    other.restore(pool.state(), actors[0].build)
    assert other.taken == pool.taken
    np.testing.assert_array_equal(other.decide(seen), expected)


def test_against_others_blues_learners_alone_have_rows() -> None:
    def made() -> PerRobot:
        return PerRobot(SoccerTask(SUITE["Small3v3"](time_limit=6), 3), central=True)

    told = []

    def others(seen: np.ndarray) -> np.ndarray:
        told.append(seen)
        return np.full((3, 2, 4), 0.25)

    side, whole = OneSide(made(), others), made()
    seen, all_ = side.reset(5), whole.reset(5)
    blue = np.tile([True, True, False, False], 3)
    rng = np.random.default_rng(1)
    for _ in range(4):
        np.testing.assert_array_equal(seen, all_[blue])
        actions = np.full((12, 4), 0.25)
        actions[blue] = rng.uniform(-1.0, 1.0, (6, 4))
        result, same = side.step(actions[blue]), whole.step(actions)
        np.testing.assert_array_equal(told[-1].reshape(6, -1), all_[~blue][:, : whole.observation.size])
        np.testing.assert_array_equal(result.reward, same.reward[blue])
        np.testing.assert_array_equal(result.final_observation, same.final_observation[blue])
        seen, all_ = result.observation, same.observation
    assert (side.n, side.observation_size) == (6, whole.observation_size)


def test_the_pools_shares_are_shares_of_the_learners() -> None:
    team = {"play": "team_player", "params": {"without": "score"}}
    pool = PoolSettings.model_validate(
        {"share": 0.25, "scripts": ["attack", "press"], "scripted": 0.5, "plays": [team], "played": 0.1}
    )
    made = opposed_arenas(SUITE["Small3v3"](), pool, lambda seen: seen, 48, central=False)
    assert isinstance(made, SeveralWorlds)
    itself, past, attack, press, play = made.parts
    assert [part.n for part in made.parts] == [8, 12, 12, 12, 4]
    assert isinstance(itself, PerRobot)
    assert isinstance(past, OneSide)
    assert isinstance(attack, PerRobot)
    assert isinstance(press, PerRobot)
    # An arena has four learners in self-play, else two.
    assert isinstance(play, PerRobot)
    assert [part.task.n for part in (itself, attack, press, play)] == [2, 6, 6, 2]
    assert attack.task.settings.yellow == ("goalkeeper", "attack", "attack")
    assert press.task.settings.yellow == ("goalkeeper", "press", "press")
    assert play.task.settings.yellow == ("goalkeeper", "play", "play")
    assert [one.model_dump() for one in play.task.settings.plays] == [team, team]


@pytest.mark.parametrize("scripts", [("attack", "press"), ("still", "press", "mark", "wall", "attack")])
def test_shares_that_are_rounded_up_take_no_more_than_there_are(scripts: tuple[Script, ...]) -> None:
    pool = PoolSettings(share=0.5, scripts=scripts, scripted=0.5)
    for n in range(4, 100, 4):
        counts = opposed(SUITE["Small3v3"](), pool, n)
        assert len(counts) == 1 + len(scripts)
        assert all(count % 4 == 0 for count in counts)
        assert 0 <= n - sum(counts) <= 4 * len(scripts)


@pytest.mark.integration
def test_a_run_against_its_past_selves_that_is_broken_off_ends_as_if_it_had_not_been(tmp_path: Path) -> None:
    settings = load_settings("duel", "self_play", SELF_PLAY)
    whole = train(settings, tmp_path / "whole")
    resumed = broken_off_and_resumed(settings, tmp_path / "broken", 360)
    assert resumed.figures["weights"] == whole.figures["weights"]
    kept = [sorted((tmp_path / run / "past").iterdir()) for run in ("whole", "broken")]
    assert [path.name for path in kept[0]] == ["0000000000.pt", "0000000240.pt", "0000000480.pt"]
    for path, same in zip(*kept, strict=True):
        first, second = load_actor(path).state_dict(), load_actor(same).state_dict()
        assert all(torch.equal(first[name], second[name]) for name in first)
    # A run that begins with its policy has that, as long as the value alone is learned.
    few = {**SELF_PLAY, "steps": 120, "init": str(tmp_path / "whole"), "ppo.critic_warmup_steps": 10_000}
    begun = train(load_settings("duel", "self_play", few), tmp_path / "begun").actor.state_dict()
    assert all(torch.equal(begun[name], weight) for name, weight in whole.actor.state_dict().items())
    nowhere = load_settings("duel", "self_play", {**few, "init": str(tmp_path)})
    with pytest.raises(TrainError, match=r"init: .* is not the folder of a finished run"):
        train(nowhere, tmp_path / "nowhere")
    with pytest.raises(TrainError, match=r"init: the policy of .* observes 23 entries"):
        train(load_settings("duel", "self_play", {**few, "ppo.hidden_sizes": [7]}), tmp_path / "other")
    # One who sees more robots does at first as if it saw but those.
    changes = {**few, "ppo.critic": "own", "environment.opponents": 3}
    more = train(load_settings("duel", "self_play", changes), tmp_path / "more").actor
    seen = torch.rand(5, 31, generator=torch.Generator().manual_seed(0))
    torch.testing.assert_close(more(seen), whole.actor(seen[:, :23]))


def test_a_stage_begins_after_its_share_of_the_steps() -> None:
    changes = {
        "stages": [{"share": 1, "environment": {"yellow": ["attack"]}}, {"share": 0.25}],
        "steps": 1000,
    }
    settings = load_settings("duel", "fast", changes)
    assert [stage_after(settings, steps) for steps in (0, 799, 800, 1000)] == [0, 0, 1, 1]
    later = problem_for(settings).later
    assert later is not None
    tasks = [later(steps, lambda seen: seen) for steps in (0, 900)]
    assert isinstance(tasks[0], ArenaTask)
    assert isinstance(tasks[1], SeveralWorlds)
    assert (len(tasks[0].learners), tasks[0].n, tasks[1].n) == (1, 192, 192)
    assert isinstance(tasks[1].parts[0], PerRobot)
    assert tasks[1].parts[0].each == 2


@pytest.mark.parametrize(
    ("task", "changes", "said"),
    [
        ("attack3v2", {"pool.share": 0.5}, "pool: is for tasks whose two teams"),
        ("duel", {"pool.share": 0.5, "worlds": [{}, {}]}, "pool: there is none with several worlds"),
        ("duel", {"pool.share": 0.7, "pool.scripts": ["attack"], "pool.scripted": 0.7}, "more than 1"),
        ("duel", {"pool.scripts": ["attack"]}, "scripted, are given together"),
        ("duel", {"pool.plays": ["attack_main"]}, "played, are given together"),
        ("duel", {"pool.plays": ["nobody"], "pool.played": 0.1}, r"pool\.plays\.0\.play: no play is called"),
        ("duel", {"pool.every": 1, "pool.share": 0.5}, "multiple of rebuild_every"),
        ("duel", {"stages": [{"share": 1, "environment": {"yellow": ["wall"] * 2}}]}, r"stages\[0\].* 27 "),
        ("duel", {"stages": [{"share": 1, "pool": {"sizes": 3}}]}, r"pool with stages\[0\]"),
        ("duel", {"stages": [{"share": 1, "pool": {"size": 3}}]}, r"stages\.0: pool\.size is"),
        ("small3v3", {"pool.share": 0.01}, "pool: 192 learners are too few"),
        ("duel", {"evaluation.environment": {"yellow": ["wall", "wall"]}}, "evaluation: a robot sees 27"),
        ("go_to_ball", {"stages": [{"share": 1}]}, "for learner ppo"),
    ],
)  # fmt: skip
def test_what_makes_no_self_play_is_refused(task: str, changes: dict[str, Any], said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        load_settings(task, "fast", changes)


def test_a_run_does_not_begin_with_a_policy_that_was_asked_in_another_frame(tmp_path: Path) -> None:
    robot = {**TINY, "stages": [], "ppo.frame": "robot"}
    train(load_settings("go_to_ball_among_robots", "fast", robot), tmp_path / "robot")
    ball = {**robot, "ppo.frame": "ball", "init": str(tmp_path / "robot")}
    with pytest.raises(
        TrainError, match=r"init: the policy of .* was trained in another frame, see ppo.frame"
    ):
        train(load_settings("go_to_ball_among_robots", "fast", ball), tmp_path / "ball")
