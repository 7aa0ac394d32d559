"""``robobt shots collect``: shots for the predictors to learn from."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import MAX_SEED, Json, Progress, Workers, cores, errors, print_json, say
from robobt.cli.options import option
from robobt.cli.outputs import make_folders
from robobt.config.wording import counted


class Attack(StrEnum):
    """How the attacker comes to shoot."""

    MOTION = "motion"
    STILL = "still"
    BOTH = "both"


class Protocol(StrEnum):
    """Which shots are taken."""

    BALANCED = "balanced"
    PAPER = "paper"


def collect(
    count: Annotated[
        int | None, option("--count", "; by default 1000, the paper's protocol 743", min=1, max=10_000_000)
    ] = None,
    attack: Annotated[Attack, option("--attack")] = Attack.BOTH,
    protocol: Annotated[
        Protocol,
        option(
            "--protocol",
            ": balanced ones, evenly over range, angle and goalkeeper offset, at any point of the goal; or "
            "the paper's, those that Attack Main takes, 542 to train and 201 to test",
        ),
    ] = Protocol.BALANCED,
    opponents: Annotated[
        int, option("--opponents", "; half of the shots face the goalkeeper alone", min=1, max=6)
    ] = 1,
    goalkeepers: Annotated[
        str,
        option(
            "--goalkeepers",
            ": own is ours, at half and at full speed; robobulls drives with RoboBulls' pilot; real are "
            "those fitted to the paper's real shots; or a file of 'python -m paper goalkeepers'",
        ),
    ] = "own",
    workers: Workers = None,
    seed: Annotated[int, option("--seed", min=0, max=MAX_SEED)] = 1,
    out: Annotated[Path, option("--out", " the shots (.parquet or .csv)", metavar="FILE")] = Path(
        "shots.parquet"
    ),
    as_json: Json = False,
) -> None:
    """Play the paper's collection scenarios and write one row a shot, as the kick goes out.

    A collection that is stopped, in whatever way, keeps every finished shot; the
    same command continues it. The same settings give the same shots with any
    number of workers. Beside the file lies a description of its columns (.json).

    Keys of --json: out, shots, goals, success_rate, new, simulated_s, wall_s,
    real_time_factor, interrupted.
    """
    from robobt.shots.collect.balanced import ROBOBULLS_GOALKEEPER
    from robobt.shots.collect.collect import PAPER_COUNT, collect_shots
    from robobt.shots.collect.plan import CollectionSettings
    from robobt.shots.keepers.population import REAL, read_population

    population = None
    if goalkeepers == "robobulls" and not Path(ROBOBULLS_GOALKEEPER.partition(":")[0]).is_file():
        there = "robobulls is played in a clone of the repository: run this in its folder"
        raise typer.BadParameter(there, param_hint="--goalkeepers")
    if goalkeepers not in ("own", "robobulls"):
        file = REAL if goalkeepers == "real" else Path(goalkeepers)
        if not file.exists():
            there = f"is own, robobulls, real or a file, and there is no file {goalkeepers!r}"
            raise typer.BadParameter(there, param_hint="--goalkeepers")
        population = read_population(file)
    settings = CollectionSettings(
        scenario=attack.value,
        protocol=protocol.value,
        opponents=opponents,
        seed=seed,
        goalkeepers=population,
        style="robobulls" if goalkeepers == "robobulls" else "default",
    )
    make_folders({"--out": out})
    total = count or (PAPER_COUNT if protocol is Protocol.PAPER else 1000)
    with Progress("shots", total) as progress:
        done = collect_shots(settings, out, total, workers or cores(), progress.advance)
    figures = {
        "out": str(out),
        "shots": done.shots,
        "goals": done.goals,
        "success_rate": done.goals / done.shots if done.shots else 0.0,
        "new": done.new,
        "simulated_s": done.simulated,
        "wall_s": done.wall,
        "real_time_factor": done.real_time_factor,
        "interrupted": done.interrupted,
    }
    if as_json:
        print_json(figures)
    else:
        speed = f", {done.real_time_factor:.0f} times real time" if done.new else ""
        say(
            f"{counted(done.shots, 'shot')}, {counted(done.goals, 'goal')} ({figures['success_rate']:.1%}), "
            f"{done.new} of them new{speed}, in {out}."
        )
    if done.interrupted:
        errors.print("stopped; the same command continues it", soft_wrap=True)
        raise typer.Exit(130)
