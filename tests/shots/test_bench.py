import pytest

from robobt.shots.bench import bench_cross_validation, made_up_shots
from robobt.shots.predict.recipe import Recipe


def test_made_up_shots_are_like_the_papers():
    inputs, labels = made_up_shots()
    assert inputs.shape == (542, 5)
    assert 0.15 < labels.mean() < 0.5


def test_both_ways_of_training_are_measured():
    told: list[int] = []
    recipe = Recipe(warm_up=2, epochs=3)
    shots = made_up_shots(60)
    figures = bench_cross_validation(*shots, networks=2, recipe=recipe, progress=lambda: told.append(1))
    assert figures.networks == len(told) == 2
    assert figures.cross_validation_speedup == pytest.approx(
        figures.cross_validation_plain_s / figures.cross_validation_s
    )
    assert figures.accuracy == figures.accuracy_plain
