"""``robobt bench env``: measures the training environments."""

from __future__ import annotations

from typing import Annotated

import typer

from robobt.cli.common import Json, console, errors, one_line_errors, print_json, table


def add_to(bench: typer.Typer) -> None:
    """Enter the command."""
    bench.command("env")(bench_env)


@one_line_errors
def bench_env(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each figure.")
    ] = 2.0,
    as_json: Json = False,
) -> None:
    """Measure the training environments: steps a second of CPU time, 30 ms control, 4 physics steps.

    Observations, rewards, walls, ball contacts and new starts are in the time.

    Keys of --json, steps a second: go_to_ball_vector and shoot_vector (256
    arenas), ..._vector_64, ..._single (one arena) and ..._gymnasium (one
    environment of gymnasium.make); and ..._physics_share, the part of a vector
    step that the physics alone takes.
    """
    from robobt.learning.bench import SIZES
    from robobt.learning.bench import bench_env as measure

    with errors.status("measuring the environments"):
        figures = measure(seconds=seconds)
    if as_json:
        print_json(figures)
        return
    sizes = {**{end: f"{arenas} arenas" for end, arenas in SIZES.items()}, "gymnasium": "gymnasium.make"}
    listed = table("steps/s", *sizes.values(), "physics")
    for task in ("go_to_ball", "shoot"):
        speeds = [f"{figures[f'{task}_{end}']:,.0f}" for end in sizes]
        listed.add_row(task.replace("_", " "), *speeds, f"{figures[f'{task}_physics_share']:.0%}")
    console.print(listed)
