import math

import numpy as np
import pyarrow as pa
import pytest

from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.data.schema import SCHEMA, complete_row
from robobt.world.features import ABSENT, SCENE_HEAD, SHOT_SCENE
from tests.shots.made_up import made_up_table


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
