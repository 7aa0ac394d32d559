"""Shots with something wrong are left out and named; the others are used."""

from __future__ import annotations

import json
from pathlib import Path

import pyarrow as pa
import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.shots.data.files import read_shots, read_usable_shots, write_shots
from robobt.shots.data.schema import ShotDataError
from tests.shots.made_up import made_up_table

HEAD = "DistanceToGoal,AngleToGoal,RobotVx,RobotVy,OppX,OppY,OppVx,OppVy,Success"
GOOD = "3000,0.1,0,0,2490,-220,10,500,NO"

BAD = [
    ("3000,0.1,0,0,,-220,10,500,NO", "column 'OppX': is empty"),
    ("3000,0.1,0,0,far,-220,10,500,NO", "column 'OppX': 'far' is not a number"),
    ("3000,0.1,0,0,nan,-220,10,500,NO", "column 'OppX': 'nan' is not a number"),
    ("3000,0.1,0,0,1e999,-220,10,500,NO", "column 'OppX': '1e999' is not a number"),
    ("3,0.1,0,0,2490,-220,10,500,NO", "column 'DistanceToGoal': 3 is not a distance"),
    ("3000,0.1,0,0,2490,-220,10,500,PERHAPS", "column 'Success': 'PERHAPS' is neither YES nor NO"),
    ("3000,0.1,0,0,2490", "has 5 cells, the header 9"),
    ("3000,0.1,0,0,2490,-220,10,500,NO,9", "has 10 cells, the header 9"),
    ('3000,0.1,0,0,"2490"x,-220,10,500,NO', "',' expected after '\"'"),
]


def text(*rows: str) -> str:
    return "\n".join([HEAD, *rows, ""])


@pytest.mark.parametrize(("bad", "said"), BAD)
@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_a_shot_with_something_wrong_is_left_out_and_named(
    bad: str, said: str, line_end: str, tmp_path: Path
) -> None:
    file = tmp_path / "shots.csv"
    file.write_bytes(b"\xef\xbb\xbf" + text(GOOD, "", bad, GOOD).replace("\n", line_end).encode())
    read = read_usable_shots(file)
    assert read.rows == [2, 5]
    assert read.table.num_rows == 2
    (problem,) = read.problems.values()
    assert problem.startswith("row 4")
    assert said in problem


def test_a_quote_that_is_not_closed_costs_what_follows_it(tmp_path: Path) -> None:
    file = tmp_path / "shots.csv"
    file.write_text(text(GOOD, '"3000,0.1', GOOD))
    read = read_usable_shots(file)
    assert read.rows == [2]
    assert list(read.problems) == [3, 4]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (text(), "holds no shots"),
        (text(BAD[0][0], BAD[1][0]), "none of its 2 shots can be used; row 2, column 'OppX': is empty"),
        (text(GOOD).replace(",OppX", ",Opponent"), "has no column 'opp_x'"),
        (text(GOOD).replace("OppVx", "OppX"), "has column 'OppX' twice"),
        ("", "is empty"),
    ],
)
def test_a_file_without_a_shot_or_a_column_is_an_error(content: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "shots.csv"
    file.write_text(content)
    with pytest.raises(ShotDataError) as raised:
        read_usable_shots(file)
    assert str(raised.value).startswith(f"{file}: ")
    assert said in str(raised.value)


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_wrong_shots_of_our_own_tables_are_left_out(ending: str, tmp_path: Path) -> None:
    table, file = made_up_table(5), tmp_path / f"shots.{ending}"
    for name, values in (("success", [0, 1, 7, 0, 1]), ("distance_to_goal", [1.0, -1.0, 1.0, 1.0, 1.0])):
        index = table.schema.names.index(name)
        table = table.set_column(index, table.schema.field(index), pa.array(values))
    write_shots(table, file)
    read = read_usable_shots(file)
    assert read.rows == [2, 5, 6]
    assert [problem.partition(":")[0] for problem in read.problems.values()] == [
        "row 3, column 'distance_to_goal'",
        "row 4, column 'success'",
    ]


def score(*arguments: str) -> tuple[int, str, str]:
    shown = CliRunner().invoke(app, ["shots", "score", "--model", "shot_expected", *arguments])
    return shown.exit_code, shown.stdout, " ".join(shown.stderr.split())


@pytest.mark.integration
def test_a_predictor_is_judged_on_the_shots_that_give_what_it_needs(tmp_path: Path) -> None:
    lacking = "3000,0.1,0,0,2490,-220,,,NO"
    goal = GOOD.replace("NO", "YES")
    file = tmp_path / "test.csv"
    file.write_text(text(GOOD, lacking, goal, BAD[0][0], GOOD))
    for place in (file, tmp_path):
        code, out, said = score("--data", str(place), "--json")
        figures = json.loads(out)
        assert code == 0
        assert (figures["shots"], figures["goals"], figures["left_out"]) == (3, 1, 2)
        assert f"{file}: row 3: lacks 'opp_vx', 'opp_vy', which shot_expected needs to know" in said
        assert f"{file}: row 5, column 'OppX': is empty" in said
        assert said.endswith("2 of 5 shots are left out")
    file.write_text(text(lacking))
    code, _, said = score("--data", str(file))
    assert code == 1
    assert "none of its 1 shots can be used; row 2: lacks 'opp_vx'" in said
    file.write_text(text(GOOD, lacking))
    assert score("--data", str(file))[2].endswith("1 of 2 shots is left out")
    file.write_text(text(GOOD, *[lacking] * 30))
    code, out, said = score("--data", str(file))
    assert code == 0
    assert "1 shot" in out
    assert said.count("lacks") == 10
    assert said.endswith("30 of 31 shots are left out, 20 of them not named")


@pytest.mark.parametrize(
    ("column", "value", "problem"),
    [
        ("ball_x", 1722.0, "is no place on a field, in metres"),
        ("distance_to_goal", 3500.0, "is no place on a field, in metres"),
        ("robot_heading", 45.0, "is no angle, in radians"),
        ("angle_to_goal", -37.0, "is no angle, in radians"),
    ],
)
def test_shots_in_other_units_are_refused(tmp_path: Path, column: str, value: float, problem: str) -> None:
    table = made_up_table(3)
    file = tmp_path / "shots.parquet"
    values = table.column(column).to_pylist()
    values[1] = value
    write_shots(table.set_column(table.schema.names.index(column), column, pa.array(values)), file)
    with pytest.raises(ShotDataError, match=f"row 3, column '{column}': {value} {problem}"):
        read_shots(file)
