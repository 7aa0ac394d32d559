import numpy as np
import pytest
from sklearn.base import clone
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import Pipeline
from sklearn.utils.estimator_checks import parametrize_with_checks

from robobt.shots.data.author_data import read_author_folder
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.networks import KIKS
from robobt.shots.predict.physics_margin import PhysicsMargin, reach
from robobt.shots.predict.predictors import (
    PREDICTORS,
    best_predictor,
    calibrated,
    make_predictor,
    quadratic,
)
from robobt.shots.predict.set_network import SetNetworkClassifier
from robobt.shots.predict.subsample import Subsampled
from robobt.shots.predict.validation import accuracies, judge_repeats, predict_folds
from robobt.statistics import repeated_stratified_folds
from robobt.world.features import SCENE_HEAD
from tests.shots.made_up import made_up_table
from tests.shots.real_data import REAL_SHOTS, needs_real_shots

QUICK = {"warm_up": 5, "epochs": 10, "patience": 3}


def _quick(name: str) -> object:
    """A predictor that learns in less time than it should."""
    estimator = make_predictor(name)
    for step, value in (("networkclassifier", QUICK), ("setnetworkclassifier", {"epochs": 5, "hidden": 8})):
        if isinstance(estimator, Pipeline) and step in estimator.named_steps:
            estimator.set_params(**{f"{step}__{key}": entry for key, entry in value.items()})
    return estimator


@parametrize_with_checks([NetworkClassifier(**QUICK), Subsampled(LogisticRegression(), most=50)])
def test_estimators_keep_to_scikit_learns_contract(estimator, check):
    check(estimator)


@pytest.mark.parametrize("name", list(PREDICTORS))
def test_every_predictor_fits_clones_and_answers_probabilities(name: str):
    table = made_up_table(160)
    x, y = shot_inputs(table), goals(table)
    estimator = _quick(name)
    before = estimator.get_params(deep=False).keys()
    fitted = clone(estimator).fit(x[:120], y[:120])
    p = fitted.predict_proba(x[120:])
    assert p.shape == (40, 2)
    assert ((p >= 0.0) & (p <= 1.0)).all()
    np.testing.assert_allclose(p.sum(axis=1), 1.0)
    assert list(fitted.classes_) == [0, 1]
    np.testing.assert_array_equal(fitted.predict(x[120:]), (p[:, 1] >= 0.5).astype(int))
    assert fitted.get_params(deep=False).keys() == before
    # Fitted again it is the same: what is random follows from a parameter.
    np.testing.assert_array_equal(clone(estimator).fit(x[:120], y[:120]).predict_proba(x[120:]), p)


@pytest.mark.parametrize("name", ["table_one_velocity", "quadratic", "physics_margin", "best", "set"])
def test_predictors_that_see_the_goalkeepers_speed_learn_a_law_made_of_it(name: str):
    table, fresh = made_up_table(600), made_up_table(300, seed=1)
    fitted = make_predictor(name).fit(shot_inputs(table), goals(table))
    right = fitted.predict(shot_inputs(fresh)) == goals(fresh)
    assert right.mean() > max(goals(fresh).mean(), 1 - goals(fresh).mean()) + 0.1
    assert right.mean() > 0.85


def test_a_predictor_is_known_by_its_name():
    with pytest.raises(KeyError, match="table_one"):
        make_predictor("crystal_ball")


def test_the_set_network_sees_a_set():
    table = made_up_table(300, opponents=3)
    fitted = SetNetworkClassifier(hidden=8, epochs=5).fit(shot_inputs(table), goals(table))
    scenes = shot_inputs(made_up_table(20, seed=1, opponents=3))
    p = fitted.predict_proba(scenes)
    blocks = scenes[:, SCENE_HEAD:].reshape(20, 6, 4)
    shuffled = np.concatenate([scenes[:, :SCENE_HEAD], blocks[:, [4, 1, 5, 0, 3, 2]].reshape(20, -1)], axis=1)
    np.testing.assert_allclose(fitted.predict_proba(shuffled), p, atol=1e-6)
    mirrored = scenes.copy()
    mirrored[:, [1, 3, 5, 7, 9]] *= -1.0
    mirrored[:, SCENE_HEAD + 1 :: 2] *= -1.0
    np.testing.assert_allclose(fitted.predict_proba(mirrored), p, atol=1e-6)
    behind = scenes.copy()
    behind[:, SCENE_HEAD : SCENE_HEAD + 4] = (-1.0, 0.3, 0.5, 0.5)
    further = scenes.copy()
    further[:, SCENE_HEAD : SCENE_HEAD + 4] = (-3.0, 0.1, 0.0, 0.0)
    np.testing.assert_allclose(fitted.predict_proba(behind), fitted.predict_proba(further), atol=1e-6)
    assert np.abs(fitted.predict_proba(behind) - p).max() > 1e-3


def test_the_set_network_takes_what_is_unknown_at_its_mean_but_needs_opponents():
    table = made_up_table(100)
    x, y = shot_inputs(table), goals(table)
    fitted = SetNetworkClassifier(hidden=8, epochs=2).fit(x, y)
    unknown, mean = x.copy(), x.copy()
    unknown[:, 2], mean[:, 2] = np.nan, x[:, 2].mean()
    np.testing.assert_allclose(fitted.predict_proba(unknown), fitted.predict_proba(mean), atol=1e-5)
    x[3, SCENE_HEAD] = np.nan
    with pytest.raises(ValueError, match="opponents"):
        fitted.predict_proba(x)
    with pytest.raises(ValueError, match="34"):
        SetNetworkClassifier().fit(x[:, :5], y)


