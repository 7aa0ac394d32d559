"""Assign tasks at the least total cost."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robobt.motion.arrival import time_to
from robobt.world.compiled import FloatArray, compiled
from robobt.world.records import mover_records

NO_JOB = -1
"""The job of a robot that gets none."""

_UNASSIGNED = -1


@compiled
def jobs_of(
    movers_: FloatArray,
    rows: NDArray[np.int64],
    before: NDArray[np.int64],
    places: FloatArray,
    kinds: NDArray[np.int64],
    gain: float,
    long_way: float,
) -> NDArray[np.int64]:
    """Return the job of each robot, (n,), so that all robots together are soonest at their places.

    If there are more robots than places, some get :data:`NO_JOB`.

    Args:
        movers_: as of :func:`robobt.world.records.movers`.
        rows: of the robots among them, (n,).
        before: the kind of job that each of them has had, (n,).
        places: of the jobs, (m, 2) [m].
        kinds: of the jobs, numbers that only have to be equal, (m,).
        gain: bonus of a robot for a job of the kind that it has had [s].
        long_way: how much the square of a time counts, so that the longest way counts most, which avoids
            crossing ways [1/s].
    """
    movers, robots, jobs = mover_records(movers_), len(rows), len(places)
    few = robots <= jobs
    cost = np.empty((robots, jobs) if few else (jobs, robots))
    for i in range(robots):
        for j in range(jobs):
            x, y = places[j]
            time = time_to(movers[rows[i]], x, y, 0.0) - (gain if kinds[j] == before[i] else 0.0)
            if few:
                cost[i, j] = time + long_way * time * time
            else:
                cost[j, i] = time + long_way * time * time
    columns = _columns(cost)
    if few:
        return columns
    found = np.full(robots, NO_JOB)
    for j in range(jobs):
        found[columns[j]] = j
    return found


@compiled
def _columns(cost: FloatArray) -> NDArray[np.int64]:
    """Return the column of each row, (n,), of costs with at least as many columns as rows.

    Source: Jonker and Volgenant, "A shortest augmenting path algorithm for dense and sparse linear
    assignment problems", 1987. For each row it finds the cheapest augmenting path to a free column, which may
    reassign earlier rows; the prices keep every reduced cost at zero or more.
    """
    rows, columns = cost.shape
    row_price, column_price = np.zeros(rows), np.zeros(columns)
    row_of = np.full(columns, _UNASSIGNED)
    column_of = np.full(rows, _UNASSIGNED)
    for begin in range(rows):
        reached = np.full(columns, np.inf)
        from_row = np.full(columns, begin)
        settled = np.zeros(columns, dtype=np.bool_)
        row, length, end = begin, 0.0, _UNASSIGNED
        while end == _UNASSIGNED:
            nearest = _UNASSIGNED
            for column in range(columns):
                if settled[column]:
                    continue
                way = length + cost[row, column] - row_price[row] - column_price[column]
                if way < reached[column]:
                    reached[column], from_row[column] = way, row
                if nearest == _UNASSIGNED or reached[column] < reached[nearest]:
                    nearest = column
            length = reached[nearest]
            settled[nearest] = True
            if row_of[nearest] == _UNASSIGNED:
                end = nearest
            else:
                row = row_of[nearest]
        row_price[begin] += length
        for column in range(columns):
            if settled[column] and row_of[column] != _UNASSIGNED:
                row_price[row_of[column]] += length - reached[column]
            if settled[column]:
                column_price[column] -= length - reached[column]
        while True:
            row = from_row[end]
            row_of[end] = row
            end, column_of[row] = column_of[row], end
            if row == begin:
                break
    return column_of
