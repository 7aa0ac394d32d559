from __future__ import annotations

import json
import signal
import time
import warnings
from dataclasses import replace

import numpy as np
import pytest
import torch
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from robobt.learning import TASKS
from robobt.learning.training import checkpoint
from robobt.learning.training.problems import split_seed, training_seed
from robobt.learning.training.run_folder import CHECKPOINT, RunFolderError, load_actor, load_run
from robobt.learning.training.settings import load_settings
from robobt.learning.training.train import TrainError, train
from tests.learning.tiny import SLIDE, Slide, slide_settings

pytestmark = pytest.mark.integration

EVERYTHING = {
    "agent__twin_critics": True,
    "agent__num_atoms": 21,
    "agent__v_min": -3.0,
    "agent__v_max": 1.5,
    "agent__one_step_weight": 0.5,
    "agent__target_policy_noise": 0.1,
    "agent__policy_delay": 2,
    "agent__layer_norm": True,
    "agent__final_learning_rate_fraction": 0.1,
    "agent__dqda_clipping": 1.0,
    "collection__exploration_noise_last_env": 0.5,
    "evaluation__target_actor": True,
    "replay__priority": {"enabled": True},
}

PPO = {
    "learner": "ppo",
    "ppo": {
        "hidden_sizes": (16,),
        "num_steps": 10,
        "minibatch_size": 40,
        "learning_rate": 5e-3,
        "gamma": 0.9,
    },
    "rebuild_every": 320,
}


class KilledError(BaseException):
    """Stands in for a signal: nothing in the learner catches it."""


def breaking_after(steps):
    """The task, but the process dies after so many steps of it."""
    left = [steps]

    class Breaking(Slide):
        def step(self, actions):
            left[0] -= 1
            if left[0] < 0:
                raise KilledError
            return super().step(actions)

    return replace(SLIDE, make=Breaking)


def break_and_resume(settings, folder, moments):
    for moment in moments:
        with pytest.raises(KilledError):
            train(settings, folder, resume=True, problem=breaking_after(moment))
    return train(settings, folder, resume=True, problem=SLIDE)


def without_clocks(validation):
    return [
        replace(each, cpu_s=0.0, evaluation_cpu_s=0.0, wall_s=0.0, steps_per_second=0.0)
        for each in validation
    ]


def test_the_task_is_learned(tmp_path):
    result = train(slide_settings(collection__gradient_steps=4), tmp_path / "run", problem=SLIDE)
    held = result.figures["held_out"]
    assert held["success"] >= 0.9
    assert held["low"] < held["success"] <= held["high"]
    assert held["time_ratio"] < 1.3


def test_the_task_is_learned_from_rollouts(tmp_path):
    result = train(slide_settings(**PPO, steps=4800), tmp_path / "run", problem=SLIDE)
    assert result.figures["held_out"]["success"] >= 0.9
    assert result.settings.algorithm == "ppo"


@pytest.mark.parametrize("switches", [{}, EVERYTHING, PPO], ids=["plain", "everything", "ppo"])
@pytest.mark.parametrize(
    "moments",
    [
        (100,),
        pytest.param((5, 41, 170), marks=pytest.mark.slow),
        pytest.param((60,) * 4, marks=pytest.mark.slow),
    ],
    ids=str,
)
def test_a_run_that_was_cut_off_and_resumed_ends_with_the_same_weights(tmp_path, switches, moments):
    settings = slide_settings(**switches)
    whole = train(settings, tmp_path / "whole", problem=SLIDE)
    broken = break_and_resume(settings, tmp_path / "broken", moments)
    assert broken.figures["weights"] == whole.figures["weights"]
    assert broken.figures["held_out"] == whole.figures["held_out"]
    assert without_clocks(broken.validations) == without_clocks(whole.validations)
    for a, b in zip(broken.actor.parameters(), whole.actor.parameters(), strict=True):
        assert torch.equal(a, b)


def test_the_log_of_a_resumed_run_has_every_evaluation_once(tmp_path):
    broken = break_and_resume(slide_settings(), tmp_path, (100, 70))
    lines = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [line["steps"] for line in lines] == [480, 960, 1440, 1920]
    assert [each.steps for each in broken.validations] == [480, 960, 1440, 1920]


