"""``robobt bench live``: what viewers cost a match."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.markup import escape

from robobt.cli.common import Bundled, Imports, Json, Seed, errors, import_files, print_json, say


def bench_live(
    scenario: Bundled = "team_v_baseline",
    seconds: Annotated[float, typer.Option("--seconds", min=5, max=3600, help="How long to play.")] = 30.0,
    viewers: Annotated[
        int, typer.Option("--viewers", min=1, max=40, help="Viewers that read all that they are sent.")
    ] = 1,
    seed: Seed = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Measure what viewers cost a match that is played in real time.

    The match is played twice over in turns: alone, and shown to the viewers, to one on a link of
    1 Mbit/s and to one that reads nothing for two thirds of the time.

    Keys of --json: scenario, seed, seconds, viewers, period; loop_share (by how much more
    processor time the match's own thread takes), tick_cpu_ms (of the match alone),
    server_share (processor time of the other threads, by real time), late_alone and
    late_watched (ticks that began more than 5 ms late, of ticks), memory_mib (by how
    much this process has grown), age_median_ms and age_p95_ms (from a tick to a
    viewer's process), slow_age_p95_ms (on the slow link), stalled_age_ms (the oldest
    that the stalled viewer is shown from one second after it reads again),
    stalled_skipped (how often viewers were sent the present instead).
    """
    from robobt.live.bench import bench_live as measure
    from robobt.match import load_scenario
    from robobt.worlds import sim_world

    import_files(imports)
    loaded = load_scenario(scenario)
    with errors.status(f"playing {escape(loaded.name)}"):
        figures = measure(loaded, sim_world, seconds, viewers, seed)
    if as_json:
        print_json(figures)
        return
    say(
        f"{loaded.name}, {seconds:.0f} s, {viewers} viewers: the match's thread takes "
        f"{figures['loop_share']:+.1%} of {figures['tick_cpu_ms']:.2f} ms a tick, the server "
        f"{figures['server_share']:.1%} of a core; late ticks {figures['late_watched']} of "
        f"{figures['ticks']}, alone {figures['late_alone']}; memory {figures['memory_mib']:+.0f} MiB. "
        f"From tick to viewer "
        f"{figures['age_median_ms']} ms in the median, {figures['age_p95_ms']} ms at 95 %, "
        f"{figures['slow_age_p95_ms']} ms on 1 Mbit/s; one that reads again sees what is "
        f"{figures['stalled_age_ms']} ms old at most."
    )
