"""What a training run costs, over all the processes it took."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager


class RunClock:
    """What a run has cost, with what its broken parts cost, and evaluations by themselves."""

    def __init__(self) -> None:
        self._cpu, self._wall = time.process_time(), time.monotonic()
        self._earlier = {"cpu_s": 0.0, "wall_s": 0.0}
        self.apart_s = 0.0
        self._apart_here = 0.0

    @property
    def cpu_s(self) -> float:
        """CPU time but for evaluations [s]."""
        return self._earlier["cpu_s"] + time.process_time() - self._cpu - self._apart_here

    @property
    def here_s(self) -> float:
        """Time since this process took the run up [s]."""
        return time.monotonic() - self._wall

    @property
    def wall_s(self) -> float:
        """Time in all [s]."""
        return self._earlier["wall_s"] + self.here_s

    @contextmanager
    def apart(self) -> Iterator[None]:
        """Count CPU time as an evaluation's."""
        begun = time.process_time()
        yield
        self._apart_here += time.process_time() - begun
        self.apart_s += time.process_time() - begun

    def state(self) -> dict[str, float]:
        """What a resumed run goes on from."""
        return {"cpu_s": self.cpu_s, "wall_s": self.wall_s, "apart_s": self.apart_s}

    def restore(self, state: Mapping[str, float]) -> None:
        """Count on from a broken run's ``state``."""
        self._earlier = {"cpu_s": state["cpu_s"], "wall_s": state["wall_s"]}
        self.apart_s = state["apart_s"]
