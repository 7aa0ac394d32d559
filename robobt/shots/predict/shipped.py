"""Shot predictors as model files: those that ship, and one for a few hundred shots of one's own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
import pyarrow as pa
import torch
from numpy.typing import NDArray
from scipy.special import expit, logit
from torch import nn

from robobt import __version__
from robobt.config.commit import source_commit
from robobt.models.card import Measured, ModelCard, ObservationCard, OutputEntry
from robobt.models.export import export_model
from robobt.shots.data.inputs import asked_inputs, goals
from robobt.shots.data.schema import AS_RECORDED, GOALKEEPERS, ShotDataError
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.predictors import best_predictor, pair_features
from robobt.shots.predict.quadratic import QuadraticShot
from robobt.shots.predict.scene_network import SceneNetwork, train_scene_network
from robobt.shots.predict.score import answers_in_order, measured
from robobt.shots.predict.validation import stratified_folds
from robobt.world.features import ABSENT, SCENE_HEAD, SHOT, SHOT_SCENE, ObservationSpec
from robobt.world.geometry import FloatArray

ShippedModel = Literal["shot_nn", "shot_expected", "shot_best"]

RECIPE_SHOTS = 6000
"""Shots that the network of Table 1 is trained on, ten times the paper's: more only takes longer."""

_HELD_OUT_SHARE = 0.1

RECORDED_KIND = "fitted"
"""The kind of goalkeeper that recorded shots met."""


def train_shipped(
    name: ShippedModel,
    table: pa.Table,
    folder: Path,
    *,
    called: str = "",
    seed: int = 0,
    epochs: int = 60,
    real: pa.Table | None = None,
    recorded: pa.Table | None = None,
    force: bool = False,
    on_epoch: Callable[[int], None] | None = None,
) -> tuple[Path, dict[str, Measured]]:
    """Train a predictor and write it with its card.

    A tenth of the shots, drawn by ``seed``, is held out and measured on. ``shot_best`` is measured by
    cross-validation instead and fitted to all shots.

    Where every shot's kind of goalkeeper is known, ``shot_expected`` has an output for each kind, and each
    shot is judged by the output of its own. The kind "fitted" is as strong as recorded goalkeepers: one
    number that is added to the log-odds past it is fitted to ``recorded``.

    Args:
        name: ``shot_nn``, the network of Table 1 with the paper's recipe on the
            features of Eq. 4; ``shot_expected``, which sees everybody and how they move;
            or ``shot_best``, quadratic logistic regression for a few hundred shots.
        table: shots with field coordinates.
        folder: where to.
        called: name of the model and its file; ``name`` without.
        seed: what the training's randomness follows from.
        epochs: of ``shot_expected``.
        real: recorded shots that it is judged on besides, for its card.
        recorded: other recorded shots, which say how strong goalkeepers of the kind "fitted" are.
        force: write over a model of that name.
        on_epoch: called after each epoch.

    Returns:
        The file, and what was measured, by name; past one kind of goalkeeper "KIND_...", on the shots
        ``recorded`` by ten-fold cross-validation "recorded_...", on the shots ``real`` "real_...".

    Raises:
        ShotDataError: too few shots, or goals in all or none of them.
    """
    scenes, labels, kinds, faced = _data(name, table)
    order = np.random.default_rng([seed, 7]).permutation(len(scenes))
    held, used = np.split(order, [round(_HELD_OUT_SHARE * len(order))])
    observation: ObservationSpec = SHOT_SCENE
    checked: dict[str, Measured] = {}
    inputs = scenes
    if name == "shot_nn":
        used = used[:RECIPE_SHOTS]
        inputs, observation = pair_features(scenes), SHOT
        classifier = NetworkClassifier(random_state=seed).fit(inputs[used], labels[used])
        module: nn.Module = classifier.network_.probabilities()
        training: dict[str, object] = {"recipe": "the paper's (Table 1)", "shots": len(used)}
    elif name == "shot_best":
        module = QuadraticShot(best_predictor().fit(scenes, labels), scenes)
        training = {"recipe": "quadratic logistic regression", "shots": len(labels)}
    else:
        network = train_scene_network(
            scenes[used], labels[used], epochs=epochs, seed=seed, faced=faced[used], on_epoch=on_epoch
        )
        training = {"epochs": epochs, "shots": len(used)}
        if recorded is not None and RECORDED_KIND in kinds:
            place = kinds.index(RECORDED_KIND)
            easier, checked = _strength(network, place, recorded, seed)
            network.easier[place] = easier
            training["easier_than_fitted"] = easier
        module = network
    if name == "shot_best":
        figures = measured(_validated(scenes, labels, seed), labels)
    else:
        rows, met = np.arange(len(held)), faced[held]
        answers = _answers(module, inputs[held])[rows, met]
        figures = measured(answers, labels[held])
        for place, kind in enumerate(kinds if len(kinds) > 1 else ()):
            figures |= measured(answers[met == place], labels[held][met == place], f"{kind}_")
    figures |= checked
    if real is not None:
        asked = asked_inputs(real)
        given = pair_features(asked) if name == "shot_nn" else asked
        figures |= measured(answers_in_order(_answers(module, given), kinds, real), goals(real), "real_")
    card = ModelCard(
        kind="shot_predictor",
        name=called or name,
        skill="SelectShot",
        description=_DESCRIPTIONS[name],
        observation=ObservationCard.of(observation),
        outputs=tuple([OutputEntry(name=kind) for kind in kinds]),
        environment={
            "shots": len(table),
            "goals": float(np.mean(labels)),
            "seed": sorted(set(table.column("seed").to_pylist())),
        },
        training=training,
        seed=seed,
        held_out=figures,
        code_version=__version__,
        code_commit=source_commit(),
        created_by=f"robobt shots train --predictor {name}",
    )
    return export_model(module, card, folder, force=force)[0], figures


