"""Time and progress of a training run."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from robobt.learning.training.results import Validation
from robobt.learning.training.selection import Selection
from robobt.learning.training.settings import TrainSettings


class RunClock:
    """CPU and wall time of a run over all its processes; evaluations are counted separately."""

    def __init__(self) -> None:
        self._cpu, self._wall = time.process_time(), time.monotonic()
        self._earlier_cpu_s = self._earlier_wall_s = 0.0
        self._evaluation_here_s = self._evaluation_wall_s = 0.0
        self.evaluation_s = 0.0

    @property
    def cpu_s(self) -> float:
        """CPU time without evaluations [s]."""
        return self._earlier_cpu_s + time.process_time() - self._cpu - self._evaluation_here_s

    @property
    def here_s(self) -> float:
        """Wall time in this process [s]."""
        return time.monotonic() - self._wall

    @property
    def wall_s(self) -> float:
        """Total wall time [s]."""
        return self._earlier_wall_s + self.here_s

    @property
    def learning_here_s(self) -> float:
        """Wall time in this process without evaluations [s]."""
        return self.here_s - self._evaluation_wall_s

    @contextmanager
    def evaluating(self) -> Iterator[None]:
        """Count the time of the block as an evaluation's."""
        begun, since = time.process_time(), time.monotonic()
        yield
        self._evaluation_wall_s += time.monotonic() - since
        spent = time.process_time() - begun
        self._evaluation_here_s += spent
        self.evaluation_s += spent

    def state(self) -> dict[str, float]:
        """Return the times so far, for a resumed run."""
        return {"cpu_s": self.cpu_s, "wall_s": self.wall_s, "evaluation_s": self.evaluation_s}

    def restore(self, state: Mapping[str, float]) -> None:
        """Continue from the ``state`` of an interrupted run."""
        self._earlier_cpu_s, self._earlier_wall_s = state["cpu_s"], state["wall_s"]
        self.evaluation_s = state["evaluation_s"]


_EVERY = 0.5
"""Time between reports [s]."""


@dataclass(frozen=True, slots=True)
class TrainingProgress:
    """Progress of a run.

    Attributes:
        seed: of the run.
        steps, of: environment steps taken and in total.
        wall_s, cpu_s: time spent so far, in interrupted processes too.
        left_s: estimated time to the last step, without an early stop.
        latest, best: evaluations, None before the first.
    """

    seed: int
    steps: int
    of: int
    wall_s: float
    cpu_s: float
    left_s: float
    latest: Validation | None
    best: Validation | None


OnProgress = Callable[[TrainingProgress], None]


class Reporter:
    """Reports the progress of a run."""

    def __init__(
        self, settings: TrainSettings, on_progress: OnProgress | None, clock: RunClock, selection: Selection
    ) -> None:
        self._settings = settings
        self._on_progress = on_progress
        self._clock = clock
        self._selection = selection
        self._begun_at = 0
        self._reported = 0.0

    def begin(self, steps: int) -> None:
        """Measure the pace from this step on."""
        self._begun_at = steps

    def report(self, steps: int, now: bool = False) -> None:
        """Report, unless the last report is recent; with ``now`` in any case."""
        if self._on_progress is None or not (now or time.monotonic() - self._reported > _EVERY):
            return
        self._reported = time.monotonic()
        settings, clock, selection = self._settings, self._clock, self._selection
        pace = clock.here_s / max(1, steps - self._begun_at)
        left_s = pace * (settings.steps - steps)
        self._on_progress(
            TrainingProgress(
                settings.seed,
                steps,
                settings.steps,
                clock.wall_s,
                clock.cpu_s,
                left_s,
                selection.latest,
                selection.best,
            )
        )
