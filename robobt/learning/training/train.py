"""Train an agent with the learner that the settings name."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

from robobt.learning.agents.networks import one_thread
from robobt.learning.training.clock import RunClock
from robobt.learning.training.off_policy import OffPolicyRun
from robobt.learning.training.on_policy import OnPolicyRun
from robobt.learning.training.problems import Problem, problem_for
from robobt.learning.training.progress import OnProgress
from robobt.learning.training.results import TrainResult
from robobt.learning.training.run import TrainError as TrainError
from robobt.learning.training.run import TrainingRun
from robobt.learning.training.run_folder import RunFolder, alone_in
from robobt.learning.training.settings import TrainSettings

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
