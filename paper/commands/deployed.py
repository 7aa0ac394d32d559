"""``python -m paper deployed``: attackers with and without a learned veto."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli import (
    MAX_SEED,
    Json,
    Progress,
    Where,
    Workers,
    console,
    cores,
    make_folders,
    one_of,
    print_json,
    say,
    table,
    world_of,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from paper.deployed import Attacker, Situation


@dataclass(frozen=True)
class Faced:
    """Whom the attackers face, and from where."""

    goalkeeper: Annotated[
        list[str] | None,
        typer.Option("--goalkeeper", help="default, or robobulls: the paper's pilot. Both by default."),
    ] = None
    starts: Annotated[
        list[str] | None,
        typer.Option("--starts", help="'own half', or '2.5 to 4.5 m' from the goal. Both by default."),
    ] = None
    defenders: Annotated[
        list[int] | None,
        typer.Option("--defenders", min=0, max=2, help="Besides the goalkeeper. 0, 1 and 2 by default."),
    ] = None

    def situations(self) -> list[Situation]:
        """Return the situations that these options leave."""
        from paper.deployed import GOALKEEPERS, SITUATIONS, STARTS

        one_of(self.goalkeeper or [], GOALKEEPERS, "--goalkeeper")
        one_of(self.starts or [], STARTS, "--starts")
        left = [
            one
            for one in SITUATIONS
            if one.goalkeeper in (self.goalkeeper or GOALKEEPERS)
            and one.starts in (self.starts or STARTS)
            and one.defenders in (self.defenders or (0, 1, 2))
        ]
        if not left:
            options = "--goalkeeper, --starts, --defenders"
            raise typer.BadParameter("leave nothing to play", param_hint=options)
        return left


def deployed(
    shots: Annotated[
        int, typer.Option("--shots", "-n", min=1, max=100_000, help="Trials of every play and speed.")
    ] = 100,
    seed: Annotated[
        int | None,
        typer.Option("--seed", "-s", min=0, max=MAX_SEED, help="By default the one nothing was tuned on."),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option("--only", help="An attacker by its name; may be given often. All by default."),
    ] = None,
    *,
    faced: Faced,
    workers: Workers = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FOLDER",
            help="Keep the trials here as they finish: the command, given again, goes on where it stopped.",
        ),
    ] = None,
    picture: Annotated[
        Path | None,
        typer.Option(
            "--picture", help="Draw the goal line as judged at attack_expected's first shot (.png)."
        ),
    ] = None,
    world: Where = "sim",
    as_json: Json = False,
) -> None:
    """Attackers against a goalkeeper at half and full speed, part by part, and against defenders.

    From Attack Main to AttackNN one step at a time: its clearance ("wide"), the network, the
    feint. All face the same starts with the same seeds, in the paper's situations and, with
    10 s to score, against one and two defenders more.

    Keys of --json: shots, seed; cells, a list with goalkeeper, speed, starts, defenders and
    attackers, by name: goals, rate with its 95 % Wilson interval (low, high; interval as
    text), attempts (trials with a shot), distinct (trials that differ), outcomes,
    time_to_shot (seconds), waiting (how many seconds longer than the first attacker from the
    same start), errors, against_first and against_half_speed (McNemar: only_this, only_other, p),
    paper (goals, shots).
    """
    from paper.deployed import ATTACKERS, SEED
    from paper.deployed import deployed as run
    from paper.judged_goal_line import judged_goal_line
    from robobt.worlds import SIM

    one_of(only or [], ATTACKERS, "--only")
    situations = faced.situations()
    attackers = tuple(only or ATTACKERS)
    used = SEED if seed is None else seed
    if world != SIM and workers not in (None, 1):
        raise typer.BadParameter("must be 1 to play over the network", param_hint="--workers")
    make_folders({"--out": out, "--picture": picture})
    processes = workers or (cores() if world == SIM else 1)
    total = len(situations) * len(attackers) * shots
    with Progress("deployed", total) as progress, world_of(world) as factory:
        result = run(
            shots,
            used,
            processes,
            situations=situations,
            attackers=attackers,
            progress=progress.advance,
            world=factory,
            out=out,
        )
        if picture is not None:
            judged_goal_line(situations[0], used, picture, factory)
    if as_json:
        print_json(result)
        return
    for situation, cell in zip(situations, result["cells"], strict=True):
        _print(str(situation), cell["attackers"], shots)
    if picture is not None:
        say(f"The judged goal line: {picture}")


def _print(title: str, attackers: Mapping[str, Attacker], shots: int) -> None:
    say(title)
    listed = table("attacker", "paper", "goals", "95 %", "shots", "to the shot", "p half")
    for name, one in attackers.items():
        paper, time, slower = one["paper"], one["time_to_shot"], one["against_half_speed"]
        listed.add_row(
            name,
            "-" if paper is None else f"{paper['goals']} / {paper['shots']}",
            f"{one['goals']} / {shots}",
            one["interval"],
            str(one["attempts"]),
            "-" if time is None else f"{time:.2f} s",
            "-" if slower is None else f"{slower['p']:.2g}",
        )
    console.print(listed)
