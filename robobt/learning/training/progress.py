"""Progress reports of a training run."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from robobt.learning.training.clock import RunClock
from robobt.learning.training.results import Validation
from robobt.learning.training.selection import Selection
from robobt.learning.training.settings import TrainSettings

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
