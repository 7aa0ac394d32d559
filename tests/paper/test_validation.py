import numpy as np
import pytest
from sklearn.base import clone
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer

from paper.predictors import paper_features
from paper.validation import accuracies, judge_repeats, predict_folds
from robobt.shots import NetworkClassifier, best_predictor, goals, read_shots, shot_inputs, stratified_folds
from tests.shots.made_up import QUICK, made_up_table
from tests.shots.real_data import REAL_SHOTS, needs_real_shots

pytestmark = pytest.mark.integration


def test_the_folds_of_a_network_trained_at_once_are_those_trained_alone():
    table = made_up_table(120)
    x, y = shot_inputs(table), goals(table)
    folds = stratified_folds(y, 1)
    predictor = make_pipeline(FunctionTransformer(paper_features), NetworkClassifier(QUICK))
    together = predict_folds(predictor, x, y, folds)
    for i, (train, test) in enumerate(folds[:3]):
        alone = clone(predictor).set_params(networkclassifier__random_state=i).fit(x[train], y[train])
        np.testing.assert_allclose(alone.predict_proba(x[test])[:, 1], together[i], atol=0.05)
    assert accuracies(together, y, folds).shape == (10,)
    judged = judge_repeats(together, y, folds)[0]
    assert np.sum(judged.confusion) == judged.shots == 120
    assert judged.accuracy == pytest.approx(np.trace(judged.confusion) / 120)


@needs_real_shots
@pytest.mark.parametrize(
    ("repeats", "accuracy", "log_loss"),
    # A single repeat is up to a hundredth off the mean of ten.
    [(1, 0.895, 0.235), pytest.param(10, 0.905, 0.225, marks=pytest.mark.slow)],
    ids=["once", "ten times"],
)
def test_the_best_predictor_reaches_its_figures_in_cross_validation_of_the_real_shots(
    repeats: int, accuracy: float, log_loss: float
):
    train = read_shots(REAL_SHOTS / "train.csv")
    x, y = shot_inputs(train), goals(train)
    folds = stratified_folds(y, repeats)
    judged = judge_repeats(predict_folds(best_predictor(), x, y, folds), y, folds)
    assert np.mean([one.accuracy for one in judged]) >= accuracy
    assert np.mean([one.log_loss for one in judged]) <= log_loss
