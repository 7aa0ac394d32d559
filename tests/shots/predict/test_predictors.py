import numpy as np
import pytest
from sklearn.utils.estimator_checks import parametrize_with_checks

from robobt.shots.data import goals, shot_inputs
from robobt.shots.predict import best_predictor
from robobt.shots.predict.batched import Recipe
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.validation import stratified_folds
from robobt.world.features import SCENE_HEAD
from tests.shots.made_up import QUICK, made_up_table

pytestmark = pytest.mark.integration


@parametrize_with_checks([NetworkClassifier(QUICK)])
def test_the_network_keeps_to_scikit_learns_contract(estimator, check):
    check(estimator)


def test_the_best_predictor_learns_a_law_made_of_the_goalkeepers_speed():
    table, fresh = made_up_table(600), made_up_table(300, seed=1)
    fitted = best_predictor().fit(shot_inputs(table), goals(table))
    right = fitted.predict(shot_inputs(fresh)) == goals(fresh)
    assert right.mean() > max(goals(fresh).mean(), 1 - goals(fresh).mean()) + 0.1
    assert right.mean() > 0.85


def test_the_best_predictor_takes_a_speed_that_was_not_recorded_at_its_median():
    table = made_up_table(160)
    x, y = shot_inputs(table), goals(table)
    fitted = best_predictor().fit(x, y)
    unknown = x.copy()
    unknown[:, SCENE_HEAD + 2 : SCENE_HEAD + 4] = np.nan
    typical = x.copy()
    v = -np.sign(x[:, SCENE_HEAD + 1]) * x[:, SCENE_HEAD + 3]
    typical[:, SCENE_HEAD + 3] = -np.sign(x[:, SCENE_HEAD + 1]) * np.median(v)
    np.testing.assert_allclose(fitted.predict_proba(unknown), fitted.predict_proba(typical), atol=1e-9)
    # No training shot needs to have one either.
    blind = best_predictor().fit(unknown, y)
    assert np.isfinite(blind.predict_proba(x)).all()
    assert np.mean(blind.predict(x) == y) > 0.7


def test_each_repeat_of_a_cross_validation_tests_every_shot_once():
    labels = np.arange(60) % 3 == 0
    folds = stratified_folds(labels.astype(np.int64), 2, seed=1)
    assert len(folds) == 20
    for repeat in (folds[:10], folds[10:]):
        assert sorted(np.concatenate([test for _, test in repeat])) == list(range(60))
        assert all(labels[test].sum() == 2 for _, test in repeat)


def test_a_network_holds_out_the_samples_it_is_given():
    rng = np.random.default_rng(0)
    x = rng.normal(size=(60, 3))
    y = (x[:, 0] > 0).astype(int)
    held = np.arange(60) % 3 == 0
    # Held-out shots with the opposite labels stop the training at once.
    opposite = np.where(held, 1 - y, y)
    network = NetworkClassifier(Recipe(warm_up=0, epochs=10))
    one, same, other = (
        network.fit_many([(x, labels)], held_out=held)[0].decision_function(x) for labels in (y, y, opposite)
    )
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 1e-6
    with pytest.raises(ValueError, match="held_out"):
        network.fit_many([(x, y)], held_out=np.ones(60, dtype=bool))
