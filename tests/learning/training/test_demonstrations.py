from __future__ import annotations

import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from robobt.learning.envs import GoToBallSettings, GoToBallTask, ShootSettings, ShootTask
from robobt.learning.training.demonstrations import (
    DemonstrationsError,
    demonstrations_for,
    read_demonstrations,
    record,
)
from robobt.learning.training.problems import problem_of
from robobt.learning.training.settings import load_settings
from robobt.learning.training.teachers import action_of, script
from robobt.learning.training.train import train
from robobt.models.actions import GO_TO_BALL_ACTION, SHOOT_ACTION, command_of
from robobt.world.command import KickTrigger, RobotCommand


@pytest.fixture(scope="module")
def recorded():
    return record(GoToBallSettings(), 12, "script", seed=3)


@pytest.mark.integration
def test_the_straight_drive_reaches_every_start_in_the_shortest_time():
    settings = GoToBallSettings()
    task = GoToBallTask(settings)
    figures = problem_of(settings).evaluate(script(task).act, "validation", 200)
    assert figures.rate == 1.0
    assert (figures.times <= figures.optimum + 2 * settings.period + 1e-9).all()
    assert figures.time_ratio is not None
    assert figures.time_ratio < 1.01


@pytest.mark.integration
@pytest.mark.parametrize("simulator", ["default", "robobulls", "erforce"])
def test_the_scripted_shooter_hardly_ever_misses(simulator):
    settings = ShootSettings(simulator=simulator)
    figures = problem_of(settings).evaluate(script(ShootTask(settings)).act, "validation", 200)
    assert figures.rate >= 0.99


@pytest.mark.integration
@pytest.mark.parametrize(("environment", "share"), [(GoToBallSettings(), 0.9), (ShootSettings(), 0.95)])
def test_the_hand_written_skills_do_their_tasks(environment, share):
    shown = record(environment, 40, "skill", seed=1)
    assert shown.episodes == 40
    assert shown.success.sum() >= share * 40


def test_episodes_are_whole_and_chained(recorded):
    assert recorded.episodes == 12
    assert recorded.episode.tolist() == sorted(recorded.episode.tolist())
    ended = recorded.terminated | recorded.truncated
    inside = np.flatnonzero(~ended)
    assert np.array_equal(recorded.next_observation[inside], recorded.observation[inside + 1])
    assert np.array_equal(np.flatnonzero(ended)[:-1] + 1, np.flatnonzero(np.diff(recorded.episode)) + 1)
    assert (np.abs(recorded.action) <= 1.0).all()
    assert recorded.reward[recorded.success].min() > 90.0


def test_the_seed_fixes_what_is_recorded(recorded):
    again = record(GoToBallSettings(), 12, "script", seed=3)
    assert np.array_equal(again.observation, recorded.observation)
    assert not np.array_equal(
        record(GoToBallSettings(), 12, "script", seed=4).reward[:20], recorded.reward[:20]
    )


def test_the_file_is_plain_parquet_that_says_what_it_is(recorded, tmp_path):
    recorded.write(tmp_path / "d.parquet")
    table = pq.read_table(tmp_path / "d.parquet")
    assert table.column_names == [
        "episode",
        "tick",
        "observation",
        "action",
        "reward",
        "next_observation",
        "terminated",
        "truncated",
        "success",
    ]
    about = json.loads(table.schema.metadata[b"robobt"])
    assert about["observation"] == {"name": "go_to_ball", "version": 1}
    assert about["environment"]["period"] == 0.03
    assert (about["teacher"], about["seed"]) == ("script", 3)
    first = table.slice(0, 2).to_pylist()
    assert [row["tick"] for row in first] == [0, 1]
    assert first[0]["observation"] == recorded.observation[0].tolist()
    assert [path.name for path in tmp_path.iterdir()] == ["d.parquet"]


def test_what_was_written_is_read(recorded, tmp_path):
    recorded.write(tmp_path / "d.parquet")
    again = read_demonstrations(tmp_path / "d.parquet")
    for name in (
        "episode",
        "observation",
        "action",
        "reward",
        "next_observation",
        "terminated",
        "truncated",
        "success",
    ):
        assert np.array_equal(getattr(again, name), getattr(recorded, name)), name
    assert again.about == recorded.about
    assert again.first(3).episodes == 3


