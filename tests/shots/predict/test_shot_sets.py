from pathlib import Path

import pyarrow as pa
import pytest

from robobt.shots.data.files import write_shots
from robobt.shots.data.schema import ShotDataError
from robobt.shots.predict.shot_sets import load_shot_sets
from tests.shots.made_up import made_up_table


def test_a_folder_holds_shots_to_train_and_to_test_on(tmp_path: Path):
    write_shots(made_up_table(120), tmp_path / "train.parquet")
    write_shots(made_up_table(60, seed=1), tmp_path / "test.csv")
    sets = load_shot_sets(tmp_path)
    assert (sets.train.num_rows, sets.test.num_rows) == (120, 60)
    assert sets.author is None
    (tmp_path / "test.csv").unlink()
    with pytest.raises(ShotDataError, match="test"):
        load_shot_sets(tmp_path)


def test_a_single_file_is_split_as_it_says_or_as_in_the_paper(tmp_path: Path):
    file = tmp_path / "shots.parquet"
    write_shots(made_up_table(80, split=True), file)
    sets = load_shot_sets(file)
    assert set(sets.test.column("early_stop_split").to_pylist()) == {"test"}
    assert (sets.train.num_rows, sets.test.num_rows) == (60, 20)
    write_shots(made_up_table(743), file)
    one, same, other = load_shot_sets(file), load_shot_sets(file), load_shot_sets(file, seed=1)
    assert (one.train.num_rows, one.test.num_rows) == (542, 201)
    drawn = [sets.test.column("robot_x").to_pylist() for sets in (one, same, other)]
    assert drawn[0] == drawn[1]
    assert drawn[0] != drawn[2]


def test_without_data_the_error_says_how_to_collect_some(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("robobt.shots.predict.shot_sets.models_folder", lambda: tmp_path)
    with pytest.raises(ShotDataError, match="robobt shots collect"):
        load_shot_sets()
    (tmp_path / "out").mkdir()
    write_shots(made_up_table(80, split=True), tmp_path / "out" / "paper_shots.parquet")
    assert load_shot_sets().train.num_rows == 60


def test_shots_to_test_on_only_are_refused(tmp_path: Path):
    table = made_up_table(20)
    at = table.schema.names.index("early_stop_split")
    write_shots(table.set_column(at, table.schema.field(at), pa.array(["test"] * 20)), tmp_path / "a.csv")
    with pytest.raises(ShotDataError, match="only"):
        load_shot_sets(tmp_path / "a.csv")
