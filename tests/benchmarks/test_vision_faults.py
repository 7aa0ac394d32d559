"""The figures of the vision's faults are within their bars, and measure what they say."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import vision_faults as faults

pytestmark = pytest.mark.integration


@pytest.mark.slow
def test_every_fault_costs_little() -> None:
    for title, sent in faults.CASES.items():
        worst = faults.largest(faults.played(), sent(np.random.default_rng(1)))
        assert worst["ball"] < 0.03, title
        assert worst["robot"] < 0.04, title
        assert worst["ball speed"] < 0.1, title
        assert worst["robot speed"] < 0.4, title
        assert worst["heading"] < 0.05, title


def test_a_fault_is_in_what_the_filter_is_sent() -> None:
    clean = [frame for frame, _ in faults.CASES["one camera, no fault"](np.random.default_rng(1))]
    for title, sent in faults.CASES.items():
        shown = [frame for frame, _ in sent(np.random.default_rng(1))]
        assert (shown == clean) == (title == "one camera, no fault"), title


@pytest.mark.slow
def test_cameras_that_disagree_decide_and_measure_as_one_does() -> None:
    for seed in range(40):
        for kind, bar in (("rest", 0.03), ("moving", 0.1)):
            assert max(faults.drawn(kind, seed, alone=False)) < bar, (kind, seed)
        for kind in ("has", "has not", "goal"):
            assert faults.drawn(kind, seed, alone=False)[0] == 0.0, (kind, seed)


def test_a_draw_of_each_kind_is_within_its_bar() -> None:
    assert max(faults.drawn("rest", 5, alone=False)) < 0.03
    assert faults.drawn("goal", 5, alone=False)[0] == 0.0
