import math

import numpy as np
import pyarrow as pa
import pytest

from robobt.shots.data.schema import (
    RECORDED,
    SCHEMA,
    SHOT_COLUMNS,
    SHOTS_VERSION,
    complete_row,
    nearest_to_line,
)

SHOT = {
    "robot_x": 1.0,
    "robot_y": 1.0,
    "robot_heading": math.pi / 2,
    "robot_field_vx": 0.5,
    "robot_field_vy": 0.0,
    "ball_x": 1.0,
    "ball_y": 1.1,
    "target_x": 1.0,
    "target_y": 4.0,
    "opponents_x": [0.6, 4.0],
    "opponents_y": [3.0, 3.0],
    "opponents_vx": [0.3, 0.0],
    "opponents_vy": [0.1, 0.0],
    "success": 1,
}


def test_the_shot_frame_is_worked_out_from_the_field_frame():
    row = complete_row(SHOT)
    assert row["schema_version"] == SHOTS_VERSION
    assert row["angle_to_goal"] == pytest.approx(math.pi / 2)
    assert row["distance_to_goal"] == pytest.approx(3.0)
    assert (row["opp_x"], row["opp_y"]) == pytest.approx((2.0, 0.4))
    assert row["distance_to_opp"] == pytest.approx(math.hypot(2.0, 0.4))
    assert (row["robot_vx"], row["robot_vy"]) == pytest.approx((0.0, -0.5))
    assert (row["ball_forward"], row["ball_left"]) == pytest.approx((0.1, 0.0))


def test_an_opponent_that_moves_to_the_line_has_a_positive_speed_towards_it():
    row = complete_row(SHOT)
    # It stands left of the shot and moves right.
    assert (row["opp_vx"], row["opp_vy"]) == pytest.approx((0.1, -0.3))
    assert row["v_towards_ball"] == pytest.approx(0.3)


def test_what_was_not_recorded_is_unknown():
    row = complete_row(
        {name: SHOT[name] for name in ("robot_x", "robot_y", "target_x", "target_y", "success")}
    )
    assert math.isnan(row["opp_x"])
    assert math.isnan(row["ball_forward"])
    assert row["opponents_x"] == []
    assert row["seed"] == -1


def test_a_row_fits_the_table_and_columns_say_what_they_are():
    table = pa.Table.from_pylist([complete_row(SHOT)], schema=SCHEMA)
    assert table.num_rows == 1
    assert table.schema.field("opp_y").metadata[b"unit"] == b"m"
    assert all(column.meaning for column in SHOT_COLUMNS)
    assert set(SCHEMA.names) >= RECORDED


@pytest.mark.parametrize(("change", "word"), [({"robot_z": 1.0}, "robot_z"), ({"success": None}, "success")])
def test_a_column_too_many_or_too_few_is_named(change: dict[str, object], word: str):
    shot = {k: v for k, v in (SHOT | change).items() if v is not None}
    with pytest.raises(ValueError, match=word):
        complete_row(shot)


def test_the_opponent_nearest_to_the_segment_is_the_one_that_matters():
    # The third lies on the line, but behind the target.
    assert nearest_to_line([0, 0], [3, 0], [[1.0, 0.5], [2.0, -0.3], [5.0, 0.0]]) == 1
    assert nearest_to_line([0, 0], [0, 0], np.array([[1.0, 0.0], [0.5, 0.0]])) == 1