def test_transitions_are_those_of_the_replay(recorded):
    rows = [row for parts in recorded.transitions((3,), 0.9) for row in parts]
    assert sum(len(row.reward) for row in rows) == len(recorded)
    last = np.flatnonzero(recorded.terminated)[0]
    ends = [
        row for row in rows if (row.next_observation == recorded.next_observation[last]).all(axis=1).any()
    ]
    assert all(row.discount[0] == 0.0 for row in ends)


def test_files_that_are_none_give_one_clear_error(recorded, tmp_path):
    wrong = tmp_path / "wrong.parquet"
    wrong.write_bytes(b"PAR1 nonsense")
    with pytest.raises(DemonstrationsError, match=r"wrong.parquet: no demonstrations can be read"):
        read_demonstrations(wrong)
    pq.write_table(pa.table({"a": [1]}), wrong)
    with pytest.raises(DemonstrationsError, match=r"wrong.parquet"):
        read_demonstrations(wrong)
    recorded.write(wrong)
    with pytest.raises(DemonstrationsError, match="holds demonstrations of"):
        demonstrations_for(ShootSettings(), 5, str(wrong), 0)
    with pytest.raises(DemonstrationsError, match="holds 12 episodes, not 50"):
        demonstrations_for(GoToBallSettings(), 50, str(wrong), 0)
    assert demonstrations_for(GoToBallSettings(), 5, str(wrong), 0).episodes == 5
    with pytest.raises(DemonstrationsError, match=r"gone.parquet: .*there is no such file"):
        read_demonstrations(tmp_path / "gone.parquet")
    (tmp_path / "folder").mkdir()
    with pytest.raises(IsADirectoryError) as caught:
        recorded.write(tmp_path / "folder")
    # Not the temporary file's name, of which nobody knows.
    assert caught.value.filename == str(tmp_path / "folder")


@pytest.mark.parametrize(
    ("changes", "part"),
    [
        ({"action": {"kind": "drive", "max_speed": 3.0, "max_turn": 1.395}}, "action"),
        ({"period": 0.02}, "period"),
        ({"reward": {"contact": 10.0}}, "reward"),
        ({"contact": {"rule": "infrared"}}, "contact"),
    ],
)
def test_demonstrations_whose_actions_or_rewards_mean_something_else_are_refused(
    recorded, changes, part, tmp_path
):
    recorded.write(tmp_path / "d.parquet")
    with pytest.raises(DemonstrationsError, match=rf"recorded with another environment\.{part}: .*, here "):
        demonstrations_for(GoToBallSettings(**changes), 5, str(tmp_path / "d.parquet"), 0)
    elsewhere = GoToBallSettings(simulator="robobulls")
    assert demonstrations_for(elsewhere, 5, str(tmp_path / "d.parquet"), 0).episodes == 5


def test_an_action_is_turned_into_the_command_it_stands_for_and_back():
    drive = RobotCommand(0.9, -0.6, 0.7)
    back = command_of(action_of(drive, GO_TO_BALL_ACTION), GO_TO_BALL_ACTION)
    assert (back.vx, back.vy, back.omega) == pytest.approx((0.9, -0.6, 0.7))
    fast = command_of(action_of(RobotCommand(6.0, 8.0, -9.0), GO_TO_BALL_ACTION), GO_TO_BALL_ACTION)
    assert (fast.vx, fast.vy, fast.omega) == pytest.approx((0.9, 1.2, -1.395))
    kick = RobotCommand(omega=4.0, kick_speed=5.0, kick_trigger=KickTrigger.NOW, dribbler=True)
    assert command_of(action_of(kick, SHOOT_ACTION), SHOOT_ACTION) == kick


@pytest.mark.integration
@pytest.mark.parametrize("preset", ["ddpgfd", "cmu"])
def test_training_begins_with_demonstrations(tmp_path, preset):
    changes = {
        "steps": 128,
        "agent.hidden_sizes": [16],
        "replay.batch_size": 16,
        "replay.demonstrations.episodes": 5,
        "replay.demonstrations.pretrain_gradient_steps": 20,
        "collection.learning_starts": 64,
        "evaluation.every": 128,
        "evaluation.starts": 4,
        "evaluation.held_out": 4,
        "rebuild_every": 128,
        "tensorboard": False,
    }
    result = train(load_settings("shoot", preset, changes), tmp_path)
    assert result.figures["updates"] == 20 + 2
