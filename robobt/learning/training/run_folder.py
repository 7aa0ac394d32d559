"""The folder of a training run: writing it and reading it back.

| file | what |
| --- | --- |
| ``settings.yaml`` | every setting of the run |
| ``log.jsonl`` | one line per evaluation: :class:`~robobt.learning.training.results.Validation` |
| ``checkpoint``, ``checkpoint.previous`` | the state for resuming; removed when the run ends |
| ``actor.pt`` | the best actor's weights, and how to build it |
| ``result.json`` | held-out figures: :class:`~robobt.learning.training.results.Figures` |
| ``curves.png`` | success and time over steps |
| ``past/`` | earlier policies by step, where a run plays against its past selves or has stages |
| ``tensorboard/`` | the log's figures as events, by the tags of :func:`scalars_of` |
"""

from __future__ import annotations

import io
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, fields
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

import torch

try:
    import fcntl
except ImportError:  # Windows has none, and no two runs are kept apart there.
    fcntl = None  # type: ignore[assignment]

from robobt import __version__
from robobt.config.atomic import write_atomically
from robobt.config.errors import RobobtError, naming
from robobt.config.yaml import read_yaml, write_yaml
from robobt.learning.agents.networks import Actor
from robobt.learning.envs.make import task_file
from robobt.learning.training import checkpoint
from robobt.learning.training.checkpoint import Arrays, RunState
from robobt.learning.training.curves import draw_curves
from robobt.learning.training.results import Figures, TrainResult, Validation, title_of
from robobt.learning.training.settings import SettingsError, TrainSettings, settings_of

if TYPE_CHECKING:
    from torch.utils.tensorboard import SummaryWriter

SETTINGS, LOG, CHECKPOINT = "settings.yaml", "log.jsonl", "checkpoint"
ACTOR, RESULT, CURVES, EVENTS = "actor.pt", "result.json", "curves.png", "tensorboard"
PAST = "past"

_TAGS = {
    "success": "eval/success_rate",
    "mean_time": "eval/mean_time",
    "time_ratio": "eval/time_ratio",
    "mean_return": "eval/mean_return",
    "steps_per_second": "charts/SPS",
    "updates": "charts/updates",
    "cpu_s": "charts/cpu_s",
    "evaluation_cpu_s": "charts/evaluation_cpu_s",
    "wall_s": "charts/wall_s",
}
"""TensorBoard's tags of the scalar fields of :class:`Validation`."""
_FIGURE_GROUPS = {"losses": "losses", "terms": "reward"}
"""Fields of :class:`Validation` that hold figures by name, and how the tags of those begin."""


class RunFolderError(RobobtError, ValueError):
    """A run's folder that cannot be used; the message is one line that names it."""


