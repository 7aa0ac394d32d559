import pytest

from benchmarks.shots import bench_cross_validation, bench_goal_line
from robobt.shots.data import goals, shot_inputs
from tests.shots.made_up import made_up_table, train_quickly

pytestmark = pytest.mark.integration


def test_networks_are_trained_at_once_and_one_after_the_other(monkeypatch: pytest.MonkeyPatch):
    train_quickly(monkeypatch)
    table = made_up_table(60)
    trained: list[int] = []
    figures = bench_cross_validation(
        shot_inputs(table), goals(table), networks=2, progress=lambda: trained.append(1)
    )
    assert figures.networks == len(trained) == 2
    assert figures.cross_validation_speedup == pytest.approx(
        figures.cross_validation_loop_s / figures.cross_validation_s
    )


def test_the_goal_line_is_judged_faster_in_one_call():
    figures = bench_goal_line()
    assert (figures.points, figures.opponents) == (94, 6)
    assert figures.goal_line_speedup > 2.0
