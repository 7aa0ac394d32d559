"""The arenas that a policy learns in: their worlds, and who opposes the learners there."""

from __future__ import annotations

from collections.abc import Sequence
from math import lcm

from robobt.learning.envs import TaskSettings, VectorTask
from robobt.learning.envs.make import learners_of, make_rows
from robobt.learning.envs.several_worlds import SeveralWorlds
from robobt.learning.envs.soccer.one_side import OneSide, Others
from robobt.learning.envs.soccer.per_robot import PerRobot
from robobt.learning.envs.soccer.settings import LEARNER, SoccerSettings
from robobt.learning.envs.soccer.suite import against
from robobt.learning.training.setting_groups import PoolSettings


def arenas_of(worlds: Sequence[TaskSettings], n: int, central: bool) -> VectorTask:
    """Return arenas with ``n`` learners, a row each, shared evenly among the worlds."""
    if len(worlds) == 1:
        return make_rows(worlds[0], n, central)
    each = learners_of(worlds[0])
    shares = [each * share for share in shares_of(n // each, len(worlds))]
    return SeveralWorlds([make_rows(*part, central) for part in zip(worlds, shares, strict=True)])


def shares_of(count: int, parts: int) -> list[int]:
    """Return ``count`` shared as evenly as can be."""
    return [(count + parts - 1 - part) // parts for part in range(parts)]


def opposed_arenas(
    environment: TaskSettings, pool: PoolSettings, others: Others, n: int, central: bool
) -> VectorTask:
    """Return arenas with ``n`` learners, a row each, of which the pool's shares play against the pool.

    Where yellow has no learners nobody of the pool plays. Shares are rounded to whole arenas.

    Args:
        environment: of all arenas, but for who is yellow.
        pool: the shares, and the scripts.
        others: plays the part of the past selves.
        n: learners.
        central: whether what a central critic sees follows each observation.
    """
    if not isinstance(environment, SoccerSettings) or not environment.two_alike:
        return make_rows(environment, n, central)
    each, blue = learners_of(environment), environment.blue.count(LEARNER)
    unit = lcm(each, blue)

    def share(of: float) -> int:
        return unit * round(of * n / unit)

    past = share(pool.share)
    scripted = share(pool.scripted / len(pool.scripts)) if pool.scripts else 0
    itself = n - past - scripted * len(pool.scripts)
    parts: list[VectorTask] = []
    if itself > 0:
        parts.append(make_rows(environment, itself, central))
    if past > 0:
        rows = make_rows(environment, past // blue * each, central)
        assert isinstance(rows, PerRobot)
        parts.append(OneSide(rows, others))
    if scripted > 0:
        parts += [make_rows(against(environment, role), scripted, central) for role in pool.scripts]
    return SeveralWorlds(parts)
