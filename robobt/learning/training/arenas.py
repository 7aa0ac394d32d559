"""The arenas for training: their worlds, and the opponents of the learners."""

from __future__ import annotations

from collections.abc import Sequence
from math import lcm

from robobt.learning.envs import TaskSettings, VectorTask
from robobt.learning.envs.make import learners_of, make_rows
from robobt.learning.envs.per_robot import OneSide, Others, PerRobot, SeveralWorlds
from robobt.learning.envs.soccer.settings import LEARNER, SoccerSettings
from robobt.learning.envs.soccer.suite import against
from robobt.learning.training.setting_groups import PoolSettings


def arenas_of(worlds: Sequence[TaskSettings], n: int, central: bool) -> VectorTask:
    """Return arenas with ``n`` learners, one row each, shared evenly among the worlds.

    Raises:
        ValueError: ``n`` learners do not fill whole arenas with one at least of each world.
    """
    if len(worlds) == 1:
        return make_rows(worlds[0], n, central)
    shares = learners_in(worlds, n)
    return SeveralWorlds([make_rows(*part, central) for part in zip(worlds, shares, strict=True)])


def learners_in(worlds: Sequence[TaskSettings], n: int) -> list[int]:
    """Return how many of ``n`` learners each world has, as evenly as whole arenas allow.

    Raises:
        ValueError: ``n`` learners do not fill whole arenas with one at least of each world.
    """
    each = [learners_of(world) for world in worlds]
    counts, left = list(each), n - sum(each)
    while left >= min(each):
        fitting = [world for world, own in enumerate(each) if own <= left]
        world = min(fitting, key=counts.__getitem__)
        counts[world] += each[world]
        left -= each[world]
    if left != 0:
        raise ValueError(f"{n} learners do not fill whole arenas of {', '.join(map(str, each))}")
    return counts


def shares_of(count: int, parts: int) -> list[int]:
    """Return ``count`` divided as evenly as possible."""
    return [(count + parts - 1 - part) // parts for part in range(parts)]


def opposed_arenas(
    environment: TaskSettings, pool: PoolSettings, others: Others, n: int, central: bool
) -> VectorTask:
    """Return arenas with ``n`` learners, one row each; the pool's shares of them play against the pool.

    The pool is not used if yellow has no learners.

    Args:
        environment: environment of all arenas, except for yellow's robots.
        pool: the shares, the scripts and the plays.
        others: plays the part of the past selves.
        n: learners.
        central: whether the additional input of a central critic follows each observation.
    """
    if not environment.two_alike:
        return make_rows(environment, n, central)
    assert isinstance(environment, SoccerSettings)
    each, blue = learners_of(environment), environment.blue.count(LEARNER)
    past, *opponents = opposed(environment, pool, n)
    itself = n - past - sum(opponents)
    parts: list[VectorTask] = []
    if itself > 0:
        parts.append(make_rows(environment, itself, central))
    if past > 0:
        rows = make_rows(environment, past // blue * each, central)
        assert isinstance(rows, PerRobot)
        parts.append(OneSide(rows, others))
    for opponent, count in zip(pool.opponents, opponents, strict=True):
        if count > 0:
            parts.append(make_rows(against(environment, opponent), count, central))
    return SeveralWorlds(parts)


def opposed(environment: SoccerSettings, pool: PoolSettings, n: int) -> list[int]:
    """Return how many of ``n`` learners play against past selves, then against each opponent.

    Shares are rounded to whole arenas; the last ones get the remainder.
    """
    unit = lcm(learners_of(environment), environment.blue.count(LEARNER))
    counts: list[int] = []
    for share in pool.shares:
        left = (n - sum(counts)) // unit
        counts.append(unit * min(round(share * n / unit), left))
    return counts
