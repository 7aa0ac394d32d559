"""Several seeds of one run side by side, and what they come to together."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Callable, Mapping, Sequence
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from pathlib import Path
from statistics import median
from typing import Any

from robobt.config.atomic import write_atomically
from robobt.learning.training.curves import draw_curves
from robobt.learning.training.run_folder import (
    CURVES,
    RESULT,
    Judged,
    RunFolderError,
    TrainResult,
    load_run,
    title_of,
)
from robobt.learning.training.settings import TrainSettings
from robobt.learning.training.train import Progress, TrainError, train

OnProgress = Callable[[Progress], None]

BARS: dict[str, tuple[float, float]] = {"go_to_ball": (0.995, 1.04), "shoot": (0.98, 0.45)}
"""What counts as learned: share of successes, and time over the optimum or, for Shoot, to the kick [s]."""


def train_seeds(
    settings: TrainSettings,
    seeds: Sequence[int],
    out: str | Path,
    workers: int = 1,
    resume: bool = False,
    on_progress: OnProgress | None = None,
) -> list[TrainResult]:
    """Train with every seed, each in a folder ``seed_N`` of its own.

    A seed's result is the same whatever runs beside it. ``result.json`` and
    ``curves.png`` of all seeds together are in ``out`` when the last has ended.

    Args:
        settings: but for the seed.
        seeds: at least one.
        out: the folder.
        workers: processes, of one thread each; 1 is this process itself.
        resume: go on with runs that were cut off, and keep those that have ended.
        on_progress: called now and then, in this process.

    Raises:
        TrainError: a run failed; the message is its own.
        RunFolderError: a folder holds a run already, or another one.
        ValueError: no seeds, or no workers.
    """
    if not seeds or workers < 1:
        raise ValueError(f"needs seeds and workers, not {len(seeds)} and {workers}")
    out = Path(out)
    jobs = [(settings.model_copy(update={"seed": seed}), out / f"seed_{seed}") for seed in seeds]
    if workers == 1 or len(jobs) == 1:
        results = [train(own, folder, resume=resume, on_progress=on_progress) for own, folder in jobs]
    else:
        _side_by_side(jobs, min(workers, len(jobs)), resume, on_progress)
        results = [load_run(folder) for _, folder in jobs]
    text = json.dumps(together(results), indent=2, allow_nan=False) + "\n"
    write_atomically(out / RESULT, text)
    draw_curves({f"seed {r.settings.seed}": r.judged for r in results}, title_of(settings), out / CURVES)
    return results


def together(results: Sequence[TrainResult]) -> dict[str, Any]:
    """Medians and ranges over seeds.

    Returns:
        ``task``, ``preset``, ``seeds``, ``best_seed`` (by the validation starts), ``to_99``
        (CPU seconds and steps to 99 % of the validation starts) and ``to_bar`` (to :data:`BARS`;
        both with ``reached``, how many seeds did, and None where not all did), and the
        spreads (``median``, ``low``, ``high``) of ``success``, ``mean_time`` and ``time_ratio`` on
        the held-out starts, ``steps``, ``cpu_s``, ``evaluation_cpu_s`` and ``wall_s``.
    """
    first = results[0]
    bar = BARS.get(first.settings.task, (0.99, float("inf")))
    told: dict[str, Any] = {
        "task": first.settings.task,
        "preset": first.settings.preset,
        "seeds": [result.settings.seed for result in results],
        "best_seed": max(results, key=lambda result: max(j.score for j in result.judged)).settings.seed,
        "to_99": _to([first_reaching(result.judged, 0.99) for result in results]),
        "to_bar": _to([first_reaching(result.judged, *bar) for result in results]),
    }
    for name in ("success", "mean_time", "time_ratio"):
        told[name] = _spread([result.figures["held_out"][name] for result in results])
    for name in ("steps", "cpu_s", "evaluation_cpu_s", "wall_s"):
        told[name] = _spread([result.figures[name] for result in results])
    return told


def first_reaching(judged: Sequence[Judged], success: float, time: float = float("inf")) -> Judged | None:
    """The first evaluation with that share of successes in that time (over the optimum where known)."""
    for each in judged:
        taken = each.mean_time if each.time_ratio is None else each.time_ratio
        if each.success >= success and taken is not None and taken <= time:
            return each
    return None


def _to(reached: Sequence[Judged | None]) -> dict[str, Any]:
    known = [each for each in reached if each is not None]
    whole = len(known) == len(reached)
    return {
        "reached": len(known),
        "cpu_s": _spread([each.cpu_s for each in known]) if whole else None,
        "steps": _spread([each.steps for each in known]) if whole else None,
    }


def _spread(values: Sequence[float | None]) -> dict[str, float] | None:
    known = [value for value in values if value is not None]
    if not known:
        return None
    return {"median": median(known), "low": min(known), "high": max(known)}


def _side_by_side(
    jobs: Sequence[tuple[TrainSettings, Path]], workers: int, resume: bool, on_progress: OnProgress | None
) -> None:
    context = get_context("spawn")
    waiting = list(jobs)
    running: dict[Connection, Any] = {}
    try:
        while waiting or running:
            while waiting and len(running) < workers:
                settings, folder = waiting.pop(0)
                ours, theirs = context.Pipe(duplex=False)
                process = context.Process(target=_work, args=(settings, folder, resume, theirs), daemon=True)
                process.start()
                theirs.close()
                running[ours] = process
            for ready in wait(list(running)):
                assert isinstance(ready, Connection)
                try:
                    said = ready.recv()
                except EOFError:
                    process = running.pop(ready)
                    process.join()
                    if process.exitcode:
                        raise TrainError(f"a worker died with exit code {process.exitcode}") from None
                    continue
                if isinstance(said, Exception):
                    raise said
                if on_progress is not None:
                    on_progress(said)
    finally:
        for process in running.values():
            process.terminate()
            process.join()


def _work(settings: TrainSettings, folder: Path, resume: bool, back: Connection) -> None:
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        train(settings, folder, resume=resume, on_progress=back.send)
    except KeyboardInterrupt:
        return
    except (RunFolderError, TrainError) as error:
        back.send(error)
    except Exception as error:
        back.send(TrainError(f"seed {settings.seed}: {type(error).__name__}: {error}"))
    finally:
        back.close()


def _end_with_parent() -> None:
    """A worker whose parent was killed has nobody to work for; its checkpoint is on disk."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def figures_of(results: Sequence[TrainResult]) -> dict[str, Any]:
    """What the command prints for machines: every seed's figures, and :func:`together`."""
    runs: list[Mapping[str, Any]] = [{**r.figures, "folder": str(r.folder)} for r in results]
    return {"runs": runs, "together": together(results)}
