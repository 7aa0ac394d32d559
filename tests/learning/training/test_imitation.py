"""Imitation of plays and models by a policy for several robots."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robobt.learning.agents.networks import policy_of
from robobt.learning.agents.ppo import PPO
from robobt.learning.agents.rollout import Rollout
from robobt.learning.agents.settings import PPOSettings
from robobt.learning.envs import GoToBallTask
from robobt.learning.envs.per_robot import PerRobot, SeveralWorlds
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import SUITE
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.training.arenas import opposed_arenas
from robobt.learning.training.imitation import Lesson
from robobt.learning.training.setting_groups import ImitationSettings, PoolSettings
from robobt.learning.training.settings import SettingsError, load_settings
from robobt.learning.training.teachers import TeacherError, actions_of, teacher_of
from robobt.learning.training.train import train
from robobt.models.actions import SCORE_ACTION, command_of
from robobt.models.policy import load_policy
from robobt.sim.world import command_row
from tests.learning.tiny import broken_off_and_resumed
from tests.learning.training.test_several_robots import TINY

MODEL = "small3v3_ppo"


def test_an_action_stands_for_the_command_that_it_was_made_of() -> None:
    rng = np.random.default_rng(0)
    actions = rng.uniform(-1.0, 1.0, (50, 4))
    actions[:, :2] /= np.maximum(np.hypot(actions[:, :1], actions[:, 1:2]), 1.0)
    actions[:, 3] = np.sign(actions[:, 3])
    commands = np.array([command_row(command_of(action, SCORE_ACTION)) for action in actions])
    np.testing.assert_allclose(actions_of(commands, SCORE_ACTION), actions, atol=1e-12)


def test_a_command_that_is_too_fast_keeps_its_direction() -> None:
    (action,) = actions_of(np.array([[3.0, 4.0, 60.0, 0.0, 0.0, 1.0, 0.0]]), SCORE_ACTION)
    np.testing.assert_allclose(action, [0.6, 0.8, 1.0, -1.0])


def test_a_model_teaches_what_it_would_do() -> None:
    task = SoccerTask(SUITE["Small3v3"](yellow=("goalkeeper", "challenge", "challenge")), 4)
    rows = PerRobot(task)
    seen = rows.reset(3)
    teacher, policy = teacher_of(task, MODEL, {}), load_policy(MODEL)
    for _ in range(3):
        shown = teacher.act().reshape(8, 4)
        np.testing.assert_allclose(shown, policy(seen), atol=1e-6)
        seen = rows.step(shown).observation


def test_a_play_brings_the_ball_and_shoots() -> None:
    """Left alone before an empty goal, the team's field player scores by what it shows."""
    settings = SoccerSettings(blue=("learner",), time_limit=600)
    task = SoccerTask(settings, 6)
    task.reset(1)
    teacher = teacher_of(task, "team_player", {"without": "score"})
    teacher.begin(np.arange(6))
    scored = np.zeros(6, dtype=np.bool_)
    for _ in range(300):
        step = task.step(teacher.act())
        teacher.begin(np.flatnonzero(step.terminated | step.truncated))
        scored |= step.success
    assert scored.sum() >= 5


def test_the_teacher_hands_over_arena_by_arena() -> None:
    task = PerRobot(SoccerTask(SUITE["Small3v3"](yellow=("goalkeeper", "challenge", "challenge")), 40))
    alone = SoccerTask(SoccerSettings(blue=("learner",), mates=2, opponents=3), 40)
    both = SeveralWorlds([task, alone])
    both.reset(0)
    lesson = Lesson(both, ImitationSettings(teachers=(MODEL,), steps=1000))
    rng = np.random.default_rng(0)
    own = np.full((120, 4), 0.5)
    shares = []
    for steps in (0, 500, 1000):
        lesson.share_out(steps, rng)
        shown, done = lesson.next(own)
        acts = (done == shown).all(axis=1)
        np.testing.assert_array_equal(done[~acts], own[~acts])
        # Two learners of an arena are moved by the same one.
        assert (acts[:80:2] == acts[1:80:2]).all()
        shares.append(acts.mean())
    assert shares[0] == 1.0
    assert 0.3 < shares[1] < 0.7
    assert shares[2] == 0.0


