"""``robobt paper deployed``: attackers with and without a learned veto."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import (
    MAX_SEED,
    Json,
    Progress,
    Where,
    Workers,
    console,
    cores,
    print_json,
    say,
    table,
    world_of,
)

if TYPE_CHECKING:
    from robobt.experiments.deployed import Deployed


class Style(StrEnum):
    """How the goalkeeper moves."""

    DEFAULT = "default"
    ROBOBULLS = "robobulls"


def deployed(
    shots: Annotated[
        int, typer.Option("--shots", "-n", min=1, max=100_000, help="Trials of every play and speed.")
    ] = 100,
    seed: Annotated[
        int | None,
        typer.Option("--seed", "-s", min=0, max=MAX_SEED, help="By default the one nothing was tuned on."),
    ] = None,
    goalkeeper: Annotated[
        Style, typer.Option("--goalkeeper", help="default, or robobulls for the paper's own pilot.")
    ] = Style.DEFAULT,
    workers: Workers = None,
    picture: Annotated[
        Path | None,
        typer.Option(
            "--picture", help="Draw the goal line as judged at attack_expected's first shot (.png)."
        ),
    ] = None,
    world: Where = "sim",
    as_json: Json = False,
) -> None:
    """Attack Main, AttackNN and Attack Expected against the goalkeeper at half and full speed.

    Every play is given the same starts and seeds.

    Keys of --json: shots, seed, goalkeeper; speeds, by half and full and then by
    play: goals, rate with its 95 % Wilson interval (low, high) and the exact one
    (exact_low, exact_high), attempts (trials with a shot), outcomes, time_to_shot
    [s], waiting (how much longer than attack_main from the same start [s]), errors,
    mcnemar (against attack_main: only_this, only_first_play, p), paper (goals, shots).
    """
    from robobt.experiments.deployed import PLAYED, SEED, judged_goal_line
    from robobt.experiments.deployed import deployed as run
    from robobt.worlds import SIM

    used = SEED if seed is None else seed
    if world != SIM and workers not in (None, 1):
        raise typer.BadParameter("must be 1 to play over the network", param_hint="--workers")
    processes = workers or (cores() if world == SIM else 1)
    with Progress("deployed", 2 * len(PLAYED) * shots) as progress, world_of(world) as factory:
        result = run(
            shots, used, processes, goalkeeper=goalkeeper.value, progress=progress.advance, world=factory
        )
        if picture is not None:
            judged_goal_line("half", used, picture, goalkeeper.value, factory)
    if as_json:
        print_json(result)
        return
    _print(result)
    if picture is not None:
        say(f"The judged goal line: {picture}")


def _print(result: Deployed) -> None:
    for speed, plays in result["speeds"].items():
        listed = table(
            f"goalkeeper at {speed} speed",
            "paper",
            "goals",
            "95 % interval",
            "shots",
            "to the shot",
            "waiting",
        )
        for play, one in plays.items():
            paper, time, waiting = one["paper"], one["time_to_shot"], one["waiting"]
            listed.add_row(
                play,
                "-" if paper is None else f"{paper['goals']} / {paper['shots']}",
                f"{one['goals']} / {result['shots']}",
                f"{one['low']:.0%} to {one['high']:.0%}",
                str(one["attempts"]),
                "-" if time is None else f"{time:.2f} s",
                "-" if waiting is None else f"{waiting:+.2f} s",
            )
        console.print(listed)
