"""Tasks are shared out at the least cost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import linear_sum_assignment

from robobt.motion.arrival import arrival_times
from robobt.skills.tactics.assignment import NO_JOB, assign, jobs_of
from robobt.world.records import movers
from robobt.world.state import RobotState

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


@pytest.mark.parametrize(("robots", "jobs"), [(3, 5), (4, 4), (5, 2)])
def test_jobs_go_to_the_robots_that_are_soonest_there(robots: int, jobs: int) -> None:
    rng = np.random.default_rng(4)
    for _ in range(50):
        states = [RobotState(i, *rng.uniform(-3.0, 3.0, 2).tolist()) for i in range(robots + 1)]
        rows, places = np.arange(1, robots + 1), rng.uniform(-3.0, 3.0, (jobs, 2))
        before, kinds = rng.integers(-1, 2, robots), rng.integers(-1, 2, jobs)
        times = arrival_times(movers(states), rows, places) - 0.8 * (before[:, None] == kinds)
        found = jobs_of(movers(states), rows, before, places, kinds, 0.8, 0.3).tolist()
        pairs = [(robot, job) for robot, job in enumerate(found) if job != NO_JOB]
        assert pairs == assign(times + 0.3 * times * times)


def test_nobody_does_nothing() -> None:
    assert assign(np.zeros((0, 3))) == []
