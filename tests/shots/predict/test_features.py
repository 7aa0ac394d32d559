import numpy as np
import pytest

from robobt.shots.data import read_shots, shot_inputs
from robobt.shots.predict.predictors import motion_features, pair_features
from robobt.world.features import SCENE_HEAD, SHOT_SCENE, shot_features
from tests.shots.made_up import made_up_table
from tests.shots.real_data import REAL_SHOTS, needs_real_shots


def test_the_pair_features_are_those_of_the_rater():
    table = made_up_table(10)
    row = table.to_pylist()[3]
    eq4 = shot_features(
        np.array([row["robot_x"], row["robot_y"]]),
        np.array([[row["target_x"], row["target_y"]]]),
        np.array([[row["opp_x_global"], row["opp_y_global"]]]),
    )[0, 0]
    scenes = shot_inputs(table)
    assert pair_features(scenes)[3] == pytest.approx(eq4)


@pytest.mark.parametrize("features", [pair_features, motion_features])
def test_a_mirrored_shot_has_the_same_features(features):
    scenes = shot_inputs(made_up_table(20))
    mirrored = scenes.copy()
    mirrored[:, SCENE_HEAD + 1 :: 2] *= -1.0
    np.testing.assert_array_equal(features(scenes), features(mirrored))


def test_features_of_something_else_than_scenes_are_refused():
    with pytest.raises(ValueError, match=f"{SHOT_SCENE.size} entries"):
        pair_features(np.zeros((3, 5)))


@needs_real_shots
@pytest.mark.parametrize("name", ["train.csv", "test.csv"])
def test_the_features_of_the_real_shots_are_the_authors(name: str):
    table = read_shots(REAL_SHOTS / name)
    x, across = table.column("opp_x").to_numpy(), table.column("opp_y").to_numpy()
    theirs = [
        np.abs(np.arctan2(across, x)),
        *(table.column(column).to_numpy() for column in ("distance_to_goal", "distance_to_opp")),
        x,
        np.abs(across),
    ]
    scenes = shot_inputs(table)
    np.testing.assert_allclose(pair_features(scenes), np.stack(theirs, axis=-1), atol=1e-6)
    speeds = motion_features(scenes)[:, 3]
    np.testing.assert_allclose(speeds, table.column("v_towards_ball").to_numpy(), atol=1e-6)
