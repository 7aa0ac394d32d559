from __future__ import annotations

import pytest

from benchmarks.train import variants
from robobt.config.yaml import parse_marked, write_yaml
from robobt.learning import TASKS
from robobt.learning.agents.settings import AgentSettings, PPOSettings
from robobt.learning.training.preset_files import assign, presets
from robobt.learning.training.run_folder import SETTINGS, RunFolderError, read_settings
from robobt.learning.training.setting_groups import (
    DemonstrationSettings,
    ExperienceSettings,
    PrioritySettings,
    ReplaySettings,
)
from robobt.learning.training.settings import (
    SettingsError,
    load_settings,
    settings_of,
)

ALL = [(task, preset) for task in TASKS for preset in presets(task)]


@pytest.mark.parametrize(("task", "preset"), ALL)
def test_every_shipped_preset_is_valid(task, preset):
    settings = load_settings(task, preset)
    assert settings.task == task
    assert settings.preset == preset
    assert isinstance(settings.environment, TASKS[task].Settings)


PAPERS = ("go_to_ball", "shoot")
"""The paper's two tasks."""


@pytest.mark.parametrize("task", TASKS)
def test_every_task_has_a_fast_preset(task):
    assert "fast" in presets(task)


def test_the_presets_of_the_papers_tasks():
    for task in PAPERS:
        assert {"fast", "paper", "td3", "d4pg", "ddpgfd", "cmu"} <= set(presets(task))


@pytest.mark.parametrize("task", PAPERS)
def test_the_papers_preset_is_spinning_up_to_the_letter(task):
    settings = load_settings(task, "paper")
    agent, collection = settings.agent, settings.collection
    assert agent.hidden_sizes == (256, 256)
    assert (agent.gamma, agent.tau) == (0.99, pytest.approx(1 - 0.995))
    assert (agent.actor_learning_rate, agent.critic_learning_rate) == (1e-3, 1e-3)
    assert (settings.replay.batch_size, settings.replay.buffer_size) == (100, 1_000_000)
    assert (collection.num_envs, collection.random_steps, collection.learning_starts) == (1, 10_000, 1_000)
    assert (collection.train_freq, collection.gradient_steps, collection.exploration_noise) == (50, 50, 0.1)
    switched_off = AgentSettings().model_dump() | {"scale_observations": False}
    assert agent.model_dump() == switched_off


def test_later_papers_switch_on_what_they_are_known_for():
    td3 = load_settings("go_to_ball", "td3").agent
    assert td3.twin_critics
    assert td3.policy_delay == 2
    assert td3.target_policy_noise > 0
    d4pg = load_settings("go_to_ball", "d4pg")
    assert d4pg.agent.num_atoms > 0
    assert d4pg.agent.n_step == 5
    assert d4pg.replay.priority.enabled
    fd = load_settings("shoot", "ddpgfd")
    assert fd.replay.demonstrations.keep
    assert fd.replay.demonstrations.bonus > 0
    assert fd.agent.one_step_weight > 0
    cmu = load_settings("shoot", "cmu")
    assert cmu.replay.demonstrations.episodes > 0
    assert not cmu.replay.demonstrations.keep
    assert cmu.collection.random_steps == 0


@pytest.mark.parametrize("task", PAPERS)
def test_a_comparison_changes_one_switch_at_a_time_on_one_budget(task):
    found = variants(task)
    fast = found["fast"]
    assert fast == load_settings(task, "fast")
    assert len({settings.model_dump_json() for settings in found.values()}) == len(found)
    for name, settings in found.items():
        if name != "paper":
            assert settings.steps == fast.steps
            assert settings.evaluation == fast.evaluation


