from __future__ import annotations

import json

import pytest

from benchmarks.train import compare, table_of
from robobt.learning.agents.networks import Actor
from robobt.learning.training.results import Validation, first_reaching, summary_of
from robobt.learning.training.run_folder import load_run
from robobt.learning.training.selection import Selection
from robobt.learning.training.setting_groups import EvaluationSettings
from robobt.learning.training.settings import SettingsError, load_settings
from robobt.learning.training.train import train_seeds

SHORT = {
    "steps": 256,
    "agent.hidden_sizes": [8],
    "replay.batch_size": 16,
    "collection.random_steps": 64,
    "collection.learning_starts": 64,
    "evaluation.every": 128,
    "evaluation.starts": 4,
    "evaluation.held_out": 4,
    "rebuild_every": 128,
    "tensorboard": False,
}


def at(steps, success, time_ratio=None, mean_time=1.0):
    return Validation(steps, 0, success, mean_time, time_ratio, 0.0, steps / 100, 0.0, 0.0, 0.0)


def test_the_first_evaluation_at_the_bar_is_found():
    run = [
        at(1, 0.9, 1.0),
        at(2, 1.0, 1.2),
        at(3, 0.99, 1.03),
        at(4, 1.0, 1.01),
    ]
    assert first_reaching(run, 0.99) == run[1]
    assert first_reaching(run, 0.99, 1.04) == run[2]
    assert first_reaching(run, 1.0, 1.005) is None
    assert first_reaching([at(1, 1.0, None, 0.6), at(2, 1.0, None, 0.4)], 0.98, 0.45).steps == 2


@pytest.mark.parametrize(("enough", "best"), [(1.0, 1), (0.99, 3)])
def test_of_those_that_succeed_often_enough_the_quickest_is_the_best(enough, best):
    run = [at(1, 1.0, None, 3.3), at(2, 0.98, None, 3.0), at(3, 0.994, None, 3.1), at(4, 0.996, None, 3.2)]
    selection = Selection(EvaluationSettings(enough=enough))
    for validation in run:
        selection.add(validation, Actor([1.0], 1, [2]))
    assert selection.best == run[best - 1]
    again = Selection(EvaluationSettings(enough=enough))
    again.restore(selection.state(), selection.weights)
    assert again.best == selection.best


@pytest.mark.slow
def test_seeds_side_by_side_come_to_what_they_come_to_one_after_the_other(tmp_path, curves):
    settings = load_settings("go_to_ball", changes=SHORT)
    shown = []
    beside = train_seeds(settings, [0, 1], tmp_path / "two", workers=2, on_progress=shown.append)
    after = train_seeds(settings, [0, 1], tmp_path / "one", workers=1)
    assert [r.figures["weights"] for r in beside] == [r.figures["weights"] for r in after]
    assert {progress.seed for progress in shown} == {0, 1}
    assert (tmp_path / "two" / "curves.png").read_bytes().startswith(b"\x89PNG")
    figures = json.loads((tmp_path / "two" / "result.json").read_text())
    assert figures["seeds"] == [0, 1]
    assert figures["success"].keys() == {"median", "low", "high"}
    assert load_run(tmp_path / "two" / "seed_1").settings.seed == 1


@pytest.mark.integration
def test_seeds_that_have_ended_are_kept_and_new_ones_added(tmp_path):
    settings = load_settings("go_to_ball", changes=SHORT)
    first = train_seeds(settings, [0], tmp_path)
    both = train_seeds(settings, [0, 1], tmp_path, resume=True)
    assert both[0].figures == first[0].figures
    assert summary_of(both)["seeds"] == [0, 1]


def test_nothing_to_train_is_refused(tmp_path):
    settings = load_settings("go_to_ball", changes=SHORT)
    with pytest.raises(ValueError, match="needs seeds"):
        train_seeds(settings, [], tmp_path)


@pytest.mark.integration
def test_a_comparison_is_a_table_and_is_taken_up_again(tmp_path):
    only = ["fast", "twin critics"]
    figures = compare("go_to_ball", tmp_path, [0], only, SHORT)
    assert list(figures) == only
    table = (tmp_path / "comparison.md").read_text()
    assert table == table_of(figures)
    assert table.splitlines()[0].startswith("| setting | CPU s to 99 % |")
    assert "| twin critics |" in table
    before = (tmp_path / "fast" / "seed_0" / "result.json").stat().st_mtime_ns
    again = compare("go_to_ball", tmp_path, [0], only, SHORT)
    assert again == figures == json.loads((tmp_path / "comparison.json").read_text())["variants"]
    assert (tmp_path / "fast" / "seed_0" / "result.json").stat().st_mtime_ns == before


def test_an_unknown_variant_is_told_with_those_there_are(tmp_path):
    with pytest.raises(SettingsError, match="no variant is called 'magic'; there are fast, "):
        compare("go_to_ball", tmp_path, [0], ["magic"])
    with pytest.raises(SettingsError, match="has no switches of 'dance'"):
        compare("dance", tmp_path, [0])
