"""The work on many tasks, on any engine."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from robobt.config.errors import RobobtError

TaskT = TypeVar("TaskT")
ReportT = TypeVar("ReportT")
ResultT = TypeVar("ResultT")

MAX_WORKERS = 256
"""Most worker processes of a run."""


@dataclass(slots=True, frozen=True)
class Work(Generic[TaskT, ReportT, ResultT]):
    """The work on each task, and the wording of its failures.

    Attributes:
        do: called with a task and a function that reports on its progress. For several workers it
            must be a function of a module or another object that can be pickled.
        noun: name of a task in error messages, followed by its number or name.
        error: raised, with a message of one line, when a task raises, its worker dies or the work
            cannot be sent to a worker.
        passed: exceptions of a task that are raised as they are.
    """

    do: Callable[[TaskT, Callable[[ReportT], None]], ResultT]
    noun: str
    error: type[Exception]
    passed: tuple[type[Exception], ...] = ()

    def attempt(self, task: TaskT, report: Callable[[ReportT], None]) -> ResultT:
        """Do one task in this process, which may ``report`` on its progress; return its result."""
        try:
            return self.do(task, report)
        except (self.error, *self.passed):
            raise
        except Exception as error:
            # robobt's own errors are written for users; any other may be a bug.
            said = str(error) if isinstance(error, RobobtError) else f"{type(error).__name__}: {error}"
            raise self.error(f"{self.noun} {task}: {said}") from error

    def packed(self) -> bytes:
        """Return the work as it is sent to another process."""
        try:
            return pickle.dumps(self)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise self.error(f"{self.noun}s cannot be sent to worker processes: {error}") from error
