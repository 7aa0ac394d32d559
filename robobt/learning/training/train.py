"""The training loop: collect, learn, evaluate, and be able to go on after being killed."""

from __future__ import annotations

import time
import warnings
from pathlib import Path

import numpy as np

from robobt import __version__
from robobt.config.errors import RobobtError
from robobt.learning.agents.ddpg import DDPG
from robobt.learning.agents.networks import one_thread, policy_of
from robobt.learning.agents.nstep import NStep
from robobt.learning.agents.replay import PrioritisedReplay, Replay
from robobt.learning.training.checkpoint import Arrays, RunState, digest_of
from robobt.learning.training.clock import RunClock
from robobt.learning.training.demonstrations import demonstrations_for
from robobt.learning.training.problems import Problem, problem_of, training_seed
from robobt.learning.training.progress import OnProgress, Reporter
from robobt.learning.training.results import Figures, TrainResult, Validation, held_out_figures
from robobt.learning.training.run_folder import RunFolder, alone_in
from robobt.learning.training.selection import Selection
from robobt.learning.training.settings import TrainSettings, environment_of


class TrainError(RobobtError, RuntimeError):
    """A run cannot go on; the message is one line."""


def train(
    settings: TrainSettings,
    out: str | Path,
    *,
    resume: bool = False,
    on_progress: OnProgress | None = None,
    problem: Problem | None = None,
) -> TrainResult:
    """Train an agent, from scratch or from where a run was interrupted.

    What the run writes to its folder is described in :mod:`robobt.learning.training.run_folder`.
    The result follows from the settings alone: a run that was killed and resumed ends
    with the same weights as one that was not, bit for bit, because both build the
    simulator anew every ``rebuild_every`` steps, and checkpoints are written only there.

    Args:
        settings: of the run.
        out: its folder.
        resume: go on with the run in the folder; without one there, start it.
        on_progress: called now and then.
        problem: the task to learn in place of the one the settings name.

    Raises:
        RunFolderError: the folder holds a run already, or another one, or cannot be resumed, or
            another process trains in it.
        TrainError: the weights became NaN.
        OSError: a file cannot be written.
    """
    clock = RunClock()
    if problem is None:
        problem = problem_of(environment_of(settings))
    with alone_in(Path(out)):
        folder = RunFolder(Path(out), settings, resume)
        if folder.result is not None:
            return folder.result
        if folder.warning is not None:
            warnings.warn(f"{folder.warning}; going on from the checkpoint before it", stacklevel=2)
        with folder, one_thread():
            return _Run(settings, problem, folder, clock, on_progress).to_end()


