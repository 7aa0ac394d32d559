"""CPU and wall time of a training run."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager


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
