"""Where episodes of several robots start."""

from __future__ import annotations

from math import pi

import numpy as np

from robobt.learning.envs.score_on_goalkeeper.starts import keeper_traits
from robobt.learning.envs.soccer.settings import GOALKEEPER, SoccerSettings
from robobt.learning.envs.starts import BALL_COLUMNS, GIVE_UP, ROBOT_COLUMNS, velocities
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.keepers import TRAITS
from robobt.world.state import BALL_RADIUS

_GAP = 3e-4
"""Between ball and front before the dribbler takes it [m]."""

_ASIDE = 0.15
"""How far beside a robot a ball that comes to it passes at most, along each axis [m]."""


def columns_of(settings: SoccerSettings) -> tuple[str, ...]:
    """Return the columns of a start: the robots, the ball, and what each goalkeeper is, blue's first."""
    names = [f"blue_{k}" for k in range(len(settings.blue))]
    names += [f"yellow_{k}" for k in range(len(settings.yellow))]
    keepers = [name for name, role in zip(names, settings.roles, strict=True) if role == GOALKEEPER]
    return (
        *(f"{name}_{column}" for name in names for column in ROBOT_COLUMNS),
        *BALL_COLUMNS,
        *(f"{name}_{trait}" for name in keepers for trait in TRAITS),
    )


def soccer_starts(settings: SoccerSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts, columns :func:`columns_of`.

    Raises:
        ValueError: no start was found in which all are far enough from each other.
    """
    starts, field, roles, keeping = settings.starts, settings.field, settings.roles, settings.keeping
    blue, total = len(settings.blue), len(roles)
    rows = np.zeros((count, len(columns_of(settings))))
    robots = rows[:, : 6 * total].reshape(count, total, 6)
    ball, traits = rows[:, 6 * total : 6 * total + 4], rows[:, 6 * total + 4 :]
    keeper = 0
    places = np.zeros((count, 0, 2))
    for index in range(total):
        side = -1.0 if index < blue else 1.0
        robots[:, index, 2] = rng.uniform(-pi, pi, count)
        if roles[index] == GOALKEEPER:
            own = traits[:, 3 * keeper : 3 * keeper + 3]
            own[:] = keeper_traits(settings.keepers, rng, count)
            robots[:, index, 0] = side * (field.half_length - own[:, 2])
            keeper += 1
        elif keeping[index]:
            robots[:, index, 0] = side * (field.half_length - rng.uniform(*settings.keepers.out, count))
        else:
            x = starts.blue_x if index < blue else starts.yellow_x
            robots[:, index, :2] = _free(rng, (x, starts.y), places, starts.apart)
        if keeping[index]:
            robots[:, index, 2] = 0.0 if side < 0.0 else pi
        places = np.concatenate((places, robots[:, index : index + 1, :2]), axis=1)
    ball[:, :2] = _free(rng, (starts.ball_x, starts.y), places, starts.apart)
    ball[:, 2:] = velocities(rng, starts.ball_speed, count)
    coming, aside = rng.random(count) < starts.coming, rng.uniform(-_ASIDE, _ASIDE, (count, 2))
    fielders = [index for index in range(blue) if not keeping[index]]
    if starts.coming > 0.0 and fielders:
        # Through a point beside it, as an inexact pass would be.
        way = robots[:, fielders[0], :2] + aside - ball[:, :2]
        speed = np.hypot(ball[:, 2], ball[:, 3]) / np.hypot(*way.T)
        ball[coming, 2:] = (way * speed[:, None])[coming]
    held = rng.random(count) < starts.held
    by_blue = np.full(count, starts.holder == "blue")
    if starts.holder == "either":
        by_blue = rng.random(count) < 0.5
    ahead = settings.simulator.body.face + BALL_RADIUS + _GAP
    for chosen, first, last in ((held & by_blue, 0, blue), (held & ~by_blue, blue, total)):
        players = [index for index in range(first, last) if not keeping[index]]
        if players:
            holder = robots[chosen, players[0]]
            front = np.column_stack((np.cos(holder[:, 2]), np.sin(holder[:, 2])))
            ball[chosen, :2] = holder[:, :2] + ahead * front
            ball[chosen, 2:] = 0.0
    return rows


def _free(
    rng: np.random.Generator,
    ranges: tuple[tuple[float, float], tuple[float, float]],
    taken: FloatArray,
    apart: float,
) -> FloatArray:
    """Draw a place in each start (n, 2) that is far enough from those taken (n, k, 2)."""
    drawn = np.zeros((len(taken), 2))
    open_ = np.arange(len(taken))
    for _ in range(GIVE_UP):
        drawn[open_] = np.column_stack([rng.uniform(*span, len(open_)) for span in ranges])
        close = np.hypot(*(taken[open_] - drawn[open_, None]).transpose(2, 0, 1)) < apart
        open_ = open_[close.any(axis=1)]
        if len(open_) == 0:
            return drawn
    raise ValueError(f"starts: no place is {apart:g} m from all others")
