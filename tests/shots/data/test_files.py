from __future__ import annotations

import math
import random
import resource
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from robobt.shots.data.files import csv_text, read_shots, write_shots
from robobt.shots.data.schema import SCHEMA, ShotDataError, complete_row
from tests.campaign import count
from tests.mutation import mutated
from tests.shots.real_data import REAL_SHOTS, needs_real_shots

AUTHOR = """DistanceToGoal,AngleToGoal,DistanceToOpp,OppX,OppY,OppVx,OppVy,VTowardsBall,Success
3000,0.1,2500,2490,-220,10,500,500,NO
2000,-0.2,1500,1490,170,0,-300,300,YES
"""


def _row(**change: object) -> dict[str, object]:
    shot = {"robot_x": 1.0, "robot_y": 0.0, "target_x": 4.5, "target_y": 0.2, "success": 1}
    shot |= {"opponents_x": [4.2, 3.0], "opponents_y": [0.1, -1.0], "scenario": "motion, close", "seed": 7}
    return complete_row(shot | change)


@pytest.fixture
def table() -> pa.Table:
    return pa.Table.from_pylist([_row(), _row(success=0, opponents_x=[], opponents_y=[])], schema=SCHEMA)


@pytest.mark.parametrize("ending", ["parquet", "csv"])
def test_what_was_written_is_read_back(table: pa.Table, tmp_path: Path, ending: str):
    file = tmp_path / f"shots.{ending}"
    write_shots(table, file)
    for ours, theirs in zip(table.to_pylist(), read_shots(file).to_pylist(), strict=True):
        for name, value in ours.items():
            assert theirs[name] == value or math.isnan(theirs[name]), name
    assert [path.name for path in tmp_path.iterdir()] == [file.name]


@pytest.mark.parametrize("ending", ["parquet", "csv"])
def test_a_file_from_before_goalkeepers_had_kinds_is_read(table: pa.Table, tmp_path: Path, ending: str):
    file = tmp_path / f"shots.{ending}"
    if ending == "parquet":
        pq.write_table(table.drop_columns(["goalkeeper"]), file)
    else:
        rows = [line.split(",") for line in csv_text(table.to_pylist()).splitlines()]
        place = rows[0].index("goalkeeper")
        # The scenario's name, with a comma in it, comes before: counted from the end.
        lines = [",".join([*row[: place - len(rows[0])], *row[place - len(rows[0]) + 1 :]]) for row in rows]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert read_shots(file).column("goalkeeper").to_pylist() == ["", ""]


def test_parquet_keeps_units_and_descriptions(table: pa.Table, tmp_path: Path):
    write_shots(table, tmp_path / "shots.parquet")
    field = pq.read_schema(tmp_path / "shots.parquet").field("opp_vy")
    assert field.metadata[b"unit"] == b"m/s"
    assert b"velocity" in field.metadata[b"description"]


def test_the_authors_files_are_millimetres_with_yes_and_no(tmp_path: Path):
    file = tmp_path / "author.csv"
    file.write_text(AUTHOR)
    rows = read_shots(file).to_pylist()
    assert [row["success"] for row in rows] == [0, 1]
    assert rows[0]["distance_to_goal"] == pytest.approx(3.0)
    assert rows[0]["opp_y"] == pytest.approx(-0.22)
    assert rows[0]["angle_to_goal"] == pytest.approx(0.1)
    assert rows[1]["opp_vy"] == pytest.approx(-0.3)
    assert math.isnan(rows[0]["robot_x"])


def test_derived_columns_that_a_file_lacks_are_worked_out(tmp_path: Path):
    file = tmp_path / "author.csv"
    file.write_text("distance_to_goal;opp_x;opp_y;opp_vy;success\n3000;2000;-300;400;1\n")
    row = read_shots(file).to_pylist()[0]
    assert row["distance_to_opp"] == pytest.approx(math.hypot(2.0, 0.3))
    assert row["v_towards_ball"] == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("2490", "abc", ["row 2", "'OppX'", "abc"]),
        ("170", "nan", ["row 3", "'OppY'", "number"]),
        ("1490", "", ["row 3", "'OppX'", "empty"]),
        ("YES", "MAYBE", ["row 3", "'Success'", "YES nor NO"]),
        ("2000,", "2.0,", ["row 3", "'DistanceToGoal'", "mm"]),
        (",Success", ",Won", ["success"]),
        ("OppVx", "OppX", ["'OppX'", "twice"]),
        ("OppVx", "opp_x", ["'OppX'", "'opp_x'", "both"]),
        (",YES", ",YES,1", ["row 3", "10 cells"]),
    ],
)
def test_a_bad_file_is_one_error_that_names_file_row_and_column(
    tmp_path: Path, old: str, new: str, words: list[str]
):
    file = tmp_path / "author.csv"
    file.write_text(AUTHOR.replace(old, new))
    with pytest.raises(ShotDataError) as caught:
        read_shots(file)
    assert "\n" not in str(caught.value)
    for word in [file.name, *words]:
        assert word in str(caught.value)


