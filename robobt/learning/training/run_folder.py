"""The folder of a training run, and what is read back from it.

| file | what |
| --- | --- |
| ``settings.yaml`` | every setting of the run |
| ``log.jsonl`` | a line an evaluation: :class:`Judged` |
| ``checkpoint``, ``checkpoint.previous`` | all that a resumed run needs; gone once the run has ended |
| ``actor.pt`` | the best actor's weights, and how to build it |
| ``result.json`` | held-out figures: :meth:`TrainResult.figures` |
| ``curves.png`` | success and time over steps |
| ``tensorboard/`` | the log's figures as events |
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import torch

from robobt import __version__
from robobt.config.atomic import write_atomically
from robobt.config.errors import RobobtError, naming
from robobt.config.yaml import read_yaml, write_yaml
from robobt.learning.agents.networks import Actor
from robobt.learning.training import checkpoint
from robobt.learning.training.checkpoint import Arrays, CheckpointError
from robobt.learning.training.settings import SettingsError, TrainSettings, settings_of

SETTINGS, LOG, CHECKPOINT = "settings.yaml", "log.jsonl", "checkpoint"
ACTOR, RESULT, CURVES, EVENTS = "actor.pt", "result.json", "curves.png", "tensorboard"


class RunFolderError(RobobtError, ValueError):
    """A run's folder cannot be used; the message is one line that names it."""


@dataclass(frozen=True, slots=True)
class Judged:
    """An evaluation on the way.

    Attributes:
        steps, updates: so far.
        success: share of the validation starts.
        mean_time: of the successes [s]; None without any.
        time_ratio: that time over the optimum; None where unknown.
        mean_return: undiscounted; tells how the reward is collected, not how good the policy is.
        cpu_s: CPU time spent on collecting and learning.
        evaluation_cpu_s: CPU time spent on evaluations.
        wall_s: time passed, broken runs' parts included.
        critic_loss, value: means since the last evaluation; None without updates.
    """

    steps: int
    updates: int
    success: float
    mean_time: float | None
    time_ratio: float | None
    mean_return: float
    cpu_s: float
    evaluation_cpu_s: float
    wall_s: float
    critic_loss: float | None
    value: float | None

    @property
    def score(self) -> tuple[float, float]:
        """What policies are ranked by: successes, then speed. Never by the return."""
        return (self.success, float("-inf") if self.mean_time is None else -self.mean_time)


@dataclass(frozen=True, slots=True)
class TrainResult:
    """What a run has come to.

    Attributes:
        settings: of the run.
        folder: where it lies.
        actor: the best actor by the validation starts: raw observation in SI units ->
            action in [-1, 1].
        judged: every evaluation on the validation starts.
        figures: what ``result.json`` holds: ``task``, ``preset``, ``seed``, ``robobt``,
            ``stopped_early``, ``steps``, ``updates``, ``best_steps`` (when the best actor was
            met), ``cpu_s`` (collecting and learning), ``evaluation_cpu_s``, ``wall_s``,
            ``held_out`` (``starts``, ``successes``, ``success``, ``low`` and ``high`` of
            Wilson's 95 % interval, ``mean_time`` [s], ``optimum`` [s], ``time_ratio``) and
            ``weights`` (a hash of the agent's final weights).
    """

    settings: TrainSettings
    folder: Path
    actor: Actor
    judged: list[Judged]
    figures: dict[str, Any]


