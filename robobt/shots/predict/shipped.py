"""The predictors that ship with robobt: trained on our own shots, exported with their cards."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
import pyarrow as pa
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from robobt import __version__
from robobt.models.card import Measured, ModelCard, ObservationCard, OutputEntry
from robobt.models.export import export_model
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.data.problems import ShotDataError
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.networks import ShotNetwork
from robobt.shots.predict.scene_training import train_scene_network
from robobt.statistics import wilson_interval
from robobt.world.features import ABSENT, SCENE_HEAD, SHOT, SHOT_SCENE
from robobt.world.geometry import FloatArray

ShippedModel = Literal["shot_nn", "shot_expected"]

RECIPE_SHOTS = 6000
"""Shots that the network of Table 1 is trained on, ten times the paper's: more only takes longer."""

_HELD_OUT = 0.1
_BINS = 15


class Figures(NamedTuple):
    """How well a predictor does on shots that its training never saw.

    Attributes:
        accuracy: share judged rightly at a threshold of one half.
        log_loss: mean of -log of the probability given to what happened.
        calibration_error: mean distance of probability and frequency over 15 equal bins.
        shots: how many it was measured on.
    """

    accuracy: float
    log_loss: float
    calibration_error: float
    shots: int


def train_shipped(
    name: ShippedModel,
    table: pa.Table,
    folder: Path,
    *,
    seed: int = 0,
    epochs: int = 40,
    on_epoch: Callable[[int], None] | None = None,
) -> tuple[Path, Figures]:
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
        features = _pair_features(scenes)
        classifier = NetworkClassifier(random_state=seed)
        classifier.fit(features[used].astype(np.float32), labels[used])
        module: nn.Module = _Probability(classifier.network_)
        inputs, observation = features, SHOT
        training: dict[str, object] = {"recipe": "the paper's (Table 1)", "shots": len(used)}
    else:
        module = train_scene_network(scenes[used], labels[used], epochs=epochs, seed=seed, on_epoch=on_epoch)
        inputs, observation = scenes, SHOT_SCENE
        training = {"epochs": epochs, "shots": len(used)}
    figures = measure(module, inputs[held], labels[held])
    right = round(figures.accuracy * figures.shots)
    interval = wilson_interval(right, figures.shots)
    card = ModelCard(
        kind="shot_predictor",
        name=name,
        skill="SelectShot",
        description=_DESCRIPTIONS[name],
        observation=ObservationCard.of(observation),
        outputs=(OutputEntry(name="goal"),),
        environment={"shots": len(table), "goals": float(np.mean(labels)), "seed": _seed_of(table)},
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


def measure(module: nn.Module, inputs: FloatArray, labels: NDArray[np.int64]) -> Figures:
    """The figures of a module that answers probabilities (n, 1)."""
    with torch.inference_mode():
        answers = module(torch.from_numpy(inputs.astype(np.float32))).numpy()[:, 0].astype(np.float64)
    sure = np.clip(answers, 1e-7, 1.0 - 1e-7)
    loss = -np.mean(labels * np.log(sure) + (1 - labels) * np.log(1.0 - sure))
    bins = np.minimum((answers * _BINS).astype(int), _BINS - 1)
    error = 0.0
    for number in np.unique(bins):
        there = bins == number
        error += there.mean() * abs(answers[there].mean() - labels[there].mean())
    accuracy = float(np.mean((answers >= 0.5) == (labels == 1)))
    return Figures(accuracy, float(loss), float(error), len(labels))


class _Probability(nn.Module):
    """A network's logit as a probability (n, 1), its batch normalisations as what they are once trained."""

    def __init__(self, network: ShotNetwork) -> None:
        super().__init__()
        self.network = copy.deepcopy(network)
        for i, norm in enumerate(self.network.norms):
            if isinstance(norm, nn.BatchNorm1d):
                self.network.norms[i] = _Affine(norm)

    def forward(self, inputs: Tensor) -> Tensor:
        return torch.sigmoid(self.network(inputs)).reshape(-1, 1)


class _Affine(nn.Module):
    """A trained batch normalisation: a factor and a shift an input."""

    factor: Tensor
    shift: Tensor

    def __init__(self, norm: nn.BatchNorm1d) -> None:
        super().__init__()
        mean, variance = norm.running_mean, norm.running_var
        assert mean is not None
        assert variance is not None
        factor = norm.weight.detach() / torch.sqrt(variance + norm.eps)
        self.register_buffer("factor", factor)
        self.register_buffer("shift", norm.bias.detach() - mean * factor)

    def forward(self, inputs: Tensor) -> Tensor:
        return inputs * self.factor + self.shift


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


def _pair_features(scenes: FloatArray) -> FloatArray:
    """:data:`~robobt.world.features.SHOT` of the first opponent, (n, 5)."""
    length, along, across = scenes[:, 0], scenes[:, SCENE_HEAD], np.abs(scenes[:, SCENE_HEAD + 1])
    return np.stack([np.arctan2(across, along), length, np.hypot(along, across), along, across], axis=-1)


def _seed_of(table: pa.Table) -> list[int]:
    return sorted(set(table.column("seed").to_pylist()))