@pytest.mark.parametrize(
    ("switches", "losses"),
    [
        ({}, {"critic_loss", "q_mean", "critic_grad_norm", "actor_grad_norm"}),
        (
            PPO,
            {
                "policy_loss",
                "value_loss",
                "value_mean",
                "entropy",
                "approx_kl",
                "clip_fraction",
                "explained_variance",
                "policy_grad_norm",
                "value_grad_norm",
            },
        ),
    ],
    ids=["ddpg", "ppo"],
)
def test_the_log_and_tensorboard_have_what_the_learner_reports(tmp_path, switches, losses):
    event_accumulator = pytest.importorskip("tensorboard.backend.event_processing.event_accumulator")
    result = train(slide_settings(**switches, tensorboard=True), tmp_path, problem=SLIDE)
    lines = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [line["losses"] for line in lines] == [each.losses for each in result.validations]
    events = event_accumulator.EventAccumulator(str(tmp_path / "tensorboard"))
    events.Reload()
    assert {f"losses/{name}" for name in losses} | {"charts/SPS", "eval/success_rate"} <= set(
        events.Tags()["scalars"]
    )
    for name in losses:
        told = [(event.step, event.value) for event in events.Scalars(f"losses/{name}")]
        assert told == [(line["steps"], pytest.approx(line["losses"][name], rel=1e-6)) for line in lines]
    assert all(line["steps_per_second"] > 0.0 for line in lines)


def test_the_same_seed_gives_the_same_weights_and_another_gives_others(tmp_path):
    hashes = [
        train(slide_settings(seed=seed, steps=960), tmp_path / str(i), problem=SLIDE).figures["weights"]
        for i, seed in enumerate((3, 3, 4))
    ]
    assert hashes[0] == hashes[1] != hashes[2]


def test_progress_and_the_clock_change_nothing(tmp_path):
    shown = []
    seen = train(slide_settings(steps=960), tmp_path / "a", problem=SLIDE, on_progress=shown.append)
    rare = slide_settings(steps=960, checkpoint_seconds=60.0)
    unseen = train(rare, tmp_path / "b", problem=SLIDE)
    assert seen.figures["weights"] == unseen.figures["weights"]
    assert shown[-1].steps == 960
    assert shown[-1].best is not None


def test_a_damaged_checkpoint_is_told_and_the_one_before_it_used(tmp_path):
    settings = slide_settings()
    whole = train(settings, tmp_path / "whole", problem=SLIDE)
    with pytest.raises(KilledError):
        train(settings, tmp_path / "run", problem=breaking_after(150))
    file = tmp_path / "run" / CHECKPOINT
    file.write_bytes(file.read_bytes()[:-100])
    with pytest.warns(UserWarning, match="damaged or cut short"):
        again = train(settings, tmp_path / "run", resume=True, problem=SLIDE)
    assert again.figures["weights"] == whole.figures["weights"]


def test_without_any_sound_checkpoint_there_is_one_clear_error_and_nothing_is_lost(tmp_path):
    with pytest.raises(KilledError):
        train(slide_settings(), tmp_path, problem=breaking_after(150))
    for file in (tmp_path / CHECKPOINT, checkpoint.previous(tmp_path / CHECKPOINT)):
        file.write_bytes(b"robobt-checkpoint-2\nnonsense")
    log = (tmp_path / "log.jsonl").read_text()
    with pytest.raises(checkpoint.CheckpointError, match=f"{CHECKPOINT}: damaged or cut short"):
        train(slide_settings(), tmp_path, resume=True, problem=SLIDE)
    assert (tmp_path / "log.jsonl").read_text() == log


def test_a_folder_with_a_run_is_not_overwritten(tmp_path):
    train(slide_settings(steps=480), tmp_path, problem=SLIDE)
    with pytest.raises(RunFolderError, match="holds a run already"):
        train(slide_settings(steps=480), tmp_path, problem=SLIDE)
    with pytest.raises(RunFolderError, match=r"other settings \(agent.tau\)"):
        train(slide_settings(steps=480, agent__tau=0.5), tmp_path, resume=True, problem=SLIDE)


def test_a_folder_with_something_else_is_not_written_to(tmp_path):
    (tmp_path / "thesis.tex").write_text("precious")
    with pytest.raises(RunFolderError, match="holds other files"):
        train(slide_settings(), tmp_path, problem=SLIDE)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_a_run_that_was_stopped_before_its_first_checkpoint_is_simply_started_again(tmp_path):
    with pytest.raises(KilledError):
        train(slide_settings(), tmp_path, problem=breaking_after(10))
    (tmp_path / "log.jsonl").write_text("{}\n")
    earlier = tmp_path / "past" / "0000000007.pt"
    earlier.parent.mkdir()
    earlier.touch()
    result = train(slide_settings(steps=480), tmp_path, problem=SLIDE)
    assert len(load_run(tmp_path).validations) == len(result.validations)
    assert not earlier.exists()


def test_a_run_with_a_checkpoint_is_resumable_even_before_its_first_evaluation(tmp_path):
    settings = slide_settings(evaluation__every=1920)
    with pytest.raises(KilledError):
        train(settings, tmp_path, problem=breaking_after(150))
    assert (tmp_path / CHECKPOINT).exists()
    with pytest.raises(RunFolderError, match="holds a run already; resume it"):
        train(settings, tmp_path, problem=SLIDE)