class RunFolder:
    """A run's folder, open for writing. A context manager.

    Args:
        path: the folder; made if it is not there.
        settings: of the run.
        resume: whether to go on with a run that is in the folder.

    Attributes:
        result: of a run that has ended already, None else.
        stored: arrays and plain data of the checkpoint to go on from; None to start.
        warning: why an older checkpoint than the newest was taken, None where it was not.

    Raises:
        RunFolderError: it holds a run that is not to be resumed, or was made with other settings.
        CheckpointError: no checkpoint can be read.
    """

    def __init__(self, path: Path, settings: TrainSettings, resume: bool) -> None:
        self.path = path
        self.settings = settings
        self.result: TrainResult | None = None
        self.stored: tuple[Arrays, dict[str, Any]] | None = None
        self.warning: str | None = None
        if path.exists() and not path.is_dir():
            raise RunFolderError(f"{path}: is not a folder")
        if (path / SETTINGS).exists() and (resume or self._has_begun()):
            self._take_up(resume)
        elif path.is_dir() and {entry.name for entry in path.iterdir()} - {SETTINGS, LOG, EVENTS}:
            raise RunFolderError(f"{path}: holds other files; give a new folder")
        else:
            path.mkdir(parents=True, exist_ok=True)
            write_atomically(path / SETTINGS, write_yaml(settings.model_dump(mode="json")))

    def __enter__(self) -> Self:
        kept = self._kept_lines()
        with naming(self.path / LOG):
            self._log = (self.path / LOG).open("w", encoding="utf-8")
            self._log.write("".join(kept))
            self._log.flush()
        self._events: Any = None
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

    def log(self, judged: Judged) -> None:
        """Append an evaluation; it is in the file when this returns."""
        with naming(self.path / LOG):
            self._log.write(json.dumps(asdict(judged), allow_nan=False) + "\n")
            self._log.flush()
        if self._events is not None:
            for name, value in asdict(judged).items():
                if value is not None and name != "steps":
                    self._events.add_scalar(name, value, judged.steps)
            self._events.flush()

    def save(self, arrays: Arrays, plain: Mapping[str, Any]) -> None:
        """Write the checkpoint."""
        checkpoint.save(self.path / CHECKPOINT, arrays, {**plain, "robobt": __version__})

    def finish(self, result: TrainResult) -> None:
        """Write actor, curves and figures, the figures last: they say that the run has ended."""
        from robobt.learning.training.curves import draw_curves

        save_actor(result.actor, self.path / ACTOR)
        name = f"seed {result.settings.seed}"
        draw_curves({name: result.judged}, title_of(result.settings), self.path / CURVES)
        text = json.dumps(result.figures, indent=2, allow_nan=False) + "\n"
        write_atomically(self.path / RESULT, text)
        for path in (*self._checkpoints(), *self.path.glob(f".*.{CHECKPOINT}")):
            path.unlink(missing_ok=True)

    def _has_begun(self) -> bool:
        """Whether there is anything to lose: a run that failed before its first evaluation has nothing."""
        log = self.path / LOG
        written = any(path.exists() for path in (self.path / RESULT, *self._checkpoints()))
        return written or (log.exists() and log.stat().st_size > 0)

    def _checkpoints(self) -> tuple[Path, Path]:
        return self.path / CHECKPOINT, checkpoint.previous(self.path / CHECKPOINT)

    def _take_up(self, resume: bool) -> None:
        if not resume:
            raise RunFolderError(f"{self.path}: holds a run already; resume it, or give another folder")
        stored = read_settings(self.path)
        if stored != self.settings:
            field = _first_difference(stored.model_dump(), self.settings.model_dump())
            raise RunFolderError(
                f"{self.path}: holds a run with other settings ({field}); give another folder"
            )
        if (self.path / RESULT).exists():
            self.result = load_run(self.path)
            return
        newest = self.path / CHECKPOINT
        if newest.exists() or checkpoint.previous(newest).exists():
            arrays, plain, self.warning = checkpoint.load_latest(newest)
            if plain["robobt"] != __version__:
                raise RunFolderError(
                    f"{self.path}: was begun by robobt {plain['robobt']}, this is {__version__}"
                )
            self.stored = arrays, plain

    def _kept_lines(self) -> list[str]:
        """The log up to the checkpoint; a resumed run writes the lines after it again."""
        judged = [] if self.stored is None else self.stored[1]["judged"]
        return [json.dumps(line) + "\n" for line in judged]


def load_run(folder: str | Path) -> TrainResult:
    """A run that has ended.

    Raises:
        RunFolderError: something in the folder is missing or damaged.
    """
    path = Path(folder)
    try:
        figures = json.loads((path / RESULT).read_text(encoding="utf-8"))
        lines = (path / LOG).read_text(encoding="utf-8").splitlines()
        known = {entry.name for entry in fields(Judged)}
        judged = [
            Judged(**{key: value for key, value in json.loads(line).items() if key in known})
            for line in lines
        ]
    except (OSError, ValueError, TypeError) as error:
        raise RunFolderError(f"{path}: not the folder of a run that has ended: {error}") from error
    return TrainResult(read_settings(path), path, load_actor(path / ACTOR), judged, figures)


def title_of(settings: TrainSettings) -> str:
    """What a run is called in pictures and tables."""
    return f"{settings.task}, {settings.preset}" if settings.preset else settings.task


def read_settings(folder: Path) -> TrainSettings:
    """The settings of the run in a folder.

    Raises:
        RunFolderError: they cannot be read.
    """
    path = folder / SETTINGS
    try:
        return settings_of(read_yaml(path, SettingsError), str(path))
    except SettingsError as error:
        raise RunFolderError(str(error)) from error


def save_actor(actor: Actor, path: Path) -> None:
    """Write an actor: weights and how to build it."""
    buffer = io.BytesIO()
    torch.save({"build": actor.build, "weights": actor.state_dict()}, buffer)
    write_atomically(path, buffer.getvalue())


def load_actor(path: str | Path) -> Actor:
    """An actor from its file; nothing in the file is run.

    Raises:
        RunFolderError: it cannot be read.
    """
    try:
        stored = torch.load(path, weights_only=True)
        actor = Actor(**stored["build"])
        actor.load_state_dict(stored["weights"])
    except Exception as error:
        # A damaged archive fails in any of many ways.
        raise RunFolderError(f"{path}: not an actor of robobt, or damaged") from error
    return actor


def _first_difference(old: Mapping[str, Any], new: Mapping[str, Any], prefix: str = "") -> str:
    for key in new:
        if old.get(key) != new[key]:
            if isinstance(old.get(key), Mapping) and isinstance(new[key], Mapping):
                return _first_difference(old[key], new[key], f"{prefix}{key}.")
            return f"{prefix}{key}"
    return "more of them"


__all__ = [
    "CheckpointError",
    "Judged",
    "RunFolder",
    "RunFolderError",
    "TrainResult",
    "load_actor",
    "load_run",
    "read_settings",
    "save_actor",
]
