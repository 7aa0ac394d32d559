"""``robobt bench engines``: what it costs to run tasks on a cluster."""

from __future__ import annotations

from statistics import median
from time import perf_counter
from typing import Annotated

import typer

from robobt.cli.common import Bundled, Json, Progress, print_json, say


def bench_engines(
    scenario: Bundled = "striker_vs_goalie",
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

    An engine starts its workers and compiles before its first turn, which is not counted.

    Keys of --json: trials, workers, local_s and engine_s (seconds for all trials, medians), overhead (engine
    over local, less 1), identical (whether all trials were the same, bit for bit).
    """
    from robobt.engines.cluster import RayEngine
    from robobt.engines.run import running_on
    from robobt.match import load_scenario, run_trials
    from robobt.worlds import sim_world

    loaded = load_scenario(scenario).lasting(time_limit)
    times: dict[str, list[float]] = {"local": [], "engine": []}
    traces = set()

    def turn(count: int) -> float:
        begun = perf_counter()
        traces.add((count, run_trials(loaded, sim_world, count, workers).summary().trace))
        progress.advance()
        return perf_counter() - begun

    with RayEngine(engine) as cluster, Progress("engines", 2 * repeats + 1) as progress:
        with running_on(cluster):
            turn(trials)
        for _ in range(repeats):
            times["local"].append(turn(trials))
            with running_on(cluster):
                times["engine"].append(turn(trials))
    local, there = median(times["local"]), median(times["engine"])
    figures = {"trials": trials, "workers": workers, "local_s": local, "engine_s": there}
    identical, overhead = len(traces) == 1, there / local - 1.0
    if as_json:
        print_json({**figures, "overhead": overhead, "identical": identical})
        return
    say(
        f"{trials} trials, {workers} at a time: {local:.1f} s on local processes, {there:.1f} s on {engine} "
        f"({overhead:+.0%}); {'identical' if identical else 'NOT identical'}"
    )
