"""Tasks are shared out at the least cost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import linear_sum_assignment

from robobt.skills.tactics.assignment import assign

SHAPES = st.tuples(st.integers(1, 8), st.integers(1, 8))


@given(SHAPES.flatmap(lambda shape: arrays(np.float64, shape, elements=st.floats(-50.0, 50.0))))
def test_no_other_shares_cost_less(cost: np.ndarray) -> None:
    pairs = assign(cost)
    assert len(pairs) == min(cost.shape)
    assert len({row for row, _ in pairs}) == len({column for _, column in pairs}) == len(pairs)
    assert pairs == sorted(pairs)
    ours = sum(cost[row, column] for row, column in pairs)
    assert ours == pytest.approx(cost[linear_sum_assignment(cost)].sum(), abs=1e-9)


def test_it_shares_as_scipy_does_where_one_way_is_best() -> None:
    rng = np.random.default_rng(3)
    for _ in range(300):
        cost = rng.random((int(rng.integers(1, 9)), int(rng.integers(1, 9))))
        rows, columns = linear_sum_assignment(cost)
        assert assign(cost) == list(zip(rows.tolist(), columns.tolist(), strict=True))


def test_nobody_does_nothing() -> None:
    assert assign(np.zeros((0, 3))) == []
