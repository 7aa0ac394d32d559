"""The predictors that ship with robobt: trained on our own shots, exported with their cards."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
import pyarrow as pa
import torch
from numpy.typing import NDArray
from torch import nn

from robobt import __version__
from robobt.models.card import Measured, ModelCard, ObservationCard, OutputEntry
from robobt.models.export import export_model
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.data.problems import ShotDataError
from robobt.shots.predict.features import pair_features
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.scene_network import train_scene_network
from robobt.shots.predict.validation import Judgement, judge
from robobt.statistics import wilson_interval
from robobt.world.features import ABSENT, SCENE_HEAD, SHOT, SHOT_SCENE
from robobt.world.geometry import FloatArray

ShippedModel = Literal["shot_nn", "shot_expected"]

RECIPE_SHOTS = 6000
"""Shots that the network of Table 1 is trained on, ten times the paper's: more only takes longer."""

_HELD_OUT = 0.1


def train_shipped(
    name: ShippedModel,
    table: pa.Table,
    folder: Path,
    *,
    seed: int = 0,
    epochs: int = 40,
    on_epoch: Callable[[int], None] | None = None,
) -> tuple[Path, Judgement]:
    """Train one of the shipped predictors and write it with its card.

    A tenth of the shots, drawn by ``seed``, is held out and measured on.

    Args:
        name: ``shot_nn``, the network of Table 1 with the paper's recipe on the
            features of Eq. 4; or ``shot_expected``, which sees everybody and how they move.
        table: shots with field coordinates.
        folder: where to.
        seed: what the training's randomness follows from.
        epochs: of ``shot_expected``.
        on_epoch: called after each of them.

    Raises:
        ShotDataError: too few shots, or goals in all or none of them.
    """
    scenes, labels = _data(name, table)
    order = np.random.default_rng([seed, 7]).permutation(len(scenes))
    held, used = np.split(order, [round(_HELD_OUT * len(order))])
    if name == "shot_nn":
        used = used[:RECIPE_SHOTS]
        inputs, observation = pair_features(scenes), SHOT
        classifier = NetworkClassifier(random_state=seed).fit(inputs[used], labels[used])
        module: nn.Module = classifier.network_.probabilities()
        training: dict[str, object] = {"recipe": "the paper's (Table 1)", "shots": len(used)}
    else:
        inputs, observation = scenes, SHOT_SCENE
        module = train_scene_network(scenes[used], labels[used], epochs=epochs, seed=seed, on_epoch=on_epoch)
        training = {"epochs": epochs, "shots": len(used)}
    with torch.inference_mode():
        answers = module(torch.from_numpy(inputs[held].astype(np.float32))).numpy()[:, 0]
    figures = judge(answers, labels[held])
    interval = wilson_interval(round(figures.accuracy * figures.shots), figures.shots)
    seeds = sorted(set(table.column("seed").to_pylist()))
    card = ModelCard(
        kind="shot_predictor",
        name=name,
        skill="SelectShot",
        description=_DESCRIPTIONS[name],
        observation=ObservationCard.of(observation),
        outputs=(OutputEntry(name="goal"),),
        environment={"shots": len(table), "goals": float(np.mean(labels)), "seed": seeds},
        training=training,
        seed=seed,
        held_out={
            "accuracy": Measured(
                value=figures.accuracy,
                low=interval.low,
                high=interval.high,
                n=figures.shots,
                interval="95 % Wilson",
            ),
            "log_loss": Measured(value=figures.log_loss, n=figures.shots),
            "calibration_error": Measured(value=figures.calibration_error, n=figures.shots),
        },
        code_version=__version__,
        created_by=f"robobt shots train --model {name}",
    )
    return export_model(module, card, folder)[0], figures


_DESCRIPTIONS = {
    "shot_nn": (
        "The paper's network (Table 1) with its training recipe: probability of a goal past one opponent, "
        "from where it stands beside the line of the shot."
    ),
    "shot_expected": (
        "Calibrated probability of a goal from the scene of a shot: all opponents and how everybody moves."
    ),
}


def _data(name: ShippedModel, table: pa.Table) -> tuple[FloatArray, NDArray[np.int64]]:
    scenes, labels = shot_inputs(table), goals(table)
    known = np.isfinite(scenes).all(axis=1)
    if name == "shot_nn":
        # One opponent: with more, a goal says nothing about each of them.
        known &= np.all(scenes[:, SCENE_HEAD + 4 : SCENE_HEAD + 8] == ABSENT, axis=1)
        known &= scenes[:, SCENE_HEAD] > ABSENT[0]
    scenes, labels = scenes[known], labels[known]
    if len(scenes) < 100 or len(np.unique(labels)) < 2:
        raise ShotDataError(
            f"{name} needs 100 shots or more with field coordinates, goals and misses among them; "
            f"there are {len(scenes)}, {int(labels.sum())} of them goals"
        )
    return scenes, labels