def _answers(module: nn.Module, inputs: FloatArray) -> FloatArray:
    with torch.inference_mode():
        answers: FloatArray = module(torch.from_numpy(inputs.astype(np.float32))).numpy()
    return answers


def _strength(
    network: SceneNetwork, place: int, recorded: pa.Table, seed: int
) -> tuple[float, dict[str, Measured]]:
    """Return how much easier recorded goalkeepers are than those of training, and how well that fits.

    The first is in log-odds, the second by cross-validation.
    """
    scored = goals(recorded)
    log_odds = logit(_answers(network, asked_inputs(recorded))[:, place].astype(np.float64))
    predicted = np.empty(len(scored))
    for train, test in stratified_folds(scored, 1, seed):
        predicted[test] = expit(log_odds[test] + _likeliest(log_odds[train], scored[train]))
    return _likeliest(log_odds, scored), measured(predicted, scored, "recorded_")


def _likeliest(log_odds: FloatArray, scored: NDArray[np.int64]) -> float:
    """Return what makes the outcomes likeliest when it is added to the log-odds, in hundredths."""
    tried = np.arange(-200, 201) / 100.0
    likely = expit(np.where(scored == 1, 1.0, -1.0) * (log_odds + tried[:, None]))
    return float(tried[np.log(likely).sum(axis=1).argmax()])


def _validated(scenes: FloatArray, labels: NDArray[np.int64], seed: int) -> FloatArray:
    """Return the probability of every shot by a fit without its tenth."""
    predicted = np.empty(len(labels))
    for train, test in stratified_folds(labels, 1, seed):
        fitted = best_predictor().fit(scenes[train], labels[train])
        predicted[test] = _answers(QuadraticShot(fitted, scenes[train]), scenes[test])[:, 0]
    return predicted


_DESCRIPTIONS = {
    "shot_nn": (
        "The paper's network (Table 1) with its training recipe: probability of a goal past one opponent, "
        "from where it stands beside the line of the shot."
    ),
    "shot_expected": (
        "Calibrated probability of a goal from the scene of a shot: all opponents and how everybody moves; "
        "one for each kind of goalkeeper."
    ),
    "shot_best": (
        "Quadratic logistic regression on where the goalkeeper is beside the line of a shot, how fast it "
        "comes, and how far the goal is: for a few hundred shots of one's own."
    ),
}


_Data = tuple[FloatArray, NDArray[np.int64], tuple[str, ...], NDArray[np.int64]]


def _data(name: ShippedModel, table: pa.Table) -> _Data:
    """Return scenes, goals, the kinds of goalkeepers told apart, and which of them each shot met."""
    scenes, labels = asked_inputs(table), goals(table)
    known = np.isfinite(scenes).all(axis=1)
    if name != "shot_expected":
        # One opponent: with more, a goal says nothing about each of them.
        known &= np.all(scenes[:, SCENE_HEAD + 4 : SCENE_HEAD + 8] == ABSENT, axis=1)
        known &= scenes[:, SCENE_HEAD] > ABSENT[0]
        # It does not see how the goalkeeper moves, so it has to learn how those that it meets do.
        recorded = np.array(table.column("variant").to_pylist()) == AS_RECORDED
        if name == "shot_nn" and recorded.any():
            known &= recorded
    names = np.array(table.column("goalkeeper").to_pylist())[known]
    scenes, labels = scenes[known], labels[known]
    if len(scenes) < 100 or len(np.unique(labels)) < 2:
        raise ShotDataError(
            f"{name} needs 100 shots or more with field coordinates, goals and misses among them; "
            f"there are {len(scenes)}, {int(labels.sum())} of them goals"
        )
    kinds = tuple([kind for kind in GOALKEEPERS if kind in names])
    if name != "shot_expected" or not kinds or not np.isin(names, kinds).all():
        return scenes, labels, ("goal",), np.zeros(len(labels), dtype=np.int64)
    return scenes, labels, kinds, np.array([kinds.index(kind) for kind in names])
