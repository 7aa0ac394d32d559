"""How good a model file is on given shots."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import ArrayLike

from robobt.config.errors import unknown_name
from robobt.models.card import Measured
from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from robobt.shots.data.inputs import PLACE_COLUMNS, asked_inputs, goals
from robobt.shots.data.schema import SCHEMA, SHOT_COLUMNS, ShotDataError
from robobt.shots.predict.predictors import pair_features
from robobt.shots.predict.validation import judge
from robobt.skills.aim.goalkeeper_watch import updated
from robobt.statistics import calibration_error, mean_interval, wilson_interval
from robobt.world.features import SHOT
from robobt.world.geometry import FloatArray

RESAMPLES = 1000
_PROBABILITY_MARGIN = 1e-6
_NUMBER_COLUMNS = [
    column for column in SHOT_COLUMNS if column.type in ("real", "reals") and column.name not in PLACE_COLUMNS
]


def predicted_by(
    model: str | Path, table: pa.Table, lacking: dict[int, str] | None = None, goalkeeper: str = ""
) -> FloatArray:
    """Return the probability of a goal (n,) that a shot predictor gives each shot of a table.

    It is asked as a rater asks it in play: about a kick that goes out along the line to the target. A model
    that tells kinds of goalkeepers apart answers for the shot's own kind where the table knows it. Elsewhere
    it knows of the goalkeeper what it would know in a match of these shots, in their order: before the first
    one all kinds are equally likely, and each outcome changes how likely they are for the shots after it.

    Args:
        model: a shipped model's name, or a file.
        table: the shots, in the package's table.
        lacking: takes what is missing, by index, of the shots that lack something the model needs; their
            probability is not-a-number. With None such a shot is an error.
        goalkeeper: the kind of goalkeeper that all shots met, by the name of the model's output; empty for
            what the table says.

    Raises:
        ModelError: there is no such model, it is no shot predictor, or it does not know that goalkeeper.
        ShotDataError: a shot lacks what the model needs to know.
    """
    policy = load_policy(model, kind="shot_predictor")
    kinds = [output.name for output in policy.card.outputs]
    if goalkeeper and goalkeeper not in kinds:
        raise ModelError(
            f"{policy.path}: knows no goalkeeper {goalkeeper!r}; {unknown_name(goalkeeper, kinds)}"
        )
    pairs = policy.card.observation.name == SHOT.name
    inputs = _inputs(table, pairs)
    known = np.isfinite(inputs).all(axis=1)
    for index in np.flatnonzero(~known).tolist():
        problem = f"lacks {_lacking(table, index, pairs)}, which {policy.card.name} needs to know"
        if lacking is None:
            raise ShotDataError(f"shot {index + 1}: {problem}")
        lacking[index] = problem
    answers = np.full(len(inputs), np.nan)
    if known.any():
        given = np.asarray(policy(inputs[known].astype(np.float32)), dtype=np.float64)
        if goalkeeper:
            answers[known] = given[:, kinds.index(goalkeeper)]
        else:
            answers[known] = answers_in_order(given, kinds, table.take(pa.array(np.flatnonzero(known))))
    return answers


def answers_in_order(by_kind: FloatArray, kinds: Sequence[str], table: pa.Table) -> FloatArray:
    """Return the probability of a goal (n,) of each shot of a table.

    Args:
        by_kind: the probabilities past each kind of goalkeeper, (n, K).
        kinds: the names of the kinds.
        table: the shots; of a goalkeeper whose kind it does not know, the outcomes of the earlier ones tell.
    """
    if len(kinds) == 1:
        return by_kind[:, 0]
    answers = np.empty(len(by_kind))
    weights = np.full(len(kinds), 1.0 / len(kinds))
    faced = table.column("goalkeeper").to_pylist()
    for i, (row, kind, scored) in enumerate(zip(by_kind, faced, goals(table), strict=True)):
        if kind in kinds:
            answers[i] = row[kinds.index(kind)]
        else:
            answers[i] = row @ weights
            weights = updated(weights, row, bool(scored))
    return answers


def _inputs(table: pa.Table, pairs: bool) -> FloatArray:
    scenes = asked_inputs(table)
    return pair_features(scenes) if pairs else scenes


def _lacking(table: pa.Table, index: int, pairs: bool) -> str:
    """Return the columns without which the inputs of a shot are not finite."""
    shot = table.slice(index, 1).to_pylist()[0]
    known = {
        column.name: np.nan_to_num(shot[column.name], posinf=0.0, neginf=0.0) for column in _NUMBER_COLUMNS
    }
    unknown = [name for name in known if not np.isfinite(shot[name]).all()]
    # Each is tried alone, all others known.
    tried = pa.Table.from_pylist([{**shot, **known, name: shot[name]} for name in unknown], SCHEMA)
    needed = np.flatnonzero(~np.isfinite(_inputs(tried, pairs)).all(axis=1))
    return ", ".join([repr(unknown[i]) for i in needed])


def measured(probabilities: ArrayLike, scored: ArrayLike, prefix: str = "") -> dict[str, Measured]:
    """Return accuracy, log-loss and calibration error with their 95 % intervals, by name.

    They are of ``probabilities`` (n,) of a goal, judged by which shots ``scored`` (n,).
    The interval of the accuracy is Wilson's, that of the log-loss Student's over the shots, that of
    the calibration error from :data:`RESAMPLES` resamplings of the shots. Names begin with ``prefix``.
    """
    p = np.clip(np.asarray(probabilities, dtype=np.float64), _PROBABILITY_MARGIN, 1.0 - _PROBABILITY_MARGIN)
    goal = np.asarray(scored) == 1
    judged = judge(p, goal)
    right = wilson_interval(round(judged.accuracy * judged.shots), judged.shots)
    losses = -np.where(goal, np.log(p), np.log1p(-p))
    loss = mean_interval(losses)
    # Losses are bounded, and one shot alone tells nothing about the others': they may be any.
    most = -float(np.log(_PROBABILITY_MARGIN))
    lowest, highest = (max(0.0, loss.low), min(most, loss.high)) if len(losses) > 1 else (0.0, most)
    drawn = np.random.default_rng(0).integers(0, len(p), (RESAMPLES, len(p)))
    low, high = np.quantile([calibration_error(p[rows], goal[rows]) for rows in drawn], (0.025, 0.975))
    figures = {
        "accuracy": (judged.accuracy, right.low, right.high, "95 % Wilson"),
        "log_loss": (judged.log_loss, lowest, highest, "95 % Student"),
        "calibration_error": (judged.calibration_error, float(low), float(high), "95 % bootstrap"),
    }
    return {
        prefix + name: Measured(value=value, low=low, high=high, n=judged.shots, interval=kind)
        for name, (value, low, high, kind) in figures.items()
    }