class _Run:
    def __init__(
        self,
        settings: TrainSettings,
        problem: Problem,
        folder: RunFolder,
        clock: RunClock,
        on_progress: OnProgress | None,
    ) -> None:
        self._settings = settings
        self._problem = problem
        self._folder = folder
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
        self._selection = Selection(settings.evaluation)
        self._reporter = Reporter(settings, on_progress, clock, self._selection)
        self._saved_at = time.monotonic()

    def to_end(self) -> TrainResult:
        stored = self._folder.stored
        if stored is None:
            self._burn_in()
        else:
            self._restore(*stored)
        self._rebuild()
        self._reporter.begin(self._steps)
        while self._steps < self._settings.steps and not self._selection.is_good_enough():
            self._step()
            if self._steps % self._settings.evaluation.every == 0:
                self._evaluate()
            if self._steps % self._settings.rebuild_every == 0:
                self._flush()
                self._rebuild()
                self._save()
            self._reporter.report(self._steps)
        latest = self._selection.latest
        if latest is None or latest.steps != self._steps:
            self._evaluate()
        return self._finish()

    def _step(self) -> None:
        """Step every environment once, and make the updates that are due."""
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
        batch = self._replay.sample(self._settings.replay.batch, self._rng)
        errors, gradients = self._agent.update(batch, self._rng)
        if isinstance(self._replay, PrioritisedReplay):
            weight = self._settings.replay.priority.dqda_weight
            self._replay.update_priorities(batch.rows, (errors + weight * gradients).double().numpy())

    def _burn_in(self) -> None:
        """Fill the replay with demonstrations, and learn from them before the first step."""
        settings = self._settings.replay.demonstrations
        if not settings.episodes:
            return
        environment = environment_of(self._settings)
        shown = demonstrations_for(environment, settings.episodes, settings.file, self._settings.seed)
        for transitions in shown.transitions(self._horizons, self._settings.agent.gamma):
            self._replay.add(*transitions)
        if settings.keep:
            self._replay.keep()
        for _ in range(settings.updates):
            self._learn()

    def _rebuild(self) -> None:
        """Build the simulator anew: which bodies are in contact is in no checkpoint."""
        self._observation = self._task.reset(training_seed(self._settings.seed, self._steps))
        sizes = self._task.observation_size, self._task.action_size
        self._returns = NStep(self._horizons, self._settings.agent.gamma, self._task.n, *sizes)

    def _flush(self) -> None:
        for transitions in self._returns.flush(self._observation):
            self._replay.add(*transitions)

    def _evaluate(self) -> None:
        """Evaluate the actor on the validation starts, log it, and keep it if it is the best yet."""
        actor = self._agent.target_actor if self._settings.evaluation.target_actor else self._agent.actor
        with self._clock.evaluating():
            figures = self._problem.evaluate(policy_of(actor), "validation", self._settings.evaluation.starts)
        latest = self._selection.latest
        updates = self._agent.updates - (latest.updates if latest else 0)
        validation = Validation(
            steps=self._steps,
            updates=self._agent.updates,
            success=figures.rate,
            mean_time=figures.mean_time,
            time_ratio=figures.time_ratio,
            mean_return=float(figures.returns.mean()),
            cpu_s=round(self._clock.cpu_s, 3),
            evaluation_cpu_s=round(self._clock.evaluation_s, 3),
            wall_s=round(self._clock.wall_s, 3),
            critic_loss=float(self._agent.critic_loss) / updates if updates else None,
            value=float(self._agent.value) / updates if updates else None,
        )
        self._agent.reset_sums()
        if validation.critic_loss is not None and not np.isfinite(validation.critic_loss):
            raise TrainError(
                f"{self._folder.path}: the critic's loss is not finite after {self._steps} steps"
            )
        self._selection.add(validation, actor)
        self._folder.log(validation)
        self._reporter.report(self._steps, now=True)

    def _finish(self) -> TrainResult:
        best = self._selection.best
        assert best is not None
        settings = self._settings
        actor = self._selection.actor(self._agent.actor.build)
        with self._clock.evaluating():
            held_out = self._problem.evaluate(policy_of(actor), "held_out", settings.evaluation.held_out)
        figures: Figures = {
            "task": settings.task,
            "preset": settings.preset,
            "seed": settings.seed,
            "robobt": __version__,
            "stopped_early": self._steps < settings.steps,
            "steps": self._steps,
            "updates": self._agent.updates,
            "best_steps": best.steps,
            "cpu_s": round(self._clock.cpu_s, 3),
            "evaluation_cpu_s": round(self._clock.evaluation_s, 3),
            "wall_s": round(self._clock.wall_s, 3),
            "held_out": held_out_figures(held_out),
            "weights": digest_of(self._agent.state()),
        }
        result = TrainResult(settings, self._folder.path, actor, self._selection.validations, figures)
        self._folder.finish(result)
        return result

    def _save(self) -> None:
        """Write a checkpoint, unless the last one is recent."""
        if time.monotonic() - self._saved_at < self._settings.checkpoint_seconds:
            return
        arrays: Arrays = {f"agent/{key}": array for key, array in self._agent.state().items()}
        arrays |= {f"replay/{key}": array for key, array in self._replay.state().items()}
        arrays |= {f"best/{key}": array for key, array in self._selection.weights.items()}
        self._folder.save(
            arrays,
            {
                "steps": self._steps,
                "rng": self._rng.bit_generator.state,
                "validations": self._selection.state(),
                "clock": self._clock.state(),
                "robobt": __version__,
            },
        )
        self._saved_at = time.monotonic()

    def _restore(self, arrays: Arrays, state: RunState) -> None:
        def part(name: str) -> Arrays:
            return {key.removeprefix(name): value for key, value in arrays.items() if key.startswith(name)}

        self._agent.restore(part("agent/"))
        self._replay.restore(part("replay/"))
        self._selection.restore(state["validations"], part("best/"))
        self._steps = state["steps"]
        self._rng.bit_generator.state = state["rng"]
        self._clock.restore(state["clock"])

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
