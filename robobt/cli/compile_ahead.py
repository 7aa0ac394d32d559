"""Compile what a first match needs, in several processes: ``python -m robobt.cli.compile_ahead``.

``make`` does so after an installation, and ``robobt match`` where nothing is compiled yet.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import Progress, cores, log, one_line_errors
from robobt.cli.options import option
from robobt.config.compiling import COMPILING_TOLD
from robobt.config.errors import RobobtError

LINES = Path(__file__).with_name("compiled_ahead.txt")
"""The functions that a match calls, and then those of training, a line each.

``python -m benchmarks first_run --write`` makes it.
"""

TRAINING = "[training]"
"""The line before the functions of training."""


def compile_ahead(training: bool = False, workers: int | None = None) -> None:
    """Compile the functions of a match that are not kept yet, with a progress bar.

    Args:
        training: whether to compile those of training too.
        workers: number of processes; by default one for each core.

    Raises:
        RobobtError: a function cannot be compiled.
    """
    from robobt.engines.run import run_tasks
    from robobt.engines.work import Work

    groups = _groups(LINES.read_text("utf-8"), training)
    # The bar says it.
    os.environ[COMPILING_TOLD] = "1"
    work = Work(do=_compile, noun="functions", error=RobobtError)
    with Progress("compiling for this machine, once", sum(map(len, groups))) as progress:
        # A worker's garbage goes with it; to look for it takes 3 % of the time.
        tasks = run_tasks(
            work, groups, workers or cores(), setup=gc.disable, on_report=lambda _: progress.advance()
        )
        for _ in tasks:
            pass


def compile_before_first_match() -> None:
    """Compile ahead if nothing is kept of the simulator's step, and several cores can share the work."""
    from robobt.config.compiling import compiles
    from robobt.sim.kernels import control_tick
    from robobt.world.compiled_ahead import is_kept

    if not compiles() or is_kept(control_tick) or cores() < 2:
        return
    log.info("compiling for this machine, once")
    compile_ahead()


def _groups(text: str, training: bool) -> list[tuple[str, ...]]:
    """Return the lines by folder, from behind: a process that compiles keeps others out of its folder.

    What Python and compiled code both call is compiled once if that for Python comes first.
    """
    match, _, rest = text.partition(f"{TRAINING}\n")
    groups: dict[str, list[str]] = {}
    for line in (match + rest if training else match).splitlines():
        groups.setdefault(line.partition(":")[0].rpartition(".")[0], []).append(line)
    return [tuple(lines[::-1]) for lines in groups.values()]


def _compile(lines: tuple[str, ...], report: Callable[[str], None]) -> None:
    from robobt.world.compiled_ahead import compile_line

    for line in lines:
        # Of an extra that is not installed.
        with suppress(ModuleNotFoundError):
            compile_line(line)
        report(line)


def main(
    training: Annotated[bool, typer.Option("--training", help="What training needs too.")] = False,
    workers: Annotated[int | None, option("--workers", min=1, max=256)] = None,
) -> None:
    """Compile what a first match needs, once, for this machine."""
    compile_ahead(training, workers)


if __name__ == "__main__":
    typer.run(one_line_errors(main))