@pytest.mark.slow
def test_killed_anywhere_in_writing_a_checkpoint_it_ends_with_the_same_weights(tmp_path, monkeypatch):
    settings = slide_settings(**EVERYTHING)
    whole = train(settings, tmp_path / "whole", problem=SLIDE)

    def killed(*_: object) -> None:
        raise KilledError

    for i, (place, name) in enumerate(
        (
            ("os", "fsync"),
            ("pathlib.Path", "replace"),
            ("robobt.learning.training.checkpoint", "write_atomically"),
        )
    ):
        folder = tmp_path / str(i)
        with pytest.raises(KilledError):
            train(settings, folder, problem=breaking_after(110))
        with monkeypatch.context() as patched:
            patched.setattr(f"{place}.{name}", killed)
            # What a killed process would have left lying there.
            patched.setattr("pathlib.Path.unlink", lambda *_, **__: None)
            with pytest.raises(KilledError):
                train(settings, folder, resume=True, problem=SLIDE)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            again = train(settings, folder, resume=True, problem=SLIDE)
        assert again.figures["weights"] == whole.figures["weights"], name
        assert not list(folder.glob("*checkpoint*")), name
        assert not list(folder.glob(".checkpoint*")), name


def test_a_run_that_has_ended_is_read_not_repeated(tmp_path):
    first = train(slide_settings(steps=480), tmp_path, problem=SLIDE)
    again = train(slide_settings(steps=480), tmp_path, resume=True, problem=breaking_after(0))
    assert again.figures == first.figures
    assert again.validations == first.validations


def test_what_a_run_leaves_behind(tmp_path, curves):
    result = train(slide_settings(steps=480, tensorboard=True), tmp_path, problem=SLIDE)
    there = {path.name for path in tmp_path.iterdir()}
    assert there == {"settings.yaml", "log.jsonl", "actor.pt", "result.json", "curves.png", "tensorboard"}
    assert (tmp_path / "curves.png").read_bytes().startswith(b"\x89PNG")
    assert list((tmp_path / "tensorboard").glob("events*"))
    actor = load_actor(tmp_path / "actor.pt")
    seen = torch.randn(50, 2, generator=torch.Generator().manual_seed(0))
    assert torch.equal(actor(seen), result.actor(seen))
    assert float(result.actor(seen * 100).abs().max()) <= 1.0


def test_training_leaves_torchs_threads_as_they_were(tmp_path):
    before = torch.get_num_threads()
    try:
        torch.set_num_threads(2)
        train(slide_settings(steps=480), tmp_path, problem=SLIDE)
        assert torch.get_num_threads() == 2
    finally:
        torch.set_num_threads(before)


def test_the_best_actor_is_chosen_by_success_and_time_and_never_by_the_return(tmp_path):
    """The later an evaluation, the larger its return and the worse its success."""
    rates = iter([0.5, 0.9, 0.9, 0.2])
    times = iter([1.0, 3.0, 2.0, 0.5])

    def evaluate(policy, split, starts):
        figures = SLIDE.evaluate(policy, split, starts)
        if split == "held_out":
            return figures
        success = np.arange(starts) < round(next(rates) * starts)
        taken = np.where(success, next(times), np.nan)
        return replace(figures, success=success, times=taken, returns=figures.returns + taken[0])

    result = train(slide_settings(), tmp_path, problem=replace(SLIDE, evaluate=evaluate))
    assert result.figures["best_steps"] == 1440


def test_training_stops_once_the_bar_is_met(tmp_path):
    early = slide_settings(
        collection__gradient_steps=4, evaluation__stop_success=0.9, evaluation__stop_time=9.0
    )
    result = train(early, tmp_path, problem=SLIDE)
    assert result.figures["stopped_early"]
    assert result.figures["steps"] < 1920
    assert [validation.success >= 0.9 for validation in result.validations][-2:] == [False, True]


def test_weights_that_are_not_finite_end_the_run_with_an_error(tmp_path):
    class Endless(Slide):
        def step(self, actions):
            step = super().step(actions)
            step.reward[:] = np.nan
            return step

    with pytest.raises(TrainError, match="not finite after"):
        train(slide_settings(), tmp_path, problem=replace(SLIDE, make=Endless))


def test_no_training_episode_has_the_seed_of_a_fixed_start():
    seeds = {training_seed(seed, steps) for seed in range(20) for steps in range(0, 200_000, 20_000)}
    assert len(seeds) == 200
    assert not seeds & {split_seed("validation"), split_seed("held_out")}
    assert split_seed("validation") != split_seed("held_out")


