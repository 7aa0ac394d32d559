from pathlib import Path

import numpy as np
import pytest
import torch

from robobt.models.card import ModelCard, ObservationCard, OutputEntry
from robobt.models.export import export_model
from robobt.models.policy import load_policy
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.predict.modules import as_module
from robobt.shots.predict.predictors import best_predictor, make_predictor
from robobt.world.features import SCENE_HEAD, SHOT_SCENE
from tests.shots.made_up import made_up_table

QUICK = {"networkclassifier__warm_up": 5, "networkclassifier__epochs": 5}
NAMES = ["table_one", "logistic_standardised", "quadratic", "quadratic_margin", "physics_margin", "set"]


@pytest.mark.parametrize("name", NAMES)
def test_an_exported_predictor_answers_what_was_fitted(name: str, tmp_path: Path):
    table = made_up_table(160)
    predictor = make_predictor(name)
    if name == "table_one":
        predictor.set_params(**QUICK)
    if name == "set":
        predictor.set_params(setnetworkclassifier__epochs=3, setnetworkclassifier__hidden=8)
    x = shot_inputs(table)
    fitted = predictor.fit(x, goals(table))
    card = ModelCard(
        kind="shot_predictor",
        name="made-up",
        skill="SelectShot",
        observation=ObservationCard.of(SHOT_SCENE),
        outputs=(OutputEntry(name="goal"),),
    )
    file = export_model(as_module(fitted), card, tmp_path)[0]
    np.testing.assert_allclose(load_policy(file)(x)[:, 0], fitted.predict_proba(x)[:, 1], atol=2e-4)


def test_the_worst_opponent_counts_and_those_behind_do_not():
    table = made_up_table(160)
    fitted = make_predictor("quadratic").fit(shot_inputs(table), goals(table))
    module = as_module(fitted)
    scenes = shot_inputs(made_up_table(30, seed=2, opponents=2))
    each = []
    for place in (0, 4):
        alone = scenes.copy()
        alone[:, SCENE_HEAD : SCENE_HEAD + 4] = scenes[:, SCENE_HEAD + place : SCENE_HEAD + place + 4]
        each.append(fitted.predict_proba(alone)[:, 1])
    with torch.no_grad():
        both = module(torch.tensor(scenes, dtype=torch.float32))[:, 0].numpy()
        scenes[:, SCENE_HEAD::4] = -np.abs(scenes[:, SCENE_HEAD::4])
        none = module(torch.tensor(scenes, dtype=torch.float32))[:, 0].numpy()
    np.testing.assert_allclose(both, np.minimum(*each), atol=1e-4)
    np.testing.assert_array_equal(none, 1.0)


def test_a_predictor_that_remembers_its_shots_has_no_such_form():
    table = made_up_table(60)
    x, y = shot_inputs(table), goals(table)
    for predictor in (make_predictor("gaussian_process"), best_predictor()):
        with pytest.raises(TypeError, match="no form"):
            as_module(predictor.fit(x, y))
