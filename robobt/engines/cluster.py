"""Tasks on a Ray cluster: an existing one, or a new one of this machine's cores."""

from __future__ import annotations

import hashlib
import os
import pickle
import shutil
import sys
import tempfile
import time
import traceback
from collections import deque
from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import robobt
from robobt.config.closing import Closing
from robobt.config.errors import RobobtError, one_line
from robobt.config.resources import models_folder, scenarios_folder
from robobt.config.telling import tell_warnings
from robobt.config.wording import counted
from robobt.engines.work import ReportT, ResultT, TaskT, Work

_TASK_ATTEMPTS = 4
"""Number of tries of a task whose worker or node is lost, because the task itself may be the cause."""

_BATCH_TIME, _BATCH_LIMIT = 1.0, 32
"""Short tasks are sent in batches of about this duration [s], and of at most this many."""

_RESULT_POLL = 0.5
"""Longest wait for a result at a time; reports and signals are checked in between [s]."""


class ClusterError(RobobtError, RuntimeError):
    """A Ray cluster cannot be used; the message is one line."""


class RayEngine(Closing):
    """Runs tasks on a Ray cluster. A context manager; the cluster is left at its end.

    A task whose worker or node is lost is run again, elsewhere.

    Args:
        address: "ray" for the cluster that Ray finds (``RAY_ADDRESS``, or one of this machine), or else a
            new one of this machine's cores; "ray://HOST:PORT" for the head of one. Options behind "?":
            ``cpus``, the cores that a task takes (1), and ``ship``, whether robobt is sent to the nodes with
            its models (by default for ray:// only).

    Attributes:
        workers: number of tasks that the cluster can run at a time.

    Raises:
        ClusterError: Ray is not installed, the address is wrong, or the cluster cannot be reached.
    """

    def __init__(self, address: str) -> None:
        where, cpus, ship = _read(address)
        # Ray sends usage statistics to its makers unless this is set.
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
        try:
            import ray
        except ImportError as error:
            problem = 'is not installed; pip install "robobt[ray]"'
            raise ClusterError(f"{address}: Ray {problem}") from error
        self._ray: Any = ray
        self._cpus = cpus
        self._folder = tempfile.TemporaryDirectory(prefix="robobt-ray-")
        self._own = not ray.is_initialized()
        try:
            if self._own:
                self._connect(where, ship)
            self.workers = max(1, int(ray.cluster_resources().get("CPU", 1.0) / cpus))
        except Exception as error:
            self.close()
            problem = one_line(str(error), 300)
            if "connection timeout" in problem:
                problem += '; is it the client port of a head that has "ray[client]"?'
            raise ClusterError(f"{address}: {problem}") from error

    def close(self) -> None:
        """Leave the cluster; one that was started for this engine ends."""
        if self._own:
            self._ray.shutdown()
        self._folder.cleanup()

    def run(
        self,
        work: Work[TaskT, ReportT, ResultT],
        tasks: Iterable[TaskT],
        workers: int,
        *,
        setup: Callable[[], object] | None = None,
        on_report: Callable[[ReportT], None] | None = None,
        lost: Callable[[TaskT, str], ResultT] | None = None,
    ) -> Generator[ResultT, None, None]:
        """Yield the result of every task, in the order in which they finish.

        Arguments and errors are as for :func:`robobt.engines.run.run_tasks`.
        """
        ray = self._ray
        packed = pickle.dumps((setup, work.packed()))
        key, shared = hashlib.blake2b(packed, digest_size=16).digest(), ray.put(packed)
        do = ray.remote(_do).options(num_cpus=self._cpus, max_retries=0)
        reports = None
        if on_report is not None:
            from ray.util.queue import Queue

            reports = Queue()
        waiting = iter(tasks)
        again: deque[tuple[TaskT, int]] = deque()
        flying: dict[Any, tuple[list[TaskT], int]] = {}
        size = 1
        try:
            while True:
                while len(flying) < workers:
                    if again:
                        task, attempt = again.popleft()
                        batch = [task]
                    else:
                        batch, attempt = list(islice(waiting, size)), 1
                    if not batch:
                        break
                    flying[do.remote(key, shared, os.getcwd(), batch, reports)] = batch, attempt
                if not flying:
                    break
                ready, _ = ray.wait(list(flying), num_returns=1, timeout=_RESULT_POLL)
                if reports is not None and on_report is not None:
                    for report in reports.get_nowait_batch(reports.size()):
                        on_report(report)
                for reference in ready:
                    batch, attempt = flying.pop(reference)
                    try:
                        answers, seconds = ray.get(reference)
                    except ray.exceptions.RayError as error:
                        if len(batch) > 1 or attempt < _TASK_ATTEMPTS:
                            # One by one, so that a task that ends its worker does not affect others.
                            again.extend([(task, attempt + (len(batch) == 1)) for task in batch])
                            continue
                        died = f"lost {counted(attempt, 'time')}: {one_line(str(error), 200)}"
                        if lost is None:
                            raise work.error(f"{work.noun} {batch[0]}: {died}") from error
                        yield lost(batch[0], died)
                        continue
                    size = max(1, min(_BATCH_LIMIT, int(_BATCH_TIME * len(batch) / max(seconds, 1e-6))))
                    for kind, content in answers:
                        if kind == "result":
                            yield content
                        elif kind == "raised":
                            raise content
                        else:
                            raise work.error(f"a worker of the cluster cannot begin: {content}")
        finally:
            with suppress(Exception):
                for reference in flying:
                    ray.cancel(reference, force=True)
                if reports is not None:
                    reports.shutdown()

    def _connect(self, where: str | None, ship: bool) -> None:
        options: dict[str, Any] = {"logging_level": "WARNING"}
        if where is None:
            options["include_dashboard"] = False
        else:
            options["address"] = where
        if ship:
            options["runtime_env"] = {"working_dir": str(_staged(Path(self._folder.name)))}
        try:
            self._ray.init(**options)
        except ValueError:
            # An existing cluster has its own setting for the dashboard.
            options.pop("include_dashboard", None)
            self._ray.init(**options)