def test_the_best_predictor_takes_a_speed_that_was_not_recorded_at_its_median():
    table = made_up_table(160)
    x, y = shot_inputs(table), goals(table)
    fitted = make_predictor("best").fit(x, y)
    unknown = x.copy()
    unknown[:, SCENE_HEAD + 2 : SCENE_HEAD + 4] = np.nan
    typical = x.copy()
    v = -np.sign(x[:, SCENE_HEAD + 1]) * x[:, SCENE_HEAD + 3]
    typical[:, SCENE_HEAD + 3] = -np.sign(x[:, SCENE_HEAD + 1]) * np.median(v)
    np.testing.assert_allclose(fitted.predict_proba(unknown), fitted.predict_proba(typical), atol=1e-9)
    # Nor need any training shot have one.
    blind = make_predictor("best").fit(unknown, y)
    assert np.isfinite(blind.predict_proba(x)).all()
    assert np.mean(blind.predict(x) == y) > 0.7


def test_how_far_a_robot_gets_is_worked_out_by_hand():
    # From rest at 4 m/s^2: 1.2 m/s after 0.3 s and 0.18 m, then steadily.
    assert reach(np, np.array(0.3), np.array(0.0), 1.2, 4.0) == pytest.approx(0.18)
    assert reach(np, np.array(0.8), np.array(0.0), 1.2, 4.0) == pytest.approx(0.18 + 0.6)
    # Away from the line it has to stop first.
    assert reach(np, np.array(0.25), np.array(-1.0), 1.2, 4.0) == pytest.approx(-0.125)
    # Faster than its top speed it stays as fast.
    assert reach(np, np.array(0.5), np.array(2.0), 1.2, 4.0) == pytest.approx(1.0)


def test_the_physical_margin_finds_constants_that_make_sense_and_says_what_it_needs():
    table = made_up_table(600)
    fitted = make_predictor("physics_margin").fit(shot_inputs(table), goals(table))[-1]
    assert 3.0 < np.exp(fitted.constants_["log_ball_speed"]) < 15.0
    assert 0.4 < np.exp(fitted.constants_["log_top_speed"]) < 3.0
    with pytest.raises(ValueError, match="columns"):
        PhysicsMargin().fit(np.zeros((4, 5)), [0, 1, 0, 1])


@pytest.mark.parametrize("method", ["temperature", "sigmoid", "isotonic"])
def test_calibration_mends_what_is_too_sure_of_itself(method: str):
    rng = np.random.default_rng(0)
    x = rng.normal(size=(2000, 1))
    y = (rng.random(2000) < 1 / (1 + np.exp(-x[:, 0]))).astype(int)

    class TooSure(LogisticRegression):
        def decision_function(self, inputs):
            return 4.0 * super().decision_function(inputs)

        def predict_proba(self, inputs):
            logits = self.decision_function(inputs)
            return np.stack([1 / (1 + np.exp(logits)), 1 / (1 + np.exp(-logits))], axis=1)

    mended = calibrated(TooSure(), method).fit(x, y).predict_proba(np.array([[1.0]]))[0, 1]
    assert mended == pytest.approx(1 / (1 + np.exp(-1.0)), abs=0.06)


def test_folds_of_networks_are_trained_in_one_and_are_those_trained_alone():
    table = made_up_table(120)
    x, y = shot_inputs(table), goals(table)
    folds = repeated_stratified_folds(y, 3, 1)
    predictor = _quick("table_one")
    together = predict_folds(predictor, x, y, folds)
    for i, fold in enumerate(folds):
        alone = (
            clone(predictor).set_params(networkclassifier__random_state=i).fit(x[fold.train], y[fold.train])
        )
        np.testing.assert_allclose(alone.predict_proba(x[fold.test])[:, 1], together[i], atol=0.05)
    assert accuracies(together, y, folds).shape == (3,)
    judged = judge_repeats(together, y, folds, 1)[0]
    assert np.sum(judged.confusion) == 120
    assert judged.accuracy == pytest.approx(np.trace(judged.confusion) / 120)


def test_progress_is_told_fold_by_fold():
    table = made_up_table(60)
    told = []
    folds = repeated_stratified_folds(goals(table), 3, 1)
    predict_folds(quadratic(), shot_inputs(table), goals(table), folds, lambda: told.append(1))
    assert len(told) == 3


def test_a_network_holds_out_what_it_is_told_to():
    rng = np.random.default_rng(0)
    x = rng.normal(size=(60, 3))
    y = (x[:, 0] > 0).astype(int)
    held = np.arange(60) % 3 == 0
    # Held-out shots that say the opposite stop the training at once.
    opposite = np.where(held, 1 - y, y)
    one, same, other = (
        NetworkClassifier(warm_up=0, epochs=10).fit(x, labels, held_out=held).decision_function(x)
        for labels in (y, y, opposite)
    )
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 1e-6
    with pytest.raises(ValueError, match="held_out"):
        NetworkClassifier(**QUICK).fit(x, y, held_out=np.ones(60, dtype=bool))


def test_layers_of_a_network_are_a_parameter():
    network = NetworkClassifier(KIKS, **QUICK).fit(np.eye(30, 3), np.arange(30) % 2).network_
    assert [dense.out_features for dense in network.dense] == [8, 8, 1]


@needs_real_shots
@pytest.mark.slow
def test_the_best_predictor_reaches_its_figures_in_cross_validation_of_the_real_shots():
    train, _ = read_author_folder(REAL_SHOTS)
    x, y = shot_inputs(train), goals(train)
    folds = repeated_stratified_folds(y, 10, 10, seed=0)
    judged = judge_repeats(predict_folds(best_predictor(), x, y, folds), y, folds, 10)
    assert np.mean([one.accuracy for one in judged]) >= 0.905
    assert np.mean([one.log_loss for one in judged]) <= 0.225
