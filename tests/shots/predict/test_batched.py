import numpy as np
import pytest
import torch

from robobt.shots.predict.batched import Recipe, TrainingSet, batch_bounds, train_networks
from robobt.shots.predict.networks import TABLE_ONE, Layer, ShotNetwork
from tests.shots.predict.plain_training import train_plainly


def _task(samples: int, seed: int, held: int = 20) -> TrainingSet:
    rng = np.random.default_rng(seed)
    inputs = torch.tensor(rng.normal(3.0, 2.0, (samples + held, 4)), dtype=torch.float32)
    labels = (inputs[:, 0] + inputs[:, 1] * inputs[:, 2] > 9.0).float()
    return TrainingSet(inputs[:samples], labels[:samples], inputs[samples:], labels[samples:], seed)


def _apart(one: ShotNetwork, other: ShotNetwork, task: TrainingSet) -> float:
    with torch.no_grad():
        return float((one(task.held_inputs) - other(task.held_inputs)).abs().max())


NORMALISED = (Layer(True, 8, "relu"), Layer(True, 8, "relu"), Layer(True, 1, "linear"))
PLAIN = (Layer(False, 3, "silu"), Layer(False, 1, "linear"))


@pytest.mark.parametrize("layers", [TABLE_ONE, NORMALISED, PLAIN])
def test_each_network_of_a_stack_is_what_the_plain_loop_makes_of_it(layers: tuple[Layer, ...]):
    # 39 and 40 share a stack and end in batches of 7 and 8; 33 leaves one sample
    # over; 20 has fewer batches than the rest.
    tasks = [_task(samples, seed) for seed, samples in enumerate((39, 40, 33, 20))]
    recipe = Recipe(layers, warm_up=1, epochs=3)
    for task, network in zip(tasks, train_networks(tasks, recipe), strict=True):
        assert _apart(network, train_plainly(task, recipe), task) < 1e-4


def test_a_stack_stops_each_network_by_itself_and_keeps_its_best_weights():
    tasks = [_task(40, seed) for seed in range(4)]
    recipe = Recipe(warm_up=1, epochs=12, patience=2, plateau_patience=1, rate=0.02)
    for task, network in zip(tasks, train_networks(tasks, recipe), strict=True):
        assert _apart(network, train_plainly(task, recipe), task) < 1e-3
    longer = train_networks(tasks, Recipe(warm_up=1, epochs=12, patience=50, plateau_patience=1, rate=0.02))
    assert any(
        _apart(a, b, task) > 1e-3
        for a, b, task in zip(longer, train_networks(tasks, recipe), tasks, strict=True)
    )


def test_a_network_does_not_depend_on_the_others_in_its_stack():
    tasks = [_task(samples, seed) for seed, samples in enumerate((40, 39, 38))]
    recipe = Recipe(warm_up=2, epochs=4)
    alone = train_networks(tasks[1:2], recipe)[0]
    assert _apart(alone, train_networks(tasks, recipe)[1], tasks[1]) < 1e-4


@pytest.mark.integration
def test_training_learns():
    task = _task(400, 1, held=200)
    network = train_networks([task], Recipe(warm_up=10, epochs=20))[0]
    with torch.no_grad():
        right = (network(task.held_inputs)[:, 0] > 0) == (task.held_labels > 0.5)
    assert float(right.float().mean()) > 0.9


@pytest.mark.parametrize(
    ("samples", "bounds"), [(32, [0, 16, 32]), (35, [0, 16, 32, 35]), (33, [0, 16, 33]), (1, [0, 1])]
)
def test_no_sample_is_dropped_and_none_is_left_alone(samples: int, bounds: list[int]):
    assert batch_bounds(samples, 16) == bounds