def test_what_cannot_teach_is_refused() -> None:
    with pytest.raises(TeacherError, match="for tasks of several robots, not go_to_ball"):
        teacher_of(GoToBallTask(), MODEL, {})
    pool = PoolSettings(share=1.0)
    past = opposed_arenas(SUITE["Small3v3"](), pool, lambda seen: seen, 8, central=False)
    with pytest.raises(TeacherError, match="nobody teaches against a pool"):
        Lesson(past, ImitationSettings(teachers=(MODEL,), steps=10))
    with pytest.raises(TeacherError, match=r"go_to_ball_ddpg: observes go_to_ball"):
        teacher_of(SoccerTask(), "go_to_ball_ddpg", {})
    with pytest.raises(SettingsError, match="teachers are given together with steps or a weight"):
        load_settings("small3v3", "fast", {"imitation.steps": 100})
    with pytest.raises(SettingsError, match="pool and imitation are for learner ppo"):
        load_settings("shoot", "fast", {"imitation": {"teachers": [MODEL], "steps": 100}})


def test_imitation_leaves_the_spread_alone() -> None:
    one = PPO(PPOSettings(hidden_sizes=(16,), init_std=0.5), (1.0, 1.0), (True, False), 0)
    rng = np.random.default_rng(0)
    rollout = Rollout.empty(20, 20, 2, 2)
    rollout.observation[:] = rng.normal(size=(20, 20, 2))
    rollout.action[:] = np.clip(rollout.observation, -1.0, 1.0)
    rollout.action[..., 1] = np.sign(rollout.action[..., 1])
    rollout.ended[:] = rollout.terminated[:] = True
    for _ in range(300):
        one.update(rollout, rng, "imitate")
    one.diagnostics.clear()
    one.update(rollout, rng, "imitate")
    error = one.diagnostics.means()["imitation_error"]
    assert error is not None
    assert error < 0.2
    assert one.state()["spread.log"] == pytest.approx(np.log(0.5))
    answer = one.act(rollout.observation[0], rng)
    assert (np.sign(answer[:, 1]) == rollout.action[0, :, 1]).mean() > 0.8


def test_a_policy_that_improves_stays_close_to_what_a_teacher_shows() -> None:
    def off_after(weight: float) -> float:
        one = PPO(PPOSettings(hidden_sizes=(16,), init_std=0.5), (1.0, 1.0), (True, False), 0)
        rng = np.random.default_rng(0)
        rollout = Rollout.empty(20, 20, 2, 2)
        rollout.shown = np.zeros_like(rollout.action)
        rollout.ended[:] = rollout.terminated[:] = True
        for _ in range(30):
            rollout.observation[:] = rng.normal(size=(20, 20, 2))
            rollout.shown[..., 0] = np.clip(-rollout.observation[..., 0], -1.0, 1.0)
            rollout.shown[..., 1] = -1.0
            for t in range(20):
                seen = rollout.observation[t]
                rollout.action[t] = one.act(seen, rng)
                rollout.log_probability[t] = one.log_probabilities(seen, rollout.action[t])
                rollout.value[t] = one.values(seen)
            # It is rewarded for the opposite of what the teacher does.
            rollout.reward[:] = -rollout.action[..., 0] * rollout.shown[..., 0]
            one.update(rollout, rng, imitation=weight)
        output = policy_of(one.actor)(rollout.observation.reshape(-1, 2))
        return float(np.abs(output[:, 0] - rollout.shown[..., 0].ravel()).mean())

    assert off_after(0.0) > 0.6
    assert off_after(10.0) < 0.25


def test_the_lesson_goes_on_if_it_has_a_weight(tmp_path: Path) -> None:
    imitation = {"teachers": [MODEL], "weight": 0.5}
    found = {}
    for name, changes in (("taught", {"imitation": imitation}), ("alone", {})):
        network = {"ppo.network": "entities", "environment.yellow": ["goalkeeper", "challenge", "challenge"]}
        found[name] = train(load_settings("small3v3", "fast", TINY | network | changes), tmp_path / name)
    (first, *_), (other, *_) = found["taught"].validations, found["alone"].validations
    assert {"imitation_loss", "policy_loss"} <= set(first.losses)
    assert "imitation_loss" not in other.losses
    assert found["taught"].figures["weights"] != found["alone"].figures["weights"]


@pytest.mark.integration
@pytest.mark.parametrize(("teacher", "weight"), [(MODEL, 0.5), ("team_player", 0.0)])
def test_a_run_that_imitates_and_is_broken_off_ends_as_if_it_had_not_been(
    tmp_path: Path, teacher: str, weight: float
) -> None:
    changes = {
        "ppo.network": "entities",
        "environment.yellow": ["goalkeeper", "challenge", "challenge"],
        "imitation": {"teachers": [teacher], "steps": 360, "weight": weight},
    }
    settings = load_settings("small3v3", "fast", TINY | changes)
    whole = train(settings, tmp_path / "whole")
    resumed = broken_off_and_resumed(settings, tmp_path / "broken", 240)
    assert resumed.figures["weights"] == whole.figures["weights"]
    first, last = whole.validations
    assert "imitation_loss" in first.losses
    assert "policy_loss" in last.losses