def test_a_preset_may_be_a_file_that_extends_another(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("extends: fast\nagent: {n_step: 7}\n")
    settings = load_settings("go_to_ball", str(file), {"agent.tau": 0.5, "seed": 3})
    assert (settings.agent.n_step, settings.agent.tau, settings.seed) == (7, 0.5, 3)
    assert settings.agent.hidden_sizes == load_settings("go_to_ball", "fast").agent.hidden_sizes


def test_settings_survive_being_written_and_read():
    settings = load_settings("shoot", "ddpgfd", {"environment.simulator": "robobulls"})
    text = write_yaml(settings.model_dump(mode="json"))
    assert settings_of(parse_marked(text, "yaml").plain(), "text") == settings
    assert settings.environment.simulator.dribbler.kind == "glue"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"agent.gamma": 1.0}, r"fast\.yaml, with agent\.gamma changed: agent\.gamma: .*less than 1"),
        ({"agent.tauu": 1.0}, r"agent\.tauu: there is no such field; did you mean tau\?"),
        ({"agent.num_atoms": 1}, r"agent: .*num_atoms must be 0 or at least 2"),
        (
            {"evaluation.every": 100},
            r"evaluation\.every must be a multiple of collection\.num_envs \(64\)",
        ),
        (
            {"environment.simulator": "gazebo"},
            r"environment\.simulator: no simulator preset is called 'gazebo'",
        ),
        ({"ppo.frame": "ball"}, r"ppo\.frame: the ball's frame is for go_to_ball_among_robots"),
        ({"environment.periodd": 1}, r"environment\.periodd: there is no such field"),
        ({"replay.demonstrations.bonus": 1.0}, r"replay: demonstrations get a bonus only with"),
        ({"seed.x": 1}, r"there is no such field|seed: .*integer"),
    ],
)
def test_wrong_settings_are_one_line_that_names_file_and_field(changes, said):
    with pytest.raises(SettingsError, match=said) as caught:
        load_settings("go_to_ball", changes=changes)
    assert "\n" not in str(caught.value)
    # The fault may be the change's, not the file's.
    assert f"with {next(iter(changes))} changed: " in str(caught.value)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("[1, 2]", "must hold a mapping"),
        ("extends: [a]", "extends: must name another preset"),
        ("{extends: fast, agent: {tau: -1}}", r"mine.yaml: agent\.tau: .*greater than 0"),
        ("agent: {tau: ", r"mine.yaml:1: "),
        ("extends: nothing", "no preset of go_to_ball is called 'nothing'"),
    ],
)
def test_a_wrong_file_is_one_line_too(tmp_path, content, said):
    (tmp_path / "mine.yaml").write_text(content)
    with pytest.raises(SettingsError, match=said):
        load_settings("go_to_ball", str(tmp_path / "mine.yaml"))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"ppo.trace": 0.9}, r"ppo\.trace: has been renamed: use gae_lambda$"),
        ({"agent.returns": [-1.0, 1.0]}, r"agent\.returns: has been renamed: use v_min and v_max$"),
        ({"replay.priority.floor": 0.1}, r"replay\.priority\.floor: has been renamed: use epsilon$"),
        ({"collection.environments": 8}, r"collection\.environments: has been renamed: use num_envs$"),
    ],
)
def test_an_old_name_of_a_setting_is_an_error_that_says_the_new_one(tmp_path, changes, said):
    with pytest.raises(SettingsError, match=said):
        load_settings("go_to_ball", changes=changes)
    data = load_settings("go_to_ball").model_dump(mode="json")
    for name, value in changes.items():
        assign(data, name.split("."), value, name)
    (tmp_path / SETTINGS).write_text(write_yaml(data))
    with pytest.raises(RunFolderError, match=rf"{SETTINGS}: {said}"):
        read_settings(tmp_path)


@pytest.mark.parametrize(
    "group",
    [
        AgentSettings,
        PPOSettings,
        ReplaySettings,
        PrioritySettings,
        DemonstrationSettings,
        ExperienceSettings,
    ],
)
def test_a_renamed_setting_is_there_under_its_new_name_only(group):
    for old, new in group.renamed.items():
        assert old not in group.model_fields
        assert set(new.split(" and ")) <= set(group.model_fields)


def test_what_does_not_exist_is_told_with_what_does():
    with pytest.raises(SettingsError, match="'robobt list tasks' lists all"):
        load_settings("dance")
    with pytest.raises(SettingsError, match="there are cmu, d4pg, ddpg, ddpgfd, fast, paper"):
        load_settings("shoot", "slow")
    with pytest.raises(SettingsError, match="cannot be read"):
        load_settings("shoot", "slow.yaml")


def test_a_change_cannot_be_of_the_task_that_is_asked_for() -> None:
    with pytest.raises(SettingsError, match="task: is what is trained, go_to_ball: name another one instead"):
        load_settings("go_to_ball", changes={"task": "shoot"})
