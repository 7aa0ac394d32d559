import math

import numpy as np
import pyarrow as pa
import pytest
import torch

from robobt.shots.data.author_data import author_inputs, read_author_folder
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.data.schema import SCHEMA, complete_row
from robobt.shots.predict.features import FEATURES, ShotFeatures
from robobt.world.features import ABSENT, SCENE_HEAD, SHOT_SCENE, shot_features
from tests.shots.made_up import made_up_table
from tests.shots.real_data import REAL_SHOTS, needs_real_shots


def test_scenes_of_recorded_shots_are_those_of_the_playing_field():
    table = made_up_table(20, opponents=3)
    scenes, rows = shot_inputs(table), table.to_pylist()
    assert scenes.shape == (20, SHOT_SCENE.size)
    assert np.isfinite(scenes).all()
    assert goals(table).tolist() == [row["success"] for row in rows]
    for scene, row in zip(scenes, rows, strict=True):
        assert scene[0] == pytest.approx(row["distance_to_goal"])
        # The opponent that matters comes first.
        expected = [row[name] for name in ("opp_x", "opp_y", "opp_vx", "opp_vy")]
        assert scene[SCENE_HEAD : SCENE_HEAD + 4] == pytest.approx(expected)
        assert tuple(scene[-4:]) == ABSENT


def test_shots_without_field_coordinates_have_the_scene_of_their_shot_frame():
    table = made_up_table(20)
    whole = shot_inputs(table)
    bare = table
    for name in ("robot_x", "robot_y", "target_x", "target_y"):
        bare = bare.set_column(bare.schema.names.index(name), name, pa.array([math.nan] * 20))
    part = shot_inputs(bare)
    known = np.isfinite(part)
    np.testing.assert_allclose(part[known], whole[known], atol=1e-12)
    assert known[:, [0, 1, 4, 5]].all()
    assert known[:, SCENE_HEAD:].all()
    assert not known[:, 6].any()


def test_rows_with_different_numbers_of_opponents_keep_their_places():
    tables = [made_up_table(3, seed, opponents=n) for seed, n in enumerate((1, 2))]
    mixed = pa.Table.from_pylist(
        [row for pair in zip(*(t.to_pylist() for t in tables), strict=True) for row in pair], schema=SCHEMA
    )
    np.testing.assert_array_equal(shot_inputs(mixed)[::2], shot_inputs(tables[0]))
    np.testing.assert_array_equal(shot_inputs(mixed)[1::2], shot_inputs(tables[1]))


def test_a_shot_at_an_empty_goal_has_absent_opponents():
    shot = {"robot_x": 1.0, "robot_y": 0.0, "target_x": 4.5, "target_y": 0.2, "success": 1}
    scene = shot_inputs(pa.Table.from_pylist([complete_row(shot)], schema=SCHEMA))[0]
    assert tuple(scene[SCENE_HEAD : SCENE_HEAD + 4]) == ABSENT


def test_the_papers_features_are_eq_4_in_millimetres():
    table = made_up_table(10)
    row = table.to_pylist()[3]
    eq4 = shot_features(
        np.array([row["robot_x"], row["robot_y"]]),
        np.array([[row["target_x"], row["target_y"]]]),
        np.array([[row["opp_x_global"], row["opp_y_global"]]]),
    )[0, 0]
    ours = ShotFeatures("paper").fit_transform(shot_inputs(table))[3]
    assert ours == pytest.approx(eq4 * [1.0, 1e3, 1e3, 1e3, 1e3])
    np.testing.assert_allclose(author_inputs(table)[3], ours)


@pytest.mark.parametrize("name", FEATURES)
def test_features_are_the_same_for_numpy_and_torch_and_for_a_mirrored_shot(name: str):
    scenes = shot_inputs(made_up_table(20))
    head, block = scenes[:, :SCENE_HEAD], scenes[:, SCENE_HEAD : SCENE_HEAD + 4]
    ours = FEATURES[name](np, head, block)
    theirs = FEATURES[name](torch, torch.tensor(head), torch.tensor(block))
    np.testing.assert_allclose(ours, theirs.numpy(), rtol=1e-12)
    np.testing.assert_allclose(ours, FEATURES[name](np, head, block * [1, -1, 1, -1]), rtol=1e-12)


def test_features_refuse_what_is_no_scene():
    with pytest.raises(ValueError, match="34"):
        ShotFeatures().fit(np.zeros((3, 5)))
    with pytest.raises(ValueError, match="nonsense"):
        ShotFeatures("nonsense").fit(np.zeros((3, SHOT_SCENE.size)))
    with pytest.raises(ValueError, match="inf"):
        ShotFeatures().fit(np.full((3, SHOT_SCENE.size), np.inf))


@needs_real_shots
def test_the_features_of_the_real_shots_are_the_authors():
    for table in read_author_folder(REAL_SHOTS):
        scenes = shot_inputs(table)
        ours = ShotFeatures("paper").fit_transform(scenes)
        np.testing.assert_allclose(ours, author_inputs(table), atol=1e-3)
        speeds = ShotFeatures("motion").fit_transform(scenes)[:, 3]
        np.testing.assert_allclose(speeds, table.column("v_towards_ball").to_numpy(), atol=1e-6)
