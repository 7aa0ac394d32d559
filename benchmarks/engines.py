"""What it costs to run tasks on a cluster."""

from __future__ import annotations

from statistics import median
from time import perf_counter
from typing import Annotated

import typer

from robobt.cli import Json, Progress, print_json, say
from robobt.cli.common import Bundled
from robobt.engines import RayEngine, running_on
from robobt.match import load_scenario, run_trials_in
from robobt.worlds import sim_world


def engines(
    scenario: Bundled = "striker_vs_goalkeeper",
    engine: Annotated[str, typer.Option(help="The engine that is compared with local processes.")] = "ray",
    trials: Annotated[int, typer.Option("--trials", "-n", min=2, max=100_000)] = 1000,
    workers: Annotated[int, typer.Option("--workers", "-w", min=2, max=256)] = 2,
    time_limit: Annotated[
        float, typer.Option(min=0.05, max=3600.0, help="Longest trial [s]; short ones show what tasks cost.")
    ] = 1.0,
    repeats: Annotated[int, typer.Option(min=1, max=100, help="How often each engine plays them all.")] = 3,
    as_json: Json = False,
) -> None:
    """Play the same trials on local processes and on another engine, in turns.

    Of each turn the last nine tenths of the trials are timed: local processes are started for each, those of
    a cluster stay. An engine compiles before its first turn, which is not counted.

    Keys of --json: trials, workers, local_s and engine_s (seconds for nine tenths of the trials, medians),
    local_start_s and engine_start_s (until then), overhead (engine over local, less 1), identical (whether
    all trials were the same, bit for bit).
    """

    loaded = load_scenario(scenario).lasting(time_limit)
    times: dict[str, list[tuple[float, float]]] = {"local": [], "engine": []}
    traces = set()

    def turn() -> tuple[float, float]:
        ends = [perf_counter()]
        run = run_trials_in(
            loaded, sim_world, trials, workers, on_result=lambda _: ends.append(perf_counter())
        )
        traces.add(run.summary().trace)
        progress.advance()
        started = ends[trials // 10]
        return started - ends[0], ends[-1] - started

    with RayEngine(engine) as cluster, Progress("engines", 2 * repeats + 1) as progress:
        with running_on(cluster):
            turn()
        for _ in range(repeats):
            times["local"].append(turn())
            with running_on(cluster):
                times["engine"].append(turn())
    figures: dict[str, float] = {"trials": trials, "workers": workers}
    for name, turns in times.items():
        figures[f"{name}_start_s"], figures[f"{name}_s"] = [median(part) for part in zip(*turns, strict=True)]
    local, there = figures["local_s"], figures["engine_s"]
    identical, overhead = len(traces) == 1, there / local - 1.0
    if as_json:
        print_json({**figures, "overhead": overhead, "identical": identical})
        return
    say(
        f"nine tenths of {trials} trials, {workers} at a time: {local:.1f} s on local processes, "
        f"{there:.1f} s on {engine} ({overhead:+.0%}); {'identical' if identical else 'NOT identical'}"
    )
