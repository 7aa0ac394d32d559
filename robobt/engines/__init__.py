"""Engines that run work: in this process, in worker processes, or on a Ray cluster."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "RayEngine": "cluster",
    "Work": "work",
    "engine": "run",
    "run_tasks": "run",
    "running_on": "run",
}

if TYPE_CHECKING:
    from robobt.engines.cluster import RayEngine as RayEngine
    from robobt.engines.run import engine as engine
    from robobt.engines.run import run_tasks as run_tasks
    from robobt.engines.run import running_on as running_on
    from robobt.engines.work import Work as Work
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
