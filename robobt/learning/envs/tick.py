"""The tick that a task written in Python receives, and checks of its results."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robobt.config.errors import RobobtError
from robobt.learning.envs.task import BoolArray, EpisodeEnds, FloatArray
from robobt.signals import Terminated
from robobt.world.observation import Seen


class TaskError(RobobtError, RuntimeError):
    """A part of a task has failed; the message names the line of its file, the class and the part."""


@dataclass(slots=True)
class Tick:
    """A tick of all arenas, passed to :meth:`ArenaTask.ends` and then to :meth:`ArenaTask.reward`.

    Attributes:
        now: robots and balls after the tick, in field coordinates; ``now.me`` is the first learner.
        before: robots and balls before the tick.
        contact: (n, R) whether the ball is in each robot's mouth.
        kicked: (n, R) whether each robot's kicker has fired.
        touch: (n,) index of the last robot that touched the ball, -1 for none.
        goal: (n,) the sign of x of the goal that the ball has entered, 0 for none.
        actions: (n, A) in [-1, 1].
        ticks: (n,) ticks since the start of each episode.
        success: (n,) episodes that end with success: by the base task, then also by :meth:`ArenaTask.ends`.
        failed: (n,) episodes that end without success.
        terms: (n,) each, the reward's terms of the base task, by name.
    """

    now: Seen
    before: Seen
    contact: BoolArray
    kicked: BoolArray
    touch: NDArray[np.int64]
    goal: NDArray[np.int64]
    actions: FloatArray
    ticks: FloatArray
    success: BoolArray
    failed: BoolArray
    terms: Mapping[str, FloatArray]


def call(task: object, part: str, *given: Any) -> Any:
    """Call a part of a task; errors name its line, class and part.

    Raises:
        TaskError: for any error in a part that is not robobt's.
    """
    try:
        return getattr(task, part)(*given)
    except Terminated:
        raise
    except (Exception, SystemExit) as error:
        if type(task).__module__.startswith("robobt."):
            raise
        raise error_of(type(task), part, error) from error


def error_of(task: type, part: str, error: BaseException) -> TaskError:
    """Return an error in a part of a task as one that names the line in the task's file."""
    file = getattr(sys.modules.get(task.__module__), "__file__", None)
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    place = f"{Path(file).name}:{lines[-1]}: " if file and lines else ""
    kind = "" if isinstance(error, ValueError | NotImplementedError) else f"{type(error).__name__}: "
    return TaskError(f"{place}{task.__name__}.{part}: {kind}{error}")


def checked_starts(task: object, columns: int, rng: np.random.Generator, count: int) -> FloatArray:
    """Return ``count`` starts that a task's ``sample`` draws with ``rng``, (count, columns).

    Raises:
        TaskError: it fails, or its result has another shape or is not finite.
    """
    rows = call(task, "sample", rng, count)
    if np.shape(rows) != (count, columns):
        problem = ValueError(f"returns starts of the shape {np.shape(rows)}, not {(count, columns)}")
        raise error_of(type(task), "sample", problem)
    if not np.isfinite(rows).all():
        raise error_of(type(task), "sample", ValueError("a start is not finite"))
    return np.asarray(rows, dtype=np.float64)


def checked_ends(task: object, tick: Tick, n: int) -> tuple[BoolArray, BoolArray]:
    """Return which of ``n`` episodes a task's ``ends`` ends with success, and which without.

    Raises:
        TaskError: it fails, or returns something else.
    """
    parts = call(task, "ends", tick)
    if (
        not isinstance(parts, tuple)
        or len(parts) != 2
        or any(np.shape(part) not in ((), (n,)) for part in parts)
    ):
        problem = ValueError(f"returns no pair of arrays ({n},): success, and other ends")
        raise error_of(type(task), "ends", problem)
    for part, name in zip(parts, ("success", "other ends"), strict=True):
        if np.asarray(part).dtype != np.bool_:
            problem = ValueError(f"returns {np.asarray(part).dtype} for {name}, not truth values")
            raise error_of(type(task), "ends", problem)
    success, failed = (np.broadcast_to(np.asarray(part, dtype=np.bool_), n) for part in parts)
    return success, failed


def end_by(task: object, tick: Tick, ends: EpisodeEnds, time_limit: int) -> None:
    """Fill ``ends`` by a task's ``ends`` and the time limit, except for episodes that have already ended.

    Raises:
        TaskError: see :func:`checked_ends`.
    """
    going = ~ends.over
    success, failed = checked_ends(task, tick, len(going))
    tick.success, tick.failed = success & going, failed & going & ~success
    over = tick.success | tick.failed
    ends.success[:] |= tick.success
    ends.terminated[:] |= over
    ends.truncated[:] |= going & ~over & (tick.ticks >= time_limit)


def checked_terms(task: object, tick: Tick, n: int) -> dict[str, FloatArray]:
    """Return the terms of a task's ``reward`` in ``n`` arenas, (n,) each.

    Raises:
        TaskError: it fails, or a term has another shape or is not finite.
    """
    terms = call(task, "reward", tick)
    if not isinstance(terms, Mapping):
        problem = ValueError(f"returns a {type(terms).__name__}, not the terms by their names")
        raise error_of(type(task), "reward", problem)
    found = {}
    for name, term in terms.items():
        if not isinstance(name, str):
            raise error_of(type(task), "reward", ValueError(f"{name!r} is not a name of a term"))
        try:
            numbers = np.asarray(term, dtype=np.float64)
        except (TypeError, ValueError) as error:
            problem = ValueError(f"the term {name!r} is no array of numbers")
            raise error_of(type(task), "reward", problem) from error
        if numbers.shape not in ((), (n,)) or not np.isfinite(numbers).all():
            wrong = (
                "is not finite"
                if numbers.shape in ((), (n,))
                else f"has the shape {numbers.shape}, not {(n,)}"
            )
            raise error_of(type(task), "reward", ValueError(f"the term {name!r} {wrong}"))
        found[name] = np.broadcast_to(numbers, n)
    return found
