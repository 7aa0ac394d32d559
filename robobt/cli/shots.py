"""``robobt shots``: train shot predictors, judge them, and draw what they think of the field."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from robobt.cli.common import MAX_SEED, Json, Progress, print_json, say, warn
from robobt.cli.options import option
from robobt.cli.outputs import make_folders
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.models.card import Measured


_MOST_TOLD = 10
"""How many shots that are left out are named."""


class Predictor(StrEnum):
    """The predictors that can be trained."""

    NN = "shot_nn"
    EXPECTED = "shot_expected"
    BEST = "shot_best"


class AuthorShots(StrEnum):
    """Which of the author's shots."""

    TRAIN = "train"
    TEST = "test"


def train(
    data: Annotated[
        list[Path], option("--data", " from 'robobt shots collect' or the paper; may be repeated")
    ],
    predictor: Annotated[
        Predictor, option("--predictor", "; shot_best is made for a few hundred recorded shots")
    ],
    out: Annotated[Path, option("--out", " the model", metavar="FOLDER")] = Path("out/models"),
    name: Annotated[str, option("--name", "; by default the predictor's")] = "",
    real: Annotated[Path | None, option("--real")] = None,
    epochs: Annotated[int, option("--epochs", " shot_expected", min=1, max=10_000)] = 60,
    seed: Annotated[int, option("--seed", min=0, max=MAX_SEED)] = 0,
    force: Annotated[bool, option("--force")] = False,
    as_json: Json = False,
) -> None:
    """Train a shot predictor and write it with its model card.

    A tenth of the shots is held out and measured on; shot_best is cross-validated.

    Keys of --json: file, and of each figure by name: value, low, high, n and interval.
    """
    import pyarrow as pa
    import torch

    from robobt.models.export import refuse_to_replace
    from robobt.models.file import SUFFIXES
    from robobt.shots.data.files import read_shots
    from robobt.shots.predict.shipped import train_shipped
    from robobt.shots.predict.shot_sets import load_shot_sets

    target = out / f"{name or predictor.value}{SUFFIXES['torchscript']}"
    refuse_to_replace(target, force)
    make_folders({"--out": out}, folders=True)
    torch.set_num_threads(1)
    table = pa.concat_tables([read_shots(file) for file in data])
    sets = None if real is None else load_shot_sets(real)
    with Progress(predictor.value, epochs) as progress:
        file, figures = train_shipped(
            predictor.value,
            table,
            out,
            called=name,
            seed=seed,
            epochs=epochs,
            real=None if sets is None else sets.test,
            recorded=None if sets is None else sets.train,
            force=force,
            on_epoch=lambda _: progress.advance(),
        )
    if as_json:
        print_json({"file": str(file), **{key: figure.model_dump() for key, figure in figures.items()}})
        return
    what = "cross-validated" if predictor is Predictor.BEST else "on shots that training never saw"
    say(f"{file}: {what}: {_figures(figures)}.")
    if sets is not None:
        say(f"On the real shots: {_figures(figures, 'real_')}.")


def score(
    model: Annotated[str, option("--model")],
    data: Annotated[
        Path, option("--data", ": one file, or the folder of the paper's train.csv and test.csv")
    ],
    part: Annotated[AuthorShots, option("--part", " when --data is their folder")] = AuthorShots.TEST,
    goalkeeper: Annotated[str, option("--goalkeeper")] = "",
    as_json: Json = False,
) -> None:
    """Judge a shot predictor on recorded shots.

    Shots with something wrong, or without what the model needs, are left out; a warning names their rows.

    Keys of --json: model, data, shots, goals, predicted (goals that it expects), left_out (shots),
    and of accuracy, log_loss and calibration_error each: value, low, high, n and interval.
    """
    from numpy import isfinite

    from robobt.shots.data.files import read_usable_shots
    from robobt.shots.data.inputs import goals
    from robobt.shots.predict.score import measured, predicted_by
    from robobt.shots.predict.shot_sets import split_file

    shots = read_usable_shots(split_file(data, part.value) if data.is_dir() else data)
    lacking: dict[int, str] = {}
    expected = predicted_by(model, shots.table, lacking, goalkeeper)
    shots = shots.without(lacking)
    expected = expected[isfinite(expected)]
    scored, left_out = goals(shots.table), list(shots.problems.values())
    for problem in left_out[:_MOST_TOLD]:
        warn(f"{shots.file}: {problem}")
    if left_out:
        unnamed = f", {len(left_out) - _MOST_TOLD} of them not named" if len(left_out) > _MOST_TOLD else ""
        are = "is" if len(left_out) == 1 else "are"
        warn(f"{len(left_out)} of {counted(len(left_out) + len(scored), 'shot')} {are} left out{unnamed}")
    figures = measured(expected, scored)
    if as_json:
        counts = {
            "shots": len(scored),
            "goals": int(scored.sum()),
            "predicted": float(expected.sum()),
            "left_out": len(left_out),
        }
        found = {key: figure.model_dump() for key, figure in figures.items()}
        print_json({"model": model, "data": str(data), **counts, **found})
        return
    say(
        f"{model}: {counted(len(scored), 'shot')}, {counted(int(scored.sum()), 'goal')}, "
        f"{expected.sum():.1f} predicted."
    )
    say(f"{_figures(figures)}.")


def _figures(figures: Mapping[str, Measured], prefix: str = "") -> str:
    right, loss, off = [figures[prefix + name] for name in ("accuracy", "log_loss", "calibration_error")]
    return (
        f"{counted(right.n, 'shot')}, {right.value:.1%} right ({right.low:.1%} to {right.high:.1%}), "
        f"log-loss {loss.value:.3f} ({loss.low:.3f} to {loss.high:.3f}), "
        f"calibration error {off.value:.3f} ({off.low:.3f} to {off.high:.3f})"
    )


def draw(
    out: Annotated[Path, option("--out", " the picture (.png)", metavar="FILE")] = Path("goal_map.png"),
    model: Annotated[str, option("--model", " that predicts from a shot's scene")] = "shot_expected",
    spacing: Annotated[float, option("--spacing", min=0.02, max=1.0)] = 0.1,
    as_json: Json = False,
) -> None:
    """Draw the probability of a goal from everywhere in the opponents' half.

    For a shooter at rest with the ball and a goalkeeper that covers the angle.

    Keys of --json: picture, x, y (coordinates of the grid in metres) and probability, a
    row for each y, null where nobody may shoot from.
    """
    from robobt.shots.goal_map import draw_goal_map, goal_map

    make_folders({"--out": out})
    found = goal_map(model, spacing)
    draw_goal_map(found, out)
    if as_json:
        rows = [[None if isnan(p) else p for p in row] for row in found.probability.tolist()]
        print_json({"picture": str(out), "x": found.x.tolist(), "y": found.y.tolist(), "probability": rows})
        return
    say(f"Map of the goal probability: {out}")