_works: dict[bytes, Work[Any, Any, Any]] = {}
"""The work loaded in this worker, which runs many tasks of it."""


def _do(
    key: bytes, packed: bytes, folder: str, tasks: list[object], reports: Any
) -> tuple[list[tuple[str, object]], float]:
    """Run tasks in a worker of the cluster, and return their durations [s].

    Exceptions are returned, for Ray would wrap them; one ends the batch.
    """
    # Relative paths are the driver's, not of where the cluster was started; a node need not have its folder.
    with suppress(OSError):
        os.chdir(folder)
    if key not in _works:
        tell_warnings()
        try:
            setup, work = pickle.loads(packed)
            if setup is not None:
                setup()
            _works[key] = pickle.loads(work)
        except Exception as error:
            return [("unknown", f"{type(error).__name__}: {error}")], 0.0
    report = _ignore if reports is None else reports.put
    begun, answers = time.perf_counter(), []
    for task in tasks:
        try:
            answers.append(("result", _works[key].attempt(task, report)))
        except Exception as error:
            error.add_note(f"in a worker of the cluster:\n{traceback.format_exc()}")
            answers.append(("raised", error))
            break
    return answers, time.perf_counter() - begun


def _ignore(message: object) -> None:
    """Drop a report that was not requested."""


def _read(address: str) -> tuple[str | None, float, bool]:
    """Return where the cluster is, the cores of a task, and whether robobt is shipped."""
    where, _, text = address.partition("?")
    if where != "ray" and not where.startswith("ray://"):
        raise ClusterError(f"{address}: an engine is local, ray, or ray://HOST:PORT")
    options = dict(parse_qsl(text, keep_blank_values=True))
    cpus, ship = options.pop("cpus", "1"), options.pop("ship", "yes" if where != "ray" else "no")
    if options:
        raise ClusterError(f"{address}: {next(iter(options))}: there is no such option; there are cpus, ship")
    try:
        cores = float(cpus)
    except ValueError:
        cores = 0.0
    if not 0.0 < cores <= 1024.0:
        raise ClusterError(f"{address}: cpus: is a number of cores above 0, not {cpus!r}")
    if ship not in ("yes", "no"):
        raise ClusterError(f"{address}: ship: is yes or no, not {ship!r}")
    return (None if where == "ray" else where), cores, ship == "yes"


def _staged(folder: Path) -> Path:
    """Copy what nodes need, laid out as in a checkout, and return where.

    A package that is run where it lies, as by ``python -m paper``, is copied too: tasks may be its own.
    """
    packages = {Path(robobt.__file__).resolve().parent}
    program = Path(getattr(sys.modules["__main__"], "__file__", None) or "").resolve()
    if program.name == "__main__.py" and program.parent.parent == Path.cwd():
        packages.add(program.parent)
    for package in packages:
        left_out = shutil.ignore_patterns("__pycache__", "_data")
        shutil.copytree(package, folder / package.name, ignore=left_out)
    shutil.copytree(models_folder(), folder / "models")
    shutil.copytree(scenarios_folder(), folder / "examples" / "scenarios")
    return folder
