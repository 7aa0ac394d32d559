"""``robobt bench sim``: measures the simulator."""

from __future__ import annotations

from typing import Annotated

import typer

from robobt.cli.common import Json, console, errors, one_line_errors, print_json, table


def add_to(bench: typer.Typer) -> None:
    """Enter the command."""
    bench.command("sim")(bench_sim)


@one_line_errors
def bench_sim(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each case.")
    ] = 4.0,
    as_json: Json = False,
) -> None:
    """Measure the simulator: control steps a second with frames and commands, 25 ms control.

    Keys of --json: one_v_one, six_v_six and eleven_v_eleven, each with
    steps_per_s, bare_steps_per_s (the same space stepped by pymunk alone),
    bare_ratio (time of a step over that of a bare one) and contacts_per_s
    (how often the ball meets robots, a simulated second).
    """
    from robobt.sim.bench import bench_sim as measure

    with errors.status("measuring the simulator"):
        figures = measure(seconds=seconds)
    if as_json:
        print_json(figures)
        return
    listed = table("case", "steps/s", "bare steps/s", "ratio to bare")
    for case, figure in figures.items():
        listed.add_row(
            case.replace("_", " "),
            f"{figure['steps_per_s']:,.0f}",
            f"{figure['bare_steps_per_s']:,.0f}",
            f"{figure['bare_ratio']:.2f}",
        )
    console.print(listed)
