import numpy as np
import pytest
from sklearn.base import clone
from sklearn.pipeline import Pipeline

from paper.predictors import KIKS, PREDICTORS, kiks_features
from robobt.shots.data import goals, shot_inputs
from robobt.shots.predict.batched import Recipe
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.predictors import pair_features
from robobt.world.features import SCENE_HEAD
from tests.shots.made_up import QUICK, made_up_table

pytestmark = pytest.mark.integration


def _quick(predictor: Pipeline) -> Pipeline:
    """A predictor that learns in less time than it should."""
    if "networkclassifier" in predictor.named_steps:
        predictor.set_params(networkclassifier__recipe=QUICK)
    return predictor


@pytest.mark.parametrize("name", PREDICTORS)
def test_every_predictor_fits_clones_and_answers_probabilities(name: str):
    table = made_up_table(160)
    x, y = shot_inputs(table), goals(table)
    estimator = _quick(PREDICTORS[name]())
    fitted = clone(estimator).fit(x[:120], y[:120])
    p = fitted.predict_proba(x[120:])
    assert p.shape == (40, 2)
    assert ((p >= 0.0) & (p <= 1.0)).all()
    np.testing.assert_allclose(p.sum(axis=1), 1.0)
    assert list(fitted.classes_) == [0, 1]
    np.testing.assert_array_equal(fitted.predict(x[120:]), (p[:, 1] >= 0.5).astype(int))
    # Fitted again it is the same: what is random follows from a parameter.
    np.testing.assert_array_equal(clone(estimator).fit(x[:120], y[:120]).predict_proba(x[120:]), p)


def test_the_layers_of_a_network_are_those_of_its_recipe():
    network = (
        NetworkClassifier(Recipe(KIKS, warm_up=1, epochs=1)).fit(np.eye(30, 3), np.arange(30) % 2).network_
    )
    assert [dense.out_features for dense in network.dense] == [8, 8, 1]


def test_naito_et_als_inputs_are_speed_distance_and_angle_on_either_side():
    scenes = shot_inputs(made_up_table(20))
    angle, _, distance, _, _ = pair_features(scenes)[3]
    assert kiks_features(scenes)[3] == pytest.approx([7.5, distance, angle])
    mirrored = scenes.copy()
    mirrored[:, SCENE_HEAD + 1 :: 2] *= -1.0
    np.testing.assert_array_equal(kiks_features(scenes), kiks_features(mirrored))
