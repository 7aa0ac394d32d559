"""Demonstrations: a teacher's transitions, in a Parquet file that anything can read.

One row per control step, in the order of episodes and ticks:

| column | type | what |
| --- | --- | --- |
| ``episode``, ``tick`` | int32 | from 0 |
| ``observation`` | list of float64 | raw, SI units, as :mod:`robobt.world.features` defines it |
| ``next_observation`` | the same | what the step led to, the episode's own last one at its end |
| ``action`` | list of float64 | in [-1, 1] |
| ``reward`` | float64 | of the step |
| ``terminated``, ``truncated``, ``success`` | bool | how the episode ended with this step, if it did |

The schema's metadata holds, under ``robobt``, JSON: ``format``, ``task``,
``observation`` (name and version), ``environment`` (all its settings),
``teacher``, ``seed`` and ``robobt`` (the version that wrote it).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from robobt import __version__
from robobt.config.atomic import replacing
from robobt.config.errors import RobobtError, naming, unknown_name
from robobt.learning.agents.nstep import NStep, Transitions
from robobt.learning.envs import ArenaTask, TaskSettings, make_task
from robobt.learning.envs.task import BoolArray, FloatArray
from robobt.learning.training.teachers import TEACHERS

DEMONSTRATIONS_FORMAT = "robobt-demonstrations-1"

_RECORDING_ARENAS = 16
"""Side by side while recording."""

_STEP_COLUMNS = ("observation", "action", "reward", "next_observation", "terminated", "truncated", "success")
"""The columns of a step."""

_MEANINGS = ("action", "period", "reward", "contact")
"""Settings that define actions and rewards; if they differ, the critic would learn a wrong value."""


class DemonstrationsError(RobobtError, ValueError):
    """A file of demonstrations cannot be used; the message is one line that names it."""


@dataclass(frozen=True, slots=True)
class Demonstrations:
    """Whole episodes, one step a row.

    Attributes:
        episode: (m,) rising.
        observation, action, reward, next_observation: (m, ...) of each step.
        terminated, truncated, success: (m,) how its episode ended with it.
        about: where they come from; the file's metadata.
    """

    episode: NDArray[np.int64]
    observation: FloatArray
    action: FloatArray
    reward: FloatArray
    next_observation: FloatArray
    terminated: BoolArray
    truncated: BoolArray
    success: BoolArray
    about: dict[str, Any]

    def __len__(self) -> int:
        return len(self.episode)

    @property
    def episodes(self) -> int:
        """How many episodes there are."""
        return int((self.terminated | self.truncated).sum())

    def first(self, episodes: int) -> Demonstrations:
        """Return the first ``count`` episodes."""
        rows = np.searchsorted(self.episode, np.unique(self.episode)[:episodes][-1], side="right")
        parts = {item.name: getattr(self, item.name)[:rows] for item in fields(self) if item.name != "about"}
        return Demonstrations(**parts, about=self.about)

    def transitions(self, horizons: Sequence[int], gamma: float) -> Iterator[tuple[Transitions, ...]]:
        """Yield what a replay takes, as :class:`~robobt.learning.agents.nstep.NStep` makes it."""
        returns = NStep(horizons, gamma, 1, self.observation.shape[1], self.action.shape[1])
        columns = [getattr(self, name) for name in _STEP_COLUMNS if name != "success"]
        for i in range(len(self)):
            yield from returns.add(*[column[i : i + 1] for column in columns])

    def write(self, path: str | Path) -> None:
        """Write the file; one that is there is replaced once the new one is whole."""
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        ticks = np.arange(len(self)) - np.searchsorted(self.episode, self.episode)
        columns = {
            "episode": pa.array(self.episode.astype(np.int32)),
            "tick": pa.array(ticks.astype(np.int32)),
            **{name: _column(getattr(self, name)) for name in _STEP_COLUMNS},
        }
        table = pa.table(columns).replace_schema_metadata({"robobt": json.dumps(self.about)})
        with replacing(path) as temporary, naming(path):
            pq.write_table(table, temporary)


def read_demonstrations(path: str | Path) -> Demonstrations:
    """Read demonstrations from their file.

    Raises:
        DemonstrationsError: it cannot be read, or holds something else.
    """
    try:
        table = pq.read_table(path)
        about = json.loads((table.schema.metadata or {})[b"robobt"])
    except (OSError, ValueError, KeyError) as error:
        raise DemonstrationsError(f"{path}: no demonstrations can be read: {_reason(error)}") from error
    if not isinstance(about, dict) or about.get("format") != DEMONSTRATIONS_FORMAT:
        raise DemonstrationsError(f"{path}: not a file of demonstrations")
    try:
        episode = table["episode"].to_numpy().astype(np.int64)
        steps = {name: _array(table[name]) for name in _STEP_COLUMNS}
        return Demonstrations(episode=episode, about=about, **steps)
    except (KeyError, ValueError) as error:
        raise DemonstrationsError(f"{path}: {_reason(error)}") from error


def record(
    environment: TaskSettings,
    episodes: int,
    teacher: str = "skill",
    seed: int = 0,
    on_episode: Callable[[int], None] | None = None,
) -> Demonstrations:
    """Record demonstrations of a teacher. Return them.

    Args:
        environment: the environment; its type defines the task.
        episodes: number of episodes, each from its own start.
        teacher: "skill", the hand-written one, or "script".
        seed: of the starts, the noise and the randomisation.
        on_episode: called with the number of episodes that have ended.

    Raises:
        ValueError: no such teacher, or no episodes.
    """
    if teacher not in TEACHERS:
        raise ValueError(f"no teacher is called {teacher!r}; {unknown_name(teacher, TEACHERS)}")
    if episodes < 1:
        raise ValueError(f"episodes must be at least 1, not {episodes}")
    task = make_task(environment, min(episodes, _RECORDING_ARENAS))
    teaching = TEACHERS[teacher](task)
    starts = task.sample_starts(seed, episodes)
    observation = task.reset_to(starts, seed)
    teaching.begin(np.arange(task.n))
    running: list[list[tuple[object, ...]]] = [[] for _ in range(task.n)]
    ended: dict[int, list[tuple[object, ...]]] = {}
    while len(ended) < episodes:
        # A direction of length 1 may have been rounded past it.
        action = np.clip(teaching.act(observation), -1.0, 1.0)
        step = task.step(action)
        columns = (
            *(observation, action, step.reward, step.final_observation),
            *(step.terminated, step.truncated, step.success),
        )
        for arena in range(task.n):
            running[arena].append(tuple([column[arena] for column in columns]))
        which = np.flatnonzero(step.terminated | step.truncated)
        if task.ended is not None:
            for arena, start in zip(which.tolist(), task.ended.start.tolist(), strict=True):
                rows, running[arena] = running[arena], []
                if start >= 0:
                    ended[start] = rows
            teaching.begin(which)
            if on_episode is not None:
                on_episode(len(ended))
        observation = step.observation
    flat = [row for start in range(episodes) for row in ended[start]]
    numbers = [start for start in range(episodes) for _ in ended[start]]
    about = {
        "format": DEMONSTRATIONS_FORMAT,
        "task": task.observation.name,
        "observation": _named(task),
        "environment": environment.model_dump(mode="json"),
        "teacher": teacher,
        "seed": seed,
        "robobt": __version__,
    }
    steps = dict(zip(_STEP_COLUMNS, map(np.array, zip(*flat, strict=True)), strict=True))
    return Demonstrations(episode=np.array(numbers), about=about, **steps)


def demonstrations_for(
    environment: TaskSettings, episodes: int, file: str | None, seed: int
) -> Demonstrations:
    """Return the demonstrations that training settings ask for: from a file, else the script's.

    Raises:
        DemonstrationsError: the file cannot be used, is of another task, holds too few, or its
            actions and rewards mean something else than those of the environment.
    """
    if file is None:
        return record(environment, episodes, "script", seed)
    found = read_demonstrations(file)
    task = make_task(environment, 1)
    if found.about.get("observation") != _named(task) or found.action.shape[1] != task.action_size:
        raise DemonstrationsError(f"{file}: holds demonstrations of {found.about.get('observation')}")
    there, here = found.about.get("environment"), environment.model_dump(mode="json")
    for part in _MEANINGS:
        if isinstance(there, dict) and part in there and there[part] != here.get(part):
            raise DemonstrationsError(
                f"{file}: was recorded with another environment.{part}: {there[part]}, here {here.get(part)}"
            )
    if found.episodes < episodes:
        raise DemonstrationsError(f"{file}: holds {found.episodes} episodes, not {episodes}")
    return found.first(episodes)


def _named(task: ArenaTask) -> dict[str, object]:
    return {"name": task.observation.name, "version": task.observation.version}


def _column(values: NDArray[Any]) -> pa.Array:
    if values.ndim == 1:
        return pa.array(values)
    return pa.FixedSizeListArray.from_arrays(pa.array(values.ravel()), values.shape[1])


def _array(column: pa.ChunkedArray) -> NDArray[Any]:
    values: NDArray[Any]
    if not pa.types.is_nested(column.type):
        values = column.to_numpy()
        return values
    values = column.combine_chunks().flatten().to_numpy(zero_copy_only=False)
    return values.astype(np.float64).reshape(len(column), -1)


def _reason(error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return "there is no such file"
    return " ".join(str(error.args[0] if error.args else type(error).__name__).split())
