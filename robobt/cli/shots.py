"""``robobt shots``: train the shipped shot predictors, and draw what they think of the field."""

from __future__ import annotations

from enum import StrEnum
from math import isnan
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import MAX_SEED, Json, Progress, print_json, say


class Model(StrEnum):
    """The shipped predictors."""

    NN = "shot_nn"
    EXPECTED = "shot_expected"


def train(
    data: Annotated[
        list[Path], typer.Option("--data", help="Shots of 'robobt collect shots'; may be given again.")
    ],
    model: Annotated[Model, typer.Option("--model", help="Which of the shipped predictors.")],
    out: Annotated[Path, typer.Option("--out", "-o", help="The folder to write it to.")] = Path("models"),
    epochs: Annotated[int, typer.Option("--epochs", min=1, max=10_000, help="Of shot_expected.")] = 40,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED, help="Of the training.")] = 0,
    as_json: Json = False,
) -> None:
    """Train a shot predictor on shots of our own and write it with its model card.

    A tenth of the shots is held out and measured on.

    Keys of --json: file, shots (held out), accuracy, log_loss, calibration_error.
    """
    import pyarrow as pa
    import torch

    from robobt.shots.data.files import read_shots
    from robobt.shots.predict.shipped import train_shipped

    torch.set_num_threads(1)
    table = pa.concat_tables([read_shots(file) for file in data])
    with Progress(model.value, epochs) as progress:
        file, figures = train_shipped(
            model.value, table, out, seed=seed, epochs=epochs, on_epoch=lambda _: progress.advance()
        )
    if as_json:
        print_json(
            {
                "file": str(file),
                "shots": figures.shots,
                "accuracy": figures.accuracy,
                "log_loss": figures.log_loss,
                "calibration_error": figures.calibration_error,
            }
        )
        return
    say(
        f"{file}: on {figures.shots} shots that training never saw {figures.accuracy:.2%} right, log-loss "
        f"{figures.log_loss:.3f}, calibration error {figures.calibration_error:.3f}."
    )


def draw(
    picture: Annotated[Path, typer.Option("--picture", "-o", help="The picture to write (.png).")] = Path(
        "goal_map.png"
    ),
    model: Annotated[
        str, typer.Option("--model", help="Predictor of a shot's scene: a shipped model or a file.")
    ] = "shot_expected",
    spacing: Annotated[float, typer.Option("--spacing", min=0.02, max=1.0, help="Between places [m].")] = 0.1,
    as_json: Json = False,
) -> None:
    """Draw the probability of a goal from everywhere in the opponents' half.

    For a shooter at rest with the ball and a goalkeeper that covers the angle.

    Keys of --json: picture, x, y (coordinates of the grid [m]) and probability, a
    row for each y, null where nobody may shoot from.
    """
    from robobt.experiments.goal_map import draw_goal_map, goal_map

    found = goal_map(model, spacing)
    draw_goal_map(found, picture)
    if as_json:
        rows = [[None if isnan(p) else p for p in row] for row in found.probability.tolist()]
        print_json(
            {"picture": str(picture), "x": found.x.tolist(), "y": found.y.tolist(), "probability": rows}
        )
        return
    say(f"Map of the goal probability: {picture}")
