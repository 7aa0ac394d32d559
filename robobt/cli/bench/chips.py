"""``robobt bench chips``: measure how the filter sees chips."""

from __future__ import annotations

from typing import Annotated

import typer

from robobt.cli.common import MAX_SEED, Json, console, errors, print_json, say, table


def bench_chips(
    preset: Annotated[str, typer.Option("--preset", help="Of the simulator.")] = "default",
    realism: Annotated[
        str, typer.Option("--realism", help="none, friendly, rc2021 or realistic.")
    ] = "realistic",
    cameras: Annotated[
        int, typer.Option("--cameras", min=1, max=16, help="Cameras that share the field.")
    ] = 1,
    chips: Annotated[int, typer.Option("--chips", min=1, max=100_000, help="Chips to make.")] = 500,
    flat: Annotated[int, typer.Option("--flat", min=1, max=100_000, help="Flat kicks to make.")] = 500,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    as_json: Json = False,
) -> None:
    """Measure how the filter tells chips from flat kicks and predicts where they touch down.

    Kicks at 2.5 to 6.2 m/s by a robot that drives at a resting ball, five others about, no command known.
    A prediction is where the ball touches down from what a frame shows of it.

    Keys of --json: preset, realism, cameras, seed; chips (that touched down on the field, untouched),
    recognised; landing_error, by the share of the flight from which on the first prediction is taken: n,
    p50, p90, p95, p99 (m); flat, taken_for_chips.
    """
    from robobt.league.bench_chips import bench_chips as measure
    from robobt.sim import settings_from

    with errors.status("kicking"):
        settings = settings_from({"preset": preset, "realism": realism})
        figures = measure(settings, chips, flat, seed, cameras)
    if as_json:
        print_json({"preset": preset, "realism": realism, "cameras": cameras, "seed": seed, **figures})
        return
    say(
        f"{figures['recognised']} of {figures['chips']} chips recognised, "
        f"{figures['taken_for_chips']} of {figures['flat']} flat kicks taken for chips."
    )
    listed = table("from, of the flight", "chips", "50 %", "90 %", "95 %", "99 % within, m")
    for share, error in figures["landing_error"].items():
        values = [f"{error[name]:.3f}" if name in error else "-" for name in ("p50", "p90", "p95", "p99")]
        listed.add_row(f"{float(share):.0%}", str(error["n"]), *values)
    console.print(listed)
