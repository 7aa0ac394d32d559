"""How often a sequential test errs, and how long it takes."""

from __future__ import annotations

from typing import Annotated

import numpy as np
import typer

from benchmarks.simulated_tests import simulate
from robobt.cli import MAX_SEED, Json, Progress, console, print_json, say, table
from robobt.config.extras import need
from robobt.tournament.sequential import SequentialTest


def sprt(
    bounds: Annotated[
        tuple[float, float], typer.Option("--sprt", metavar="ELO0 ELO1", help="The test that is judged.")
    ] = (0.0, 30.0),
    elo: Annotated[
        list[float] | None,
        typer.Option("--elo", help="By how much the entrant is really stronger; may be given often."),
    ] = None,
    alpha: Annotated[float, typer.Option(min=1e-6, max=0.49)] = 0.05,
    beta: Annotated[float, typer.Option(min=1e-6, max=0.49)] = 0.05,
    tests: Annotated[int, typer.Option(min=1, max=100_000, help="Tests of each strength.")] = 2000,
    rounds: Annotated[
        int,
        typer.Option(min=1, max=100_000, help="Rounds, of two matches, after which a test is given up."),
    ] = 5000,
    draws: Annotated[float, typer.Option(min=0.0, max=0.9, help="Share of draws between equals.")] = 0.25,
    spread: Annotated[
        float,
        typer.Option(min=0.0, max=1000.0, help="Deviation of what starts are worth to a side [Elo]."),
    ] = 100.0,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 1,
    as_json: Json = False,
) -> None:
    """Simulate sequential tests of entrants of known strength, without playing a match.

    Keys of --json: elo0, elo1, alpha, beta, draws, spread, seed, rounds (the cap); strengths, for each elo,
    tests, better and not_better (how often it said so), better_interval and not_better_interval (95 %),
    mean_rounds and median_rounds.
    """

    need("tournament", "scipy")

    if not bounds[0] < bounds[1]:
        raise typer.BadParameter("ELO0 must be below ELO1", param_hint="--sprt")
    test = SequentialTest(*bounds, alpha, beta)
    found = []
    strengths = elo or [0.0, 15.0, 30.0, 60.0]
    with Progress("sequential tests", len(strengths)) as progress:
        for number, strength in enumerate(strengths):
            rng = np.random.default_rng([seed, number])
            found.append(simulate(test, strength, tests, rounds, rng, draws, spread))
            progress.advance()
    if as_json:
        asked = {"elo0": test.elo0, "elo1": test.elo1, "alpha": alpha, "beta": beta}
        print_json(
            {**asked, "draws": draws, "spread": spread, "seed": seed, "rounds": rounds, "strengths": found}
        )
        return
    say(
        f"Sequential test of {test.elo0:g} against {test.elo1:g} Elo, alpha {alpha:g}, beta {beta:g}; "
        f"{tests} tests each, draws {draws:.0%}, spread of starts {spread:g} Elo, seed {seed}"
    )
    listed = table("Elo", "better", "95 %", "not better", "95 %", "undecided", "mean rounds", "median")
    for one in found:
        listed.add_row(
            f"{one.elo:+g}",
            f"{one.better / one.tests:.1%}",
            f"{one.better_interval.low:.1%} to {one.better_interval.high:.1%}",
            f"{one.not_better / one.tests:.1%}",
            f"{one.not_better_interval.low:.1%} to {one.not_better_interval.high:.1%}",
            str(one.tests - one.better - one.not_better),
            f"{one.mean_rounds:.0f}",
            f"{one.median_rounds:.0f}",
        )
    console.print(listed)
