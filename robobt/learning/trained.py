"""Training with one call: a task by its name, and a run that can be exported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path

from robobt.learning.training.export_run import export_run
from robobt.learning.training.progress import OnProgress
from robobt.learning.training.results import TrainResult
from robobt.learning.training.settings import load_settings
from robobt.learning.training.train import train as train_with


@dataclass(frozen=True, slots=True)
class TrainedRun(TrainResult):
    """A finished run, as :func:`train` returns it; its attributes are those of every result of training."""

    def export(
        self, name: str = "", out: str | Path = "models", *, onnx: bool = False, force: bool = False
    ) -> Path:
        """Write the best policy as a model that skills load, and return its TorchScript file.

        From the folder ``models`` of the working folder it is found by its name alone, as in
        ``scenario.with_robot("blue 0", policy=NAME)``.

        Args:
            name: of the model, and of its file without the suffix; by default the task's with the learner's.
            out: folder to write it to.
            onnx: whether an ONNX file is written beside it.
            force: whether a model that is there already is replaced.

        Raises:
            RunFolderError: the run's folder is gone, or the file of its task has been edited since.
            ModelError: the policy cannot be written as it is, or under that name.
            OSError: a file cannot be written.
        """
        return export_run(
            self.folder, name, out, ("torchscript", "onnx") if onnx else ("torchscript",), force=force
        )[0]


def train(
    task: str,
    preset: str = "fast",
    *,
    steps: int | None = None,
    seed: int | None = None,
    out: str | Path | None = None,
    changes: Mapping[str, object] | None = None,
    resume: bool = False,
    on_progress: OnProgress | None = None,
) -> TrainedRun:
    """Train a skill, and judge it on starts that training and choosing never saw.

    Args:
        task: what to learn: "go_to_ball", "shoot", another name in :data:`robobt.learning.TASKS`, or a task
            of one's own as "my_task.py:MyTask".
        preset: settings to start from: a preset's name or a YAML file.
        steps: environment steps; the preset's by default.
        seed: of all random numbers of the run; the preset's by default.
        out: the run's folder; by default ``runs/TASK-PRESET``.
        changes: other settings by dotted name, such as ``{"agent.n_step": 5}``.
        resume: whether to go on with a run that was cut off in that folder.
        on_progress: called after each evaluation with how far the run is.

    Returns:
        The run: its figures (held-out successes, times, steps), its folder, and its policy to export.

    Raises:
        SettingsError: there is no such task or preset, or a setting is wrong.
        RunFolderError: the folder holds a run already, or another one, or cannot be resumed, or another
            process trains in it.
        TrainError: the weights became NaN.
        OSError: a file cannot be written.
    """
    given = {name: value for name, value in (("steps", steps), ("seed", seed)) if value is not None}
    settings = load_settings(task, preset, {**(changes or {}), **given})
    folder = Path("runs") / f"{task.rpartition(':')[2]}-{Path(preset).stem}" if out is None else out
    result = train_with(settings, folder, resume=resume, on_progress=on_progress)
    return TrainedRun(*(getattr(result, one.name) for one in fields(result)))
