"""Train agents with the learner that the settings name, with one seed or several side by side."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from robobt.config.atomic import write_atomically
from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import Work
from robobt.learning.agents.networks import one_thread
from robobt.learning.training.curves import draw_curves
from robobt.learning.training.off_policy import OffPolicyRun
from robobt.learning.training.on_policy import OnPolicyRun
from robobt.learning.training.problems import Problem, problem_for
from robobt.learning.training.progress import OnProgress, RunClock
from robobt.learning.training.results import TrainResult, summary_of, title_of
from robobt.learning.training.run import TrainError as TrainError
from robobt.learning.training.run import TrainingRun
from robobt.learning.training.run_folder import CURVES, RESULT, RunFolder, alone_in, load_run
from robobt.learning.training.settings import TrainSettings
from robobt.plays.private_files import sender

RUNS: dict[str, type[TrainingRun]] = {"ddpg": OffPolicyRun, "ppo": OnPolicyRun}
"""How each learner collects and learns."""


def train(
    settings: TrainSettings,
    out: str | Path,
    *,
    resume: bool = False,
    on_progress: OnProgress | None = None,
    problem: Problem | None = None,
) -> TrainResult:
    """Train an agent, from scratch or from where a run was interrupted.

    The files of a run are described in :mod:`robobt.learning.training.run_folder`.
    The result follows from the settings alone: a run that was killed and resumed ends
    with the same weights as one that was not, bit for bit, because both rebuild the
    simulator every ``rebuild_every`` steps, and checkpoints are written only then.

    Args:
        settings: of the run.
        out: its folder.
        resume: continue the run in the folder; start one if there is none.
        on_progress: called now and then.
        problem: the task to learn in place of the one the settings name.

    Raises:
        RunFolderError: the folder holds a run already, or another one, or cannot be resumed, or
            another process trains in it.
        TrainError: the weights became NaN.
        OSError: a file cannot be written.
    """
    # A policy that the run loads, an opponent's for example, would set MKL to the order of additions that
    # all processors can, which takes twice as long for a batch.
    os.environ.setdefault("MKL_CBWR", "AUTO")
    clock = RunClock()
    if problem is None:
        problem = problem_for(settings)
    with alone_in(Path(out)):
        folder = RunFolder(Path(out), settings, resume)
        if folder.result is not None:
            return folder.result
        if folder.warning is not None:
            warnings.warn(f"{folder.warning}; going on from the checkpoint before it", stacklevel=2)
        with folder, one_thread():
            return RUNS[settings.learner](settings, problem, folder, clock, on_progress).to_end()


def train_seeds(
    settings: TrainSettings,
    seeds: Sequence[int],
    out: str | Path,
    workers: int = 1,
    resume: bool = False,
    on_progress: OnProgress | None = None,
    problem: Callable[[TrainSettings], Problem] | None = None,
) -> list[TrainResult]:
    """Train with every seed, each in a folder ``seed_N`` of its own.

    A seed's result does not depend on the others. ``result.json`` and
    ``curves.png`` of all seeds together are written to ``out`` at the end.

    Args:
        settings: of all runs; the seed is replaced.
        seeds: at least one.
        out: the folder.
        workers: processes, of one thread each; 1 is this process itself.
        resume: continue interrupted runs, and keep finished ones.
        on_progress: called now and then, in this process.
        problem: makes a run's problem from its settings instead of the usual one; with one worker.

    Raises:
        TrainError: a run failed; the message is its own.
        RunFolderError: a folder holds a run already, or another one.
        ValueError: no seeds, or no workers.
    """
    if not seeds or workers < 1:
        raise ValueError(f"needs seeds and workers, not {len(seeds)} and {workers}")
    out = Path(out)
    training = _Training(settings, out, resume, problem)
    work = Work(training, "seed", TrainError, passed=(RobobtError, OSError))
    count = min(workers, len(seeds))
    for _ in run_tasks(work, seeds, count, setup=sender(), on_report=on_progress):
        pass
    results = [load_run(training.folder(seed)) for seed in seeds]
    write_atomically(out / RESULT, json.dumps(summary_of(results), indent=2, allow_nan=False) + "\n")
    draw_curves({f"seed {r.settings.seed}": r.validations for r in results}, title_of(settings), out / CURVES)
    return results


@dataclass(frozen=True)
class _Training:
    """Training with one seed, as a task for a worker."""

    settings: TrainSettings
    out: Path
    resume: bool
    problem: Callable[[TrainSettings], Problem] | None

    def folder(self, seed: int) -> Path:
        return self.out / f"seed_{seed}"

    def __call__(self, seed: int, on_progress: OnProgress) -> None:
        settings = self.settings.model_copy(update={"seed": seed})
        train(
            settings,
            self.folder(seed),
            resume=self.resume,
            on_progress=on_progress,
            problem=None if self.problem is None else self.problem(settings),
        )
