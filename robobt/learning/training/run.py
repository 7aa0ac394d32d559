"""The base of training runs: evaluation, selection of the best actor, checkpoints and resuming."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np

from robobt import __version__
from robobt.config.commit import source_commit
from robobt.config.errors import RobobtError
from robobt.learning.agents.learner import Diagnostics
from robobt.learning.agents.networks import Actor, policy_of
from robobt.learning.training.checkpoint import Arrays, RunState, digest_of
from robobt.learning.training.problems import Problem, training_seed
from robobt.learning.training.progress import OnProgress, Reporter, RunClock
from robobt.learning.training.results import Figures, TrainResult, Validation, held_out_figures
from robobt.learning.training.run_folder import RunFolder
from robobt.learning.training.selection import Selection
from robobt.learning.training.settings import TrainSettings


class TrainError(RobobtError, RuntimeError):
    """A run that cannot continue; the message is one line."""


class Agent(Protocol):
    """The learner of a run."""

    actor: Actor
    updates: int
    diagnostics: Diagnostics

    def state(self) -> Arrays:
        """Return its whole state, as arrays by name."""

    def restore(self, state: Arrays) -> None:
        """Restore the :meth:`state` of another agent."""


class TrainingRun(ABC):
    """A training run; subclasses collect experience and learn from it."""

    _agent: Agent

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
        self._task = problem.make(settings.collection.num_envs)
        seeds = np.random.SeedSequence(settings.seed).spawn(2)
        self._rng = np.random.default_rng(seeds[0])
        self._agent_seed = int(seeds[1].generate_state(1)[0])
        self._observation = np.zeros((self._task.n, self._task.observation_size))
        self._steps = 0
        self._commit = source_commit()
        self._selection = Selection(settings.evaluation)
        self._reporter = Reporter(settings, on_progress, clock, self._selection)
        self._saved_at = time.monotonic()
        self._paced_from = 0, 0.0
        self._set_up()

    @abstractmethod
    def _set_up(self) -> None:
        """Make the agent, and what else the run needs."""

    @abstractmethod
    def _advance(self) -> None:
        """Collect experience, count its steps, and learn from it."""

    def _begin(self) -> None:  # noqa: B027 - most learners need nothing here
        """Prepare a new run before its first step."""

    def _settle(self) -> None:  # noqa: B027
        """Finish what depends on the simulator before it is rebuilt."""

    def _kept(self) -> Arrays:
        """Return what a resumed run needs besides its agent and evaluations, as arrays by name."""
        return {}

    @property
    def _share(self) -> float:
        """Share of the run's steps that is over, by which schedules go."""
        return self._steps / self._settings.steps

    @property
    def _evaluated(self) -> Actor:
        """The actor that is evaluated and selected."""
        return self._agent.actor

    def to_end(self) -> TrainResult:
        """Train until the last step or until it is good enough, and write the results."""
        stored = self._folder.stored
        if stored is None:
            self._begin()
        else:
            self._restore(*stored)
        self._rebuild()
        self._reporter.begin(self._steps)
        self._paced_from = self._steps, self._clock.learning_here_s
        while self._steps < self._settings.steps and not self._selection.is_good_enough():
            before = self._steps
            self._advance()
            if _passed(self._settings.evaluation.every, before, self._steps):
                self._evaluate()
            if _passed(self._settings.rebuild_every, before, self._steps):
                self._settle()
                self._rebuild()
                self._save()
            self._reporter.report(self._steps)
        latest = self._selection.latest
        if latest is None or latest.steps != self._steps:
            self._evaluate()
        return self._finish()

    def _rebuild(self) -> None:
        """Rebuild the simulator, since checkpoints do not have its contacts."""
        self._observation = self._task.reset(training_seed(self._settings.seed, self._steps))

    def _evaluate(self) -> None:
        """Evaluate the actor on the validation starts, log it, and keep it if it is the best yet."""
        actor = self._evaluated
        with self._clock.evaluating():
            figures = self._problem.evaluate(policy_of(actor), "validation", self._settings.evaluation.starts)
        losses = self._agent.diagnostics.means()
        self._agent.diagnostics.clear()
        steps, seconds = self._paced_from
        self._paced_from = self._steps, self._clock.learning_here_s
        pace = (self._steps - steps) / max(self._paced_from[1] - seconds, 1e-9)
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
            steps_per_second=round(pace, 1),
            losses={name: value if np.isfinite(value) else None for name, value in losses.items()},
            terms=dict(figures.terms),
        )
        for name, value in validation.losses.items():
            if value is None and name.endswith("_loss"):
                raise TrainError(f"{self._folder.path}: {name} is not finite after {self._steps} steps")
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
            "commit": self._commit,
            "task_digest": self._folder.task_digest,
            "stopped_early": self._steps < settings.steps,
            "steps": self._steps,
            "updates": self._agent.updates,
            "best_steps": best.steps,
            "cpu_s": round(self._clock.cpu_s, 3),
            "evaluation_cpu_s": round(self._clock.evaluation_s, 3),
            "wall_s": round(self._clock.wall_s, 3),
            "held_out": held_out_figures(held_out),
            # Two sums are part of the hash since the first version, in which a state had them.
            "weights": digest_of({**self._agent.state(), "sums": np.zeros(2)}),
        }
        result = TrainResult(settings, self._folder.path, actor, self._selection.validations, figures)
        self._folder.finish(result)
        return result

    def _save(self) -> None:
        """Write a checkpoint, unless the last one is recent."""
        if time.monotonic() - self._saved_at < self._settings.checkpoint_seconds:
            return
        arrays: Arrays = {f"agent/{key}": array for key, array in self._agent.state().items()}
        arrays |= {f"diagnostics/{key}": array for key, array in self._agent.diagnostics.state().items()}
        arrays |= self._kept()
        arrays |= {f"best/{key}": array for key, array in self._selection.weights.items()}
        self._folder.save(
            arrays,
            {
                "steps": self._steps,
                "rng": self._rng.bit_generator.state,
                "validations": self._selection.state(),
                "clock": self._clock.state(),
                "robobt": __version__,
                "task_digest": self._folder.task_digest,
            },
        )
        self._saved_at = time.monotonic()

    def _restore(self, arrays: Arrays, state: RunState) -> None:
        self._agent.restore(part(arrays, "agent/"))
        self._agent.diagnostics.restore(part(arrays, "diagnostics/"))
        self._selection.restore(state["validations"], part(arrays, "best/"))
        self._steps = state["steps"]
        self._rng.bit_generator.state = state["rng"]
        self._clock.restore(state["clock"])


def part(arrays: Arrays, name: str) -> Arrays:
    """Return the arrays whose names begin with ``name``, by the rest of theirs."""
    return {key.removeprefix(name): value for key, value in arrays.items() if key.startswith(name)}


def _passed(every: int, before: int, now: int) -> bool:
    return now // every > before // every
