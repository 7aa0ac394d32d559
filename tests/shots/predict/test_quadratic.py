import numpy as np
import pytest
import torch

from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.predict import best_predictor
from robobt.shots.predict.quadratic import QuadraticShot
from robobt.world.features import SCENE_HEAD
from tests.shots.made_up import made_up_table

SCENES = shot_inputs(made_up_table(300))
FITTED = best_predictor().fit(SCENES, goals(made_up_table(300)))
NETWORK = QuadraticShot(FITTED, SCENES)


def answers(scenes: np.ndarray) -> np.ndarray:
    with torch.inference_mode():
        return NETWORK(torch.tensor(scenes, dtype=torch.float32)).numpy()[:, 0]


def test_it_answers_as_the_fitted_predictor_does():
    differences = np.abs(answers(SCENES) - FITTED.predict_proba(SCENES)[:, 1])
    assert np.median(differences) < 1e-5
    assert np.quantile(differences, 0.95) < 0.02


def test_a_goalkeeper_nearer_to_the_line_never_makes_a_shot_better():
    scenes = np.repeat(SCENES[:20], 30, axis=0)
    side = np.sign(scenes[:, SCENE_HEAD + 1])
    scenes[:, SCENE_HEAD + 1] = side * np.tile(np.linspace(0.01, 1.2, 30), 20)
    assert (np.diff(answers(scenes).reshape(20, 30)) >= -1e-5).all()


def test_one_opponent_more_never_makes_a_shot_better():
    more = SCENES.copy()
    more[:, SCENE_HEAD + 4 : SCENE_HEAD + 8] = np.roll(SCENES[:, SCENE_HEAD : SCENE_HEAD + 4], 1, axis=0)
    assert (answers(more) <= answers(SCENES) + 1e-6).all()


@pytest.mark.parametrize("entry", [0, SCENE_HEAD, SCENE_HEAD + 1])
def test_far_from_all_shots_it_still_answers_a_probability(entry: int):
    far = SCENES.copy()
    far[:, entry] = 1e4
    assert ((answers(far) >= 0.0) & (answers(far) <= 1.0)).all()
