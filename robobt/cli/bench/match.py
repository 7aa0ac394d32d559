"""``robobt bench match``: measures a whole match."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.markup import escape

from robobt.cli.common import Bundled, Imports, Json, Seed, errors, import_files, print_json, say


def bench_match(
    scenario: Bundled = "team_v_baseline",
    seconds: Annotated[
        float, typer.Option("--seconds", min=1, max=3600, help="Simulated time to play.")
    ] = 60.0,
    seed: Seed = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Measure a whole match on one core: every robot's tree, the physics and the recording.

    The match is played three times over in turns: recorded, unrecorded, and
    with the trees ticked by py_trees itself. Before that it is played once that
    does not count, in which code is compiled and models are loaded.

    Keys of --json: scenario, seed, robots (how many), period, simulated_s,
    wall_s and cpu_s (of the recorded match), real_time_factor and
    real_time_factor_cpu (of it, by either), real_time_factor_unrecorded,
    real_time_factor_py_trees (unrecorded), speedup_vs_py_trees,
    recording_share (of the recorded match's time), referee_share (of
    the unrecorded match's time), in_play (share of the time with the ball in
    play), ticks, errors (ticks a tree failed).
    """
    from robobt.match import load_scenario
    from robobt.match.bench import bench_match as measure
    from robobt.worlds import sim_world

    import_files(imports)
    loaded = load_scenario(scenario)
    with errors.status(f"playing {escape(loaded.name)}"):
        figures = measure(loaded, sim_world, seconds, seed)
    if as_json:
        print_json(figures)
        return
    say(
        f"{loaded.name}: {figures['simulated_s']:.1f} s of {figures['robots']} robots at "
        f"{1 / loaded.period:.0f} Hz in {figures['wall_s']:.2f} s: "
        f"{figures['real_time_factor']:.1f} times real time, {figures['real_time_factor_cpu']:.1f} times by "
        f"processor time, of which recording takes "
        f"{figures['recording_share']:.1%} and the referee {figures['referee_share']:.1%}; "
        f"ball in play {figures['in_play']:.0%} of the time. "
        f"With py_trees' own ticking {figures['real_time_factor_py_trees']:.1f} times real time."
    )