def test_bad_cells_of_our_own_csv_are_named(table: pa.Table, tmp_path: Path):
    file = tmp_path / "shots.csv"
    write_shots(table, file)
    good = file.read_text()
    for old, new, word in [
        ("4.2;3.0", "4.2;x", "opponents_x"),
        ("\n1,", "\n9,", "schema_version"),
        (",seed,", ",saat,", "seed"),
        (",7,", ",x,", "seed"),
    ]:
        file.write_text(good.replace(old, new))
        with pytest.raises(ShotDataError, match=word):
            read_shots(file)


@pytest.mark.parametrize("name", ["none.csv", "none.parquet", "text.parquet", "empty.csv", "bytes.csv", "."])
def test_files_that_hold_no_shots_are_refused_by_name(tmp_path: Path, name: str):
    (tmp_path / "text.parquet").write_text("no parquet")
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "bytes.csv").write_bytes(bytes(range(256)))
    with pytest.raises(ShotDataError, match=str(tmp_path)):
        read_shots(tmp_path / name)


@pytest.mark.parametrize("name", ["none.csv", "none.parquet"])
def test_a_file_that_is_not_there_is_told(tmp_path: Path, name: str):
    with pytest.raises(ShotDataError, match=f"{name}: No such file"):
        read_shots(tmp_path / name)


def test_a_parquet_file_of_another_table_is_refused(table: pa.Table, tmp_path: Path):
    file = tmp_path / "shots.parquet"
    pq.write_table(table.drop_columns(["opp_x"]), file)
    with pytest.raises(ShotDataError, match="opp_x"):
        read_shots(file)
    bad = table.set_column(table.schema.names.index("success"), "success", pa.array([1, 5]))
    pq.write_table(bad, file)
    with pytest.raises(ShotDataError, match=r"row 3.*success"):
        read_shots(file)
    with pytest.raises(ValueError, match="SCHEMA"):
        write_shots(table.drop_columns(["opp_x"]), file)


@needs_real_shots
def test_the_real_shots_are_read():
    train, test = read_shots(REAL_SHOTS / "train.csv"), read_shots(REAL_SHOTS / "test.csv")
    assert (train.num_rows, test.num_rows) == (542, 201)
    assert sum(train.column("success").to_pylist()) == 165
    assert sum(test.column("success").to_pylist()) == 79
    assert train.column("early_stop_split").to_pylist().count("valid") == 179
    assert set(np.round(train.column("tolerance").drop_null().to_numpy(), 4)) >= {
        0.1965,
        0.243,
        0.3645,
        0.486,
    }


@needs_real_shots
def test_the_real_shots_own_coordinates_give_their_shot_frame():
    train = read_shots(REAL_SHOTS / "train.csv")
    row = train.to_pylist()[0]
    mine = complete_row(
        {name: row[name] for name in ("robot_x", "robot_y", "target_x", "target_y", "success")}
        | {name: row[name] for name in ("opponents_x", "opponents_y", "opponents_vx", "opponents_vy")}
    )
    for name in (
        "angle_to_goal",
        "distance_to_goal",
        "distance_to_opp",
        "opp_x",
        "opp_y",
        "opp_vx",
        "opp_vy",
    ):
        assert mine[name] == pytest.approx(row[name], abs=1e-5)
    assert mine["v_towards_ball"] == pytest.approx(row["v_towards_ball"], abs=1e-5)


def test_of_the_goalkeepers_speed_and_its_component_either_gives_the_other(tmp_path: Path):
    file = tmp_path / "author.csv"
    file.write_text(
        "distance_to_goal,opp_x,opp_y,opp_vx,opp_vy,v_towards_ball,success\n"
        "3000,2500,-400,10,250,,YES\n3000,2500,400,10,,-250,NO\n3000,2500,0,10,250,,NO\n"
    )
    table = read_shots(file)
    assert table.column("v_towards_ball").to_pylist() == [0.25, -0.25, 0.0]
    assert table.column("opp_vy").to_pylist() == [0.25, 0.25, 0.25]


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["parquet", "csv", "author.csv"])
def test_mutated_shots_are_read_or_refused(ending: str, tmp_path: Path) -> None:
    rng, read = random.Random(21), 0
    path = tmp_path / f"shots.{ending}"
    if ending == "author.csv":
        path.write_text(AUTHOR)
    else:
        write_shots(pa.Table.from_pylist([_row(seed=seed) for seed in range(20)], schema=SCHEMA), path)
    original = path.read_bytes()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(count(10_000)):
        path.write_bytes(mutated(original, rng))
        begun = time.process_time()
        try:
            read += read_shots(path).num_rows > 0
        except ShotDataError as error:
            said = str(error)
            assert said.startswith(str(path))
            assert "\n" not in said
        assert time.process_time() - begun < 10.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000
    print(f"{read} of {count(10_000)} were read")