@contextmanager
def alone_in(path: Path) -> Iterator[None]:
    """Lock a folder, which is created if need be, against other runs; the lock ends with the process."""
    if fcntl is None or (path.exists() and not path.is_dir()):
        yield
        return
    path.mkdir(parents=True, exist_ok=True)
    handle = os.open(path, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise RunFolderError(
                f"{path}: another run is being trained there; wait for it, or give another folder"
            ) from error
        yield
    finally:
        os.close(handle)


class RunFolder:
    """A run's folder, open for writing. A context manager.

    Args:
        path: the folder; made if it is not there.
        settings: of the run.
        resume: whether to resume a run that is in the folder.

    Attributes:
        result: of a run that is already finished, else None.
        stored: arrays and plain data of the checkpoint to resume from; None to start.
        warning: why an older checkpoint than the newest is used, else None.
        task_digest: a hash of the code of a user's task; empty for a task that ships.

    Raises:
        RunFolderError: it has a run that is not to be resumed, one with other settings, or one of a task
            whose file has been edited since.
        CheckpointError: no checkpoint can be read.
    """

    def __init__(self, path: Path, settings: TrainSettings, resume: bool) -> None:
        self.path = path
        self.settings = settings
        _, self.task_digest = task_file(settings.environment)
        self.result: TrainResult | None = None
        self.stored: tuple[Arrays, RunState] | None = None
        self.warning: str | None = None
        if path.exists() and not path.is_dir():
            raise RunFolderError(f"{path}: is not a folder")
        if (path / SETTINGS).exists() and (resume or self._has_begun()):
            self._take_up(resume)
        elif path.is_dir() and {entry.name for entry in path.iterdir()} - {SETTINGS, LOG, EVENTS, PAST}:
            raise RunFolderError(f"{path}: holds other files; give a new folder")
        else:
            path.mkdir(parents=True, exist_ok=True)
            # Of a run that was stopped before its first checkpoint.
            for earlier in (path / PAST).glob("*.pt"):
                earlier.unlink()
            write_atomically(path / SETTINGS, write_yaml(settings.model_dump(mode="json")))

    def __enter__(self) -> Self:
        kept = self._kept_lines()
        with naming(self.path / LOG):
            self._log = (self.path / LOG).open("w", encoding="utf-8")
            self._log.write("".join(kept))
            self._log.flush()
        self._events: SummaryWriter | None = None
        if self.settings.tensorboard:
            from torch.utils.tensorboard import SummaryWriter

            steps = self.stored[1]["steps"] + 1 if self.stored else 0
            self._events = SummaryWriter(str(self.path / EVENTS), purge_step=steps)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with naming(self.path / LOG):
            self._log.close()
        if self._events is not None:
            self._events.close()

    def log(self, validation: Validation) -> None:
        """Append an evaluation; it is in the file when this returns."""
        with naming(self.path / LOG):
            self._log.write(json.dumps(asdict(validation), allow_nan=False) + "\n")
            self._log.flush()
        if self._events is not None:
            for tag, value in scalars_of(validation).items():
                self._events.add_scalar(tag, value, validation.steps)
            self._events.flush()

    def keep(self, actor: Actor, steps: int) -> None:
        """Write the policy after ``steps`` to the folder of past selves."""
        (self.path / PAST).mkdir(exist_ok=True)
        save_actor(actor, self.path / PAST / f"{steps:010}.pt")

    def save(self, arrays: Arrays, state: RunState) -> None:
        """Write the checkpoint."""
        checkpoint.save(self.path / CHECKPOINT, arrays, state)

    def finish(self, result: TrainResult) -> None:
        """Write actor, curves and figures; the figures last, since they mark the run as finished."""
        save_actor(result.actor, self.path / ACTOR)
        name = f"seed {result.settings.seed}"
        draw_curves({name: result.validations}, title_of(result.settings), self.path / CURVES)
        text = json.dumps(result.figures, indent=2, allow_nan=False) + "\n"
        write_atomically(self.path / RESULT, text)
        for path in (*self._checkpoints(), *self.path.glob(f".*.{CHECKPOINT}")):
            path.unlink(missing_ok=True)

    def _has_begun(self) -> bool:
        """Return whether there is anything to go on from: results or a checkpoint."""
        return any(path.exists() for path in (self.path / RESULT, *self._checkpoints()))

    def _checkpoints(self) -> tuple[Path, Path]:
        return self.path / CHECKPOINT, checkpoint.previous(self.path / CHECKPOINT)

    def _take_up(self, resume: bool) -> None:
        if not resume:
            raise RunFolderError(
                f"{self.path}: holds a run already; resume it (--resume), or give another folder (--out)"
            )
        stored = read_settings(self.path)
        if stored != self.settings:
            field = _first_difference(stored.model_dump(), self.settings.model_dump())
            raise RunFolderError(
                f"{self.path}: holds a run with other settings ({field}); give another folder"
            )
        if (self.path / RESULT).exists():
            self.result = load_run(self.path)
            check_task(self.path, self.settings, self.result.figures.get("task_digest", ""))
            return
        newest = self.path / CHECKPOINT
        if newest.exists() or checkpoint.previous(newest).exists():
            arrays, state, self.warning = checkpoint.load_latest(newest)
            if state["robobt"] != __version__:
                raise RunFolderError(
                    f"{self.path}: was begun by robobt {state['robobt']}, this is {__version__}"
                )
            check_task(self.path, self.settings, state.get("task_digest", ""))
            self.stored = arrays, state

    def _kept_lines(self) -> list[str]:
        """Return the lines of the log up to the checkpoint; a resumed run writes the others again."""
        validations = [] if self.stored is None else self.stored[1]["validations"]
        return [json.dumps(line) + "\n" for line in validations]


def scalars_of(validation: Validation) -> dict[str, float]:
    """Return the figures of an evaluation by the tags that they have in TensorBoard."""
    figures = asdict(validation)
    found: dict[str, float | None] = {tag: figures[name] for name, tag in _TAGS.items()}
    for group, prefix in _FIGURE_GROUPS.items():
        found |= {f"{prefix}/{name}": value for name, value in figures[group].items()}
    return {tag: value for tag, value in found.items() if value is not None}


def check_task(folder: Path, settings: TrainSettings, begun_with: str) -> None:
    """Raise an error if a user's task is not what it was when a run began; by a hash of its code, or none."""
    file, digest = task_file(settings.environment)
    if begun_with and begun_with != digest:
        raise RunFolderError(
            f"{folder}: {Path(file).name}, or a module that it imports, has changed since this run began; "
            "undo the change, or train in another folder"
        )


def load_run(folder: str | Path) -> TrainResult:
    """Load a finished run."""
    path = Path(folder)
    if not path.exists():
        raise RunFolderError(f"{path}: there is no such folder")
    if path.is_dir() and not (path / RESULT).exists():
        raise RunFolderError(f"{path}: not the folder of a run that has ended: there is no {RESULT}")
    try:
        figures: Figures = json.loads((path / RESULT).read_text(encoding="utf-8"))
        lines = (path / LOG).read_text(encoding="utf-8").splitlines()
        known = {entry.name for entry in fields(Validation)}
        validations = [
            Validation(**{key: value for key, value in json.loads(line).items() if key in known})
            for line in lines
        ]
    except (OSError, ValueError, TypeError) as error:
        raise RunFolderError(f"{path}: not the folder of a run that has ended: {error}") from error
    return TrainResult(read_settings(path), path, load_actor(path / ACTOR), validations, figures)


def read_settings(folder: Path) -> TrainSettings:
    """Read the settings of the run in a folder."""
    path = folder / SETTINGS
    try:
        return settings_of(read_yaml(path, SettingsError), str(path))
    except SettingsError as error:
        raise RunFolderError(str(error)) from error


def save_actor(actor: Actor, path: Path) -> None:
    """Write an actor: its weights and the arguments to build it."""
    buffer = io.BytesIO()
    torch.save({"build": actor.build, "weights": actor.state_dict()}, buffer)
    write_atomically(path, buffer.getvalue())


def load_actor(path: str | Path) -> Actor:
    """Load an actor from its file; no code in the file is run."""
    try:
        stored = torch.load(path, weights_only=True)
        actor = Actor(**stored["build"])
        actor.load_state_dict(stored["weights"])
    except Exception as error:
        # A damaged archive fails in any of many ways.
        raise RunFolderError(f"{path}: not an actor of robobt, or damaged") from error
    return actor


def _first_difference(old: Mapping[str, object], new: Mapping[str, object], prefix: str = "") -> str:
    for key in new:
        before, after = old.get(key), new[key]
        if before != after:
            if isinstance(before, Mapping) and isinstance(after, Mapping):
                return _first_difference(before, after, f"{prefix}{key}.")
            return f"{prefix}{key}"
    return "more of them"
