import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from paper.reliability_diagram import draw_reliability
from paper.table2 import table2
from paper.table3 import table3
from robobt.shots.data.files import write_shots
from robobt.shots.data.schema import ShotDataError
from robobt.shots.predict.shot_sets import load_shot_sets
from robobt.statistics import ReliabilityBin
from tests.shots.made_up import made_up_table, train_quickly
from tests.shots.real_data import REAL_SHOTS, needs_real_shots


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_shots(made_up_table(120), tmp_path / "train.parquet")
    write_shots(made_up_table(60, seed=1), tmp_path / "test.csv")
    return tmp_path


@pytest.mark.integration
def test_table_3_judges_every_model_on_the_test_shots(folder: Path, monkeypatch: pytest.MonkeyPatch):
    train_quickly(monkeypatch)
    told: list[int] = []
    models = ["table_one", "logistic", "best"]
    result = table3(
        load_shot_sets(folder), seeds=3, repeats=1, models=models, progress=lambda: told.append(1)
    )
    assert list(result.models) == models
    assert len(told) == 3
    for one in result.models.values():
        assert np.sum(one.confusion) == 60
        assert one.low <= one.accuracy <= one.high
        assert one.accuracy == pytest.approx(100 * np.trace(one.confusion) / 60)
        assert sum(row.trials for row in one.reliability) == 60
        assert one.cross_validation is not None
        assert one.cross_validation.accuracy > 50.0
    paired, retrained = result.models["logistic"].mcnemar, result.retrained
    assert paired is not None
    assert paired.against == "table_one"
    assert retrained is not None
    assert retrained.least <= retrained.median <= retrained.most
    assert retrained.median == pytest.approx(result.models["table_one"].accuracy)
    json.dumps(asdict(result), allow_nan=False)


def test_table_3_without_cross_validation_and_without_the_network(folder: Path):
    result = table3(load_shot_sets(folder), repeats=0, models=["best"])
    assert result.retrained is None
    assert result.models["best"].cross_validation is None
    assert result.models["best"].mcnemar is None


def test_table_3_refuses_data_with_too_few_goals(tmp_path: Path):
    few = made_up_table(60)
    rows = few.to_pylist()
    for row in rows[:-3]:
        row["success"] = 0
    write_shots(pa.Table.from_pylist(rows, schema=few.schema), tmp_path / "shots.parquet")
    with pytest.raises(ShotDataError, match="goals"):
        table3(load_shot_sets(tmp_path / "shots.parquet"), seeds=1, repeats=0, models=["logistic"])


@pytest.mark.integration
def test_table_2_compares_the_network_with_both_regressions(folder: Path, monkeypatch: pytest.MonkeyPatch):
    train_quickly(monkeypatch)
    monkeypatch.setattr("paper.table2.REPEATS", 1)
    monkeypatch.setattr("paper.table2.HOLD_OUTS", (0.33,))
    result = table2(load_shot_sets(folder), replications=1)
    assert list(result.hold_outs) == ["33%"]
    for found in result.hold_outs.values():
        for accuracy in (found.network, found.logistic, found.standardised):
            assert 50.0 < accuracy.mean <= 100.0
        assert found.test_logistic.difference == pytest.approx(found.network.mean - found.logistic.mean)
        assert 0.0 <= found.test_standardised.p <= 1.0
    assert result.hold_outs["33%"].paper.network == 87.4024
    json.dumps(asdict(result), allow_nan=False)


def test_a_reliability_diagram_is_a_picture(tmp_path: Path):
    bins = [ReliabilityBin(0.2, 0.3, 5, 0.2, 0.1), ReliabilityBin(0.8, 0.9, 9, 0.8, 0.9)]
    file = tmp_path / "new" / "diagram.png"
    draw_reliability({"model": bins}, "title", file)
    assert file.read_bytes().startswith(b"\x89PNG")
    assert [path.name for path in file.parent.iterdir()] == ["diagram.png"]
    with pytest.raises(ValueError, match="format"):
        draw_reliability({"model": bins}, "title", tmp_path / "diagram.nonsense")


@needs_real_shots
def test_the_authors_weights_give_the_published_confusion_matrix():
    sets = load_shot_sets(REAL_SHOTS)
    assert sets.author is not None
    assert table3(sets, repeats=0, models=[]).models["author"].confusion == [[102, 20], [10, 69]]


@needs_real_shots
@pytest.mark.slow
def test_retraining_with_the_papers_recipe_gives_the_papers_accuracy():
    result = table3(load_shot_sets(REAL_SHOTS), seeds=100, repeats=0, models=["table_one"])
    assert result.retrained is not None
    assert 84.7 <= result.retrained.mean <= 85.8


@needs_real_shots
@pytest.mark.slow
def test_table_2_of_the_real_shots_is_that_of_the_paper():
    result = table2(load_shot_sets(REAL_SHOTS), replications=10)
    for found in result.hold_outs.values():
        assert 86.8 <= found.network.mean <= 87.6
        assert 84.4 <= found.logistic.mean <= 84.7
