"""``python -m paper goalkeepers``: the goalkeepers behind recorded shots."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robobt.cli import MAX_SEED, Json, Progress, make_folders, print_json, say


def goalkeepers(
    data: Annotated[
        Path,
        typer.Option("--data", help="Folder with the author's train.csv, or a file of recorded shots."),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="File to write the population to (.yaml).")
    ] = None,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED, help="Of the folds.")] = 0,
    force: Annotated[bool, typer.Option("--force", help="Write over a file that is there.")] = False,
    as_json: Json = False,
) -> None:
    """Fit a population of goalkeepers to recorded shots, for 'robobt shots collect --goalkeepers'.

    Each shot is played again from where everybody was at the kick, as a race of ball and goalkeeper.
    The population that makes the recorded outcomes likeliest is printed, with how well it predicts shots
    that it was not fitted to. Of the author's shots only the training set is used.

    Keys of --json: population, shots, base_rate, predicted, figures (accuracy, log_loss,
    calibration_error), by_distance and by_angle (low, high, shots, goals, predicted).
    """
    from dataclasses import asdict

    from paper.goalkeepers import explain, shots_to_fit
    from robobt.shots import FOLDS, ShotDataError

    if out is not None and out.exists() and not force:
        raise ShotDataError(f"{out}: is there already; give another --out, or --force")
    make_folders({"--out": out})
    table = shots_to_fit(data)
    with Progress("fits", FOLDS + 1) as progress:
        found = explain(table, seed, progress.advance)
    if out is not None:
        found.population.write(out)
    if as_json:
        figures = {name: figure.model_dump() for name, figure in found.figures.items()}
        bins = {"by_distance": found.by_distance, "by_angle": found.by_angle}
        print_json(
            {
                "population": found.population.model_dump(),
                "shots": found.shots,
                "base_rate": found.base_rate,
                "predicted": found.predicted,
                "figures": figures,
                **{name: [asdict(one) for one in rows] for name, rows in bins.items()},
            }
        )
        return
    for name, value in found.population.model_dump().items():
        say(f"{name}: {value:.3g}")
    say(
        f"{found.shots} shots, cross-validated: {found.base_rate:.1%} scored, "
        f"{found.predicted:.1%} predicted."
    )
    for name, figure in found.figures.items():
        say(f"{name}: {figure.value:.3f} ({figure.low:.3f} to {figure.high:.3f}, {figure.interval})")
    for title, unit, rows in (("target", "m", found.by_distance), ("angle", "rad", found.by_angle)):
        for one in rows:
            say(
                f"{title} {one.low:g} to {one.high:g} {unit}: {one.shots} shots, {one.goals} goals, "
                f"{one.predicted:.1f} predicted"
            )
