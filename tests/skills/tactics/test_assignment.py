"""Tasks are shared out at the least cost."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from robobt.motion.arrival import arrival_time
from robobt.skills.tactics.assignment import NO_JOB, jobs_of
from robobt.world.records import movers
from robobt.world.state import RobotState


@pytest.mark.parametrize(("robots", "jobs"), [(3, 5), (8, 8), (5, 2)])
def test_jobs_are_shared_out_as_scipy_does(robots: int, jobs: int) -> None:
    rng = np.random.default_rng(4)
    for _ in range(100):
        states = movers([RobotState(i, *rng.uniform(-3.0, 3.0, 2).tolist()) for i in range(robots + 1)])
        rows, places = np.arange(1, robots + 1), rng.uniform(-3.0, 3.0, (jobs, 2))
        before, kinds = rng.integers(-1, 2, robots), rng.integers(-1, 2, jobs)
        times = np.array([[arrival_time(states[row], x, y, 0.0) for x, y in places] for row in rows])
        times -= 0.8 * (before[:, None] == kinds)
        shared_out = np.full(robots, NO_JOB)
        least_rows, least_columns = linear_sum_assignment(times + 0.3 * times * times)
        shared_out[least_rows] = least_columns
        assert jobs_of(states, rows, before, places, kinds, 0.8, 0.3).tolist() == shared_out.tolist()
