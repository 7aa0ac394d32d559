"""What training many networks in one saves."""

from __future__ import annotations

from collections.abc import Callable
from time import process_time
from typing import NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray

from robobt.shots.predict.batched import train_networks
from robobt.shots.predict.networks import ShotNetwork
from robobt.shots.predict.recipe import Recipe, Task, train_plainly
from robobt.statistics import Fold, repeated_stratified_folds, stratified_hold_out
from robobt.world.geometry import FloatArray


class CrossValidationFigures(NamedTuple):
    """Times of a cross-validation [s, of the processor] and mean accuracies [percent]."""

    cross_validation_s: float
    cross_validation_plain_s: float
    cross_validation_speedup: float
    accuracy: float
    accuracy_plain: float
    networks: int


def bench_cross_validation(
    inputs: FloatArray,
    labels: NDArray[np.int64],
    networks: int = 100,
    seed: int = 0,
    recipe: Recipe = Recipe(),  # noqa: B008
    progress: Callable[[], object] = lambda: None,
) -> CrossValidationFigures:
    """A tenfold cross-validation of the paper's network, all at once and one after the other.

    Both train the same networks: the same data, first weights, order of samples and
    rule for stopping. They run on one thread.

    Args:
        inputs, labels: (n, F) and (n,).
        networks: how many of the folds to train, 100 being ten times ten.
        recipe: what both follow.
        progress: called after every network of the plain loop.
    """
    torch.set_num_threads(1)
    folds = repeated_stratified_folds(labels, 10, -(-networks // 10), seed)[:networks]
    x, y = torch.tensor(inputs, dtype=torch.float32), torch.tensor(labels, dtype=torch.float32)
    tasks = []
    rng = np.random.default_rng([seed, 1])
    for i, fold in enumerate(folds):
        inner = stratified_hold_out(labels[fold.train], 0.33, rng)
        used, held = fold.train[inner.train], fold.train[inner.test]
        tasks.append(Task(x[used], y[used], x[held], y[held], seed + i))
    # What is done for the first time only is in neither time.
    train_networks(tasks[:1], Recipe(warm_up=1, epochs=1))
    train_plainly(tasks[0], Recipe(warm_up=1, epochs=1))
    begin = process_time()
    together = train_networks(tasks, recipe)
    batched = process_time() - begin
    apart, plain = [], 0.0
    for task in tasks:
        begin = process_time()
        apart.append(train_plainly(task, recipe))
        plain += process_time() - begin
        progress()
    return CrossValidationFigures(
        batched,
        plain,
        plain / batched,
        _accuracy(together, x, labels, folds),
        _accuracy(apart, x, labels, folds),
        len(folds),
    )


def made_up_shots(count: int = 542, seed: int = 0) -> tuple[FloatArray, NDArray[np.int64]]:
    """Inputs like the paper's in number, units and spread, with goals by a simple law: (n, 5) and (n,).

    To measure times by where no recorded shots are at hand.
    """
    rng = np.random.default_rng(seed)
    length = rng.uniform(2000.0, 4600.0, count)
    x = length - rng.uniform(50.0, 900.0, count)
    b = np.abs(rng.normal(390.0, 90.0, count))
    logit = (b - 380.0 - (x - 2800.0) / 8.0) / 25.0 + rng.logistic(size=count) - 1.2
    inputs = np.stack([np.arctan2(b, x), length, np.hypot(x, b), x, b], axis=-1)
    return inputs, (logit > 0.0).astype(np.int64)


def _accuracy(
    networks: list[ShotNetwork], x: torch.Tensor, labels: NDArray[np.int64], folds: list[Fold]
) -> float:
    with torch.inference_mode():
        right = [
            np.mean((network(x[fold.test]).numpy() >= 0.0) == (labels[fold.test] == 1))
            for network, fold in zip(networks, folds, strict=True)
        ]
    return 100.0 * float(np.mean(right))
