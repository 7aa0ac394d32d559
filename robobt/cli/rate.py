"""``robobt rate``: how strong the policies of self-play are, against each other, scripts and plays."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import MAX_SEED, Json, console, name_lines, print_json, table
from robobt.cli.scenario_options import PLAY, parse_play


def rate(
    runs: Annotated[
        list[Path], typer.Argument(help="Folders of runs of one task, such as runs/duel/seed_0.")
    ],
    past: Annotated[
        int, typer.Option("--past", min=0, max=64, help="Past selves of each run, spread over it.")
    ] = 5,
    scripts: Annotated[
        list[str] | None,
        typer.Option(
            "--script",
            help="Scripted field players to meet; may be given again. attack and press without a play.",
        ),
    ] = None,
    plays: Annotated[
        list[str] | None,
        typer.Option(
            "--play", metavar=PLAY, help="Robots that a play moves, slowly, to meet; may be given again."
        ),
    ] = None,
    starts: Annotated[
        int,
        typer.Option("--starts", "-n", min=1, max=100_000, help="Fresh starts of each two, on either side."),
    ] = 100,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED, help="Of the starts.")] = 0,
    as_json: Json = False,
) -> None:
    """Let a run's policies, past and best, scripts and plays meet in a round robin, and rate them.

    For tasks in which two teams learn. A goal wins an episode; one without is a draw. Ratings are
    Bradley-Terry's on the Elo scale, 0 their mean.

    Keys of --json: task, starts, seed; ratings (by name: elo, low and high of its 95 % interval, won, drawn,
    lost) and encounters (first, second, starts, won, drawn, lost).
    """
    from robobt.learning.agents.networks import one_thread
    from robobt.learning.training.meetings import contenders_of, encounters, play, script
    from robobt.learning.training.run_folder import read_settings
    from robobt.tournament.ratings import bradley_terry

    # Who is given twice would meet itself.
    default = () if plays else ("attack", "press")
    given = [script(role) for role in dict.fromkeys(scripts or default)]
    given += [play(text, *parse_play(text, "--play")) for text in dict.fromkeys(plays or ())]
    several = list(dict.fromkeys(runs))
    found = [contenders_of(run, past, str(run) if len(several) > 1 else "") for run in several]
    contenders = [*(one for _, policies in found for one in policies), *given]
    with one_thread():
        met = encounters(found[0][0], contenders, starts, seed)
    scores = [(one.first, one.second, score) for one in met for score in one.scores]
    ratings = bradley_terry([one.name for one in contenders], scores)
    counts = {name: [0, 0, 0] for name in ratings}
    for one in met:
        for name, own in (
            (one.first, (one.won, one.drawn, one.lost)),
            (one.second, (one.lost, one.drawn, one.won)),
        ):
            counts[name] = [sum(both) for both in zip(counts[name], own, strict=True)]
    best = sorted(ratings, key=lambda name: -ratings[name].elo)
    if as_json:
        print_json(
            {
                "task": read_settings(runs[0]).task,
                "starts": starts,
                "seed": seed,
                "ratings": {
                    name: asdict(ratings[name])
                    | dict(zip(("won", "drawn", "lost"), counts[name], strict=True))
                    for name in best
                },
                "encounters": [asdict(one) for one in met],
            }
        )
        return
    shown = table("", "Elo", "95 %", "won", "drawn", "lost")
    for name in best:
        rating = ratings[name]
        interval = f"{round(rating.low):+d} to {round(rating.high):+d}"
        shown.add_row(name_lines(name, 42), f"{round(rating.elo):+d}", interval, *map(str, counts[name]))
    console.print(shown)
