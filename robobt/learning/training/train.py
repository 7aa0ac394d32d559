"""The training loop: collect, learn, judge, and be able to go on after being killed."""

from __future__ import annotations

import hashlib
import time
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from robobt import __version__
from robobt.config.errors import RobobtError
from robobt.learning.agents.ddpg import DDPG
from robobt.learning.agents.networks import Actor, policy_of
from robobt.learning.agents.nstep import NStep
from robobt.learning.agents.replay import PrioritisedReplay, Replay
from robobt.learning.training.checkpoint import Arrays
from robobt.learning.training.clock import RunClock
from robobt.learning.training.demonstrations import demonstrations_for
from robobt.learning.training.problems import Problem, problem_of, training_seed
from robobt.learning.training.run_folder import Judged, RunFolder, TrainResult
from robobt.learning.training.settings import EvaluationSettings, TrainSettings, environment_of

_SHOW_EVERY = 0.5
"""Time between reports of progress [s]."""


class TrainError(RobobtError, RuntimeError):
    """A run cannot go on; the message is one line."""


@dataclass(frozen=True, slots=True)
class Progress:
    """Where a run stands.

    Attributes:
        seed: of the run.
        steps, of: environment steps taken, and at most.
        wall_s, cpu_s: spent so far, broken runs' parts included.
        left_s: time to the last step at the present pace; an early stop comes sooner.
        latest, best: evaluations, None before the first.
    """

    seed: int
    steps: int
    of: int
    wall_s: float
    cpu_s: float
    left_s: float
    latest: Judged | None
    best: Judged | None


def train(
    settings: TrainSettings,
    out: str | Path,
    *,
    resume: bool = False,
    on_progress: Callable[[Progress], None] | None = None,
    problem: Problem | None = None,
) -> TrainResult:
    """Train an agent, from scratch or from where a run was cut off.

    What the run writes to its folder is described in :mod:`robobt.learning.training.run_folder`.
    The result follows from the settings alone: a run that was killed and resumed ends
    with the same weights as one that was not, bit for bit, because both build the
    simulator anew every ``rebuild_every`` steps, and checkpoints are written only there.

    PyTorch is set to one thread: on networks this small more are slower on a busy machine.

    Args:
        settings: of the run.
        out: its folder.
        resume: go on with the run in the folder; without one there, start it.
        on_progress: called now and then.
        problem: the task to learn in place of the one the settings name.

    Raises:
        RunFolderError: the folder holds a run already, or another one, or cannot be resumed.
        TrainError: the weights became NaN.
        OSError: a file cannot be written.
    """
    clock = RunClock()
    torch.set_num_threads(1)
    if problem is None:
        problem = problem_of(settings.task, environment_of(settings))
    folder = RunFolder(Path(out), settings, resume)
    if folder.result is not None:
        return folder.result
    if folder.warning is not None:
        warnings.warn(f"{folder.warning}; going on from the checkpoint before it", stacklevel=2)
    with folder:
        return _Run(settings, problem, folder, clock, on_progress).to_end()