def test_what_the_folder_of_no_run_says(tmp_path):
    with pytest.raises(RunFolderError, match="not the folder of a run"):
        load_run(tmp_path)
    (tmp_path / "actor.pt").write_bytes(b"PK nonsense")
    with pytest.raises(RunFolderError, match=r"actor.pt: not an actor"):
        load_actor(tmp_path / "actor.pt")


@pytest.mark.parametrize("task", ["go_to_ball", "shoot"])
def test_a_short_run_of_a_real_task(tmp_path, task):
    changes = {
        "steps": 1280,
        "agent.hidden_sizes": [16],
        # The first steps are in the replay at once, so that updates begin when they may.
        "agent.n_step": 1,
        "replay.batch_size": 32,
        "collection.random_steps": 640,
        "collection.learning_starts": 128,
        "evaluation.every": 640,
        "evaluation.starts": 10,
        "evaluation.held_out": 10,
        "rebuild_every": 640,
    }
    result = train(load_settings(task, changes=changes), tmp_path)
    assert result.settings.environment.period == 0.03
    assert result.figures["updates"] == 2 * (1280 - 128) // 64
    assert 0 <= result.figures["held_out"]["successes"] <= 10
    again = load_run(tmp_path)
    assert again.figures == result.figures
    assert again.settings == result.settings
    assert again.validations == result.validations
    events = EventAccumulator(str(tmp_path / "tensorboard")).Reload()
    for each in again.validations:
        assert set(each.terms) == set(TASKS[task].terms.names)
        assert sum(each.terms.values()) == pytest.approx(each.mean_return)
    for name, value in again.validations[-1].terms.items():
        assert events.Scalars(f"reward/{name}")[-1].value == pytest.approx(value)


@pytest.mark.slow
@pytest.mark.parametrize(("task", "steps"), [("go_to_ball", 76_800), ("shoot", 345_600)])
def test_nine_of_ten_succeed_after_a_short_training(tmp_path, task, steps):
    result = train(load_settings(task, changes={"steps": steps, "tensorboard": False}), tmp_path)
    assert result.figures["held_out"]["success"] >= 0.9


REAL = """
import sys
from robobt.learning.training.settings import evaluated_on, load_settings
from robobt.learning.training.train import train
changes = {"steps": 38400, "collection.random_steps": 2560, "evaluation.every": 9600, "evaluation.starts": 20,
           "evaluation.held_out": 20, "rebuild_every": 640, "checkpoint_seconds": 0.0, "tensorboard": False}
print(train(load_settings("go_to_ball", changes=changes), sys.argv[1], resume=True).figures["weights"])
"""


@pytest.mark.slow
def test_a_real_run_killed_at_ten_random_moments_ends_with_the_same_weights(tmp_path, start_python):
    def start(folder):
        return start_python("-c", REAL, folder)

    whole, _ = start(tmp_path / "whole").communicate()
    rng = np.random.default_rng(0)
    kills = 0
    while kills < 10:
        process = start(tmp_path / "broken")
        # What the process does in this time is what the machine allows: a random moment of the run.
        newest, before = tmp_path / "broken" / CHECKPOINT, _changed(tmp_path / "broken" / CHECKPOINT)
        while process.poll() is None and _changed(newest) == before:
            time.sleep(0.01)
        time.sleep(rng.uniform(0.0, 0.15))
        if process.poll() is not None:
            break
        process.send_signal(signal.SIGKILL)
        process.communicate()
        kills += 1
    assert kills == 10
    broken, _ = start(tmp_path / "broken").communicate()
    assert broken == whole
    assert len(whole.strip()) == 32


def _changed(path):
    return path.stat().st_mtime_ns if path.exists() else None


def test_two_runs_in_one_folder_at_a_time_are_one_too_many(tmp_path):
    refusals = []

    class Meanwhile(Slide):
        def step(self, actions):
            if not refusals:
                with pytest.raises(RunFolderError) as caught:
                    train(slide_settings(), tmp_path, resume=True, problem=SLIDE)
                refusals.append(str(caught.value))
            return super().step(actions)

    result = train(slide_settings(), tmp_path, problem=replace(SLIDE, make=Meanwhile))
    alone = train(slide_settings(), tmp_path / "alone", problem=SLIDE)
    said = f"{tmp_path}: another run is being trained there; wait for it, or give another folder"
    assert refusals == [said]
    assert result.figures["weights"] == alone.figures["weights"]
    assert load_run(tmp_path).validations == result.validations


def test_a_run_that_was_killed_keeps_nobody_out(tmp_path):
    with pytest.raises(KilledError):
        train(slide_settings(), tmp_path, problem=breaking_after(100))
    train(slide_settings(), tmp_path, resume=True, problem=SLIDE)