class _Run:
    def __init__(
        self,
        settings: TrainSettings,
        problem: Problem,
        folder: RunFolder,
        clock: RunClock,
        on_progress: Callable[[Progress], None] | None,
    ) -> None:
        self._settings = settings
        self._problem = problem
        self._folder = folder
        self._on_progress = on_progress
        self._clock = clock
        collection = settings.collection
        self._task = problem.make(collection.environments)
        scale = problem.scale if settings.agent.scale_observations else (1.0,) * len(problem.scale)
        seeds = np.random.SeedSequence(settings.seed).spawn(2)
        self._rng = np.random.default_rng(seeds[0])
        self._agent = DDPG(settings.agent, scale, problem.smoothed, int(seeds[1].generate_state(1)[0]))
        self._act = policy_of(self._agent.actor)
        self._horizons: tuple[int, ...] = (settings.agent.n_step,)
        if settings.agent.one_step_weight > 0.0 and settings.agent.n_step > 1:
            self._horizons += (1,)
        self._replay = self._make_replay()
        last = collection.noise if collection.last_noise is None else collection.last_noise
        self._noise = np.linspace(collection.noise, last, collection.environments)[:, None]
        self._observation = np.zeros((self._task.n, len(problem.scale)))
        self._returns: NStep
        self._steps = 0
        self._judged: list[Judged] = []
        self._best: Judged | None = None
        self._best_weights: Arrays = {}
        self._saved_at = time.monotonic()
        self._shown_at = 0.0
        self._begun_at = 0

    def to_end(self) -> TrainResult:
        stored = self._folder.stored
        if stored is None:
            self._burn_in()
        else:
            self._restore(*stored)
        self._rebuild()
        self._begun_at = self._steps
        while self._steps < self._settings.steps and not self._is_good_enough():
            self._step()
            if self._steps % self._settings.evaluation.every == 0:
                self._evaluate()
            if self._steps % self._settings.rebuild_every == 0:
                self._flush()
                self._rebuild()
                self._save()
            self._show()
        if not self._judged or self._judged[-1].steps != self._steps:
            self._evaluate()
        return self._finish()

    def _step(self) -> None:
        """One step of every environment, and the updates that fall due with it."""
        collection, n = self._settings.collection, self._task.n
        share = self._steps / self._settings.steps
        if self._steps < collection.random_steps:
            action = self._rng.uniform(-1.0, 1.0, (n, self._task.action_size))
        else:
            noise = self._noise * self._rng.standard_normal((n, self._task.action_size))
            action = np.clip(self._act(self._observation) + noise, -1.0, 1.0)
            if not np.isfinite(action).all():
                raise TrainError(
                    f"{self._folder.path}: the actor's action is not finite after {self._steps} steps"
                )
        step = self._task.step(action)
        done = self._returns.add(
            self._observation, action, step.reward, step.final_observation, step.terminated, step.truncated
        )
        for transitions in done:
            self._replay.add(*transitions)
        self._observation = step.observation
        before = self._steps
        self._steps += n
        rounds = self._steps // collection.update_every - before // collection.update_every
        if self._steps > collection.update_after and rounds and len(self._replay):
            if self._settings.agent.final_rate < 1.0:
                self._agent.set_rates(1.0 - share * (1.0 - self._settings.agent.final_rate))
            for _ in range(rounds * collection.updates):
                self._learn()

    def _learn(self) -> None:
        batch = self._replay.draw(self._settings.replay.batch, self._rng)
        errors, slopes = self._agent.update(batch, self._rng)
        if isinstance(self._replay, PrioritisedReplay):
            weight = self._settings.replay.priority.dqda_weight
            self._replay.learned(batch.rows, (errors + weight * slopes).double().numpy())

    def _burn_in(self) -> None:
        """Fill the replay with demonstrations, and learn from them alone."""
        wanted = self._settings.replay.demonstrations
        if not wanted.episodes:
            return
        environment = environment_of(self._settings)
        shown = demonstrations_for(environment, wanted.episodes, wanted.file, self._settings.seed)
        for transitions in shown.transitions(self._horizons, self._settings.agent.gamma):
            self._replay.add(*transitions)
        if wanted.keep:
            self._replay.keep()
        for _ in range(wanted.updates):
            self._learn()

    def _rebuild(self) -> None:
        """A new simulator: what lies in contact with what survives no checkpoint."""
        self._observation = self._task.reset(training_seed(self._settings.seed, self._steps))
        sizes = self._task.observation_size, self._task.action_size
        self._returns = NStep(self._horizons, self._settings.agent.gamma, self._task.n, *sizes)

    def _flush(self) -> None:
        for transitions in self._returns.flush(self._observation):
            self._replay.add(*transitions)

    def _evaluate(self) -> None:
        """Judge the actor on the validation starts, log it, and keep it if it is the best yet."""
        settings, actor = self._settings.evaluation, self._shipped()
        with self._clock.apart():
            figures = self._problem.judge(policy_of(actor), "validation", settings.starts)
        updates = self._agent.updates - (self._judged[-1].updates if self._judged else 0)
        judged = Judged(
            steps=self._steps,
            updates=self._agent.updates,
            success=figures.rate,
            mean_time=figures.mean_time,
            time_ratio=figures.time_ratio,
            mean_return=float(figures.returns.mean()),
            cpu_s=round(self._clock.cpu_s, 3),
            evaluation_cpu_s=round(self._clock.apart_s, 3),
            wall_s=round(self._clock.wall_s, 3),
            critic_loss=float(self._agent.critic_loss) / updates if updates else None,
            value=float(self._agent.value) / updates if updates else None,
        )
        self._agent.forget_sums()
        if judged.critic_loss is not None and not np.isfinite(judged.critic_loss):
            raise TrainError(
                f"{self._folder.path}: the critic's loss is not finite after {self._steps} steps"
            )
        self._judged.append(judged)
        if self._best is None or judged.score > self._best.score:
            self._best = judged
            self._best_weights = {key: value.numpy().copy() for key, value in actor.state_dict().items()}
        self._folder.log(judged)
        self._show(now=True)

    def _shipped(self) -> Actor:
        return self._agent.target_actor if self._settings.evaluation.target_actor else self._agent.actor

    def _is_good_enough(self) -> bool:
        wanted = self._settings.evaluation
        latest = self._judged[-wanted.stop_after :]
        if wanted.stop_success is None or len(latest) < wanted.stop_after:
            return False
        return all(_meets(judged, wanted) for judged in latest)

    def _finish(self) -> TrainResult:
        assert self._best is not None
        settings = self._settings
        actor = Actor(**self._agent.actor.build)
        actor.load_state_dict({key: torch.from_numpy(value) for key, value in self._best_weights.items()})
        actor.requires_grad_(False)
        with self._clock.apart():
            told = self._problem.judge(policy_of(actor), "held_out", settings.evaluation.held_out)
        figures = {
            "task": settings.task,
            "preset": settings.preset,
            "seed": settings.seed,
            "robobt": __version__,
            "stopped_early": self._steps < settings.steps,
            "steps": self._steps,
            "updates": self._agent.updates,
            "best_steps": self._best.steps,
            "cpu_s": round(self._clock.cpu_s, 3),
            "evaluation_cpu_s": round(self._clock.apart_s, 3),
            "wall_s": round(self._clock.wall_s, 3),
            "held_out": {
                "starts": len(told.success),
                "successes": int(told.success.sum()),
                "success": told.rate,
                "low": told.interval.low,
                "high": told.interval.high,
                "mean_time": told.mean_time,
                "optimum": told.mean_optimum,
                "time_ratio": told.time_ratio,
            },
            "weights": _digest(self._agent.state()),
        }
        result = TrainResult(settings, self._folder.path, actor, self._judged, figures)
        self._folder.finish(result)
        return result

    def _save(self) -> None:
        """Write a checkpoint, unless the last one is young."""
        if time.monotonic() - self._saved_at < self._settings.checkpoint_seconds:
            return
        arrays: Arrays = {f"agent/{key}": array for key, array in self._agent.state().items()}
        arrays |= {f"replay/{key}": array for key, array in self._replay.state().items()}
        arrays |= {f"best/{key}": array for key, array in self._best_weights.items()}
        self._folder.save(
            arrays,
            {
                "steps": self._steps,
                "rng": self._rng.bit_generator.state,
                "judged": [asdict(judged) for judged in self._judged],
                "best": None if self._best is None else asdict(self._best),
                "clock": self._clock.state(),
            },
        )
        self._saved_at = time.monotonic()

    def _restore(self, arrays: Arrays, plain: dict[str, Any]) -> None:
        def part(name: str) -> Arrays:
            return {key.removeprefix(name): value for key, value in arrays.items() if key.startswith(name)}

        self._agent.restore(part("agent/"))
        self._replay.restore(part("replay/"))
        self._best_weights = part("best/")
        self._steps = plain["steps"]
        self._rng.bit_generator.state = plain["rng"]
        self._judged = [Judged(**judged) for judged in plain["judged"]]
        self._best = None if plain["best"] is None else Judged(**plain["best"])
        self._clock.restore(plain["clock"])

    def _make_replay(self) -> Replay:
        settings = self._settings.replay
        sizes = len(self._problem.scale), len(self._problem.smoothed), len(self._horizons)
        if not settings.priority.enabled:
            return Replay(settings.capacity, *sizes)
        return PrioritisedReplay(
            settings.capacity,
            *sizes,
            alpha=settings.priority.alpha,
            beta=settings.priority.beta,
            floor=settings.priority.floor,
            bonus=settings.demonstrations.bonus,
        )

    def _show(self, now: bool = False) -> None:
        if self._on_progress is None or not (now or time.monotonic() - self._shown_at > _SHOW_EVERY):
            return
        self._shown_at = time.monotonic()
        pace = self._clock.here_s / max(1, self._steps - self._begun_at)
        self._on_progress(
            Progress(
                self._settings.seed,
                self._steps,
                self._settings.steps,
                self._clock.wall_s,
                self._clock.cpu_s,
                pace * (self._settings.steps - self._steps),
                self._judged[-1] if self._judged else None,
                self._best,
            )
        )


def _meets(judged: Judged, wanted: EvaluationSettings) -> bool:
    time_ = judged.mean_time if judged.time_ratio is None else judged.time_ratio
    in_time = wanted.stop_time is None or (time_ is not None and time_ <= wanted.stop_time)
    return wanted.stop_success is not None and judged.success >= wanted.stop_success and in_time


def _digest(state: Arrays) -> str:
    digest = hashlib.blake2b(digest_size=16)
    for name in sorted(state):
        digest.update(name.encode())
        digest.update(state[name].tobytes())
    return digest.hexdigest()
