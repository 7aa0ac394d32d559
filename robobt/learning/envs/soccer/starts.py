"""Starts of tasks with several robots."""

from __future__ import annotations

from math import pi

import numpy as np

from robobt.learning.envs.score_on_goalkeeper.starts import keeper_traits
from robobt.learning.envs.settings import Span
from robobt.learning.envs.soccer.settings import GOALKEEPER, SoccerSettings
from robobt.learning.envs.starts import (
    BALL_COLUMNS,
    GIVE_UP,
    MOUTH_GAP,
    ROBOT_COLUMNS,
    start_parts,
    velocities,
)
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.keepers import GOALKEEPER_TRAITS, KEEPER
from robobt.sim.records import RecordArray
from robobt.world.state import BALL_RADIUS

_PASSING_DISTANCE = 0.15
"""Largest distance beside a robot of a ball that rolls towards it, along each axis [m]."""


def columns_of(settings: SoccerSettings) -> tuple[str, ...]:
    """Return the columns of a start: robots, ball, and the kind of each goalkeeper, blue's first."""
    names = [f"blue_{k}" for k in range(len(settings.blue))]
    names += [f"yellow_{k}" for k in range(len(settings.yellow))]
    keepers = [name for name, role in zip(names, settings.roles, strict=True) if role == GOALKEEPER]
    return (
        *(f"{name}_{column}" for name in names for column in ROBOT_COLUMNS),
        *BALL_COLUMNS,
        *(f"{name}_{trait}" for name in keepers for trait in GOALKEEPER_TRAITS),
    )


def soccer_starts(settings: SoccerSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts, columns :func:`columns_of`.

    Raises:
        ValueError: no start was found in which all are far enough from each other.
    """
    starts, field, roles, keeping = settings.starts, settings.field, settings.roles, settings.keeping
    blue, total = len(settings.blue), len(roles)
    rows = np.zeros((count, len(columns_of(settings))))
    robots, ball, traits = start_parts(rows, total)
    keepers = traits.view(KEEPER)
    keeper = 0
    for index in range(total):
        robot, side = robots[:, index], -1.0 if index < blue else 1.0
        robot["heading"] = rng.uniform(-pi, pi, count)
        if roles[index] == GOALKEEPER:
            own = keepers[:, keeper]
            own[:] = keeper_traits(settings.keepers, rng, count).view(KEEPER)[:, 0]
            robot["x"] = side * (field.half_length - own["keeper_out"])
            keeper += 1
        elif keeping[index]:
            robot["x"] = side * (field.half_length - rng.uniform(*settings.keepers.out, count))
        else:
            x = starts.blue_x if index < blue else starts.yellow_x
            robot["x"], robot["y"] = _free(rng, (x, starts.y), robots[:, :index], starts.apart)
        if keeping[index]:
            robot["heading"] = 0.0 if side < 0.0 else pi
    ball["x"], ball["y"] = _free(rng, (starts.ball_x, starts.y), robots, starts.apart)
    ball["vx"], ball["vy"] = velocities(rng, starts.ball_speed, count)
    coming, aside = (
        rng.random(count) < starts.coming,
        rng.uniform(-_PASSING_DISTANCE, _PASSING_DISTANCE, (count, 2)),
    )
    fielders = [index for index in range(blue) if not keeping[index]]
    if starts.coming > 0.0 and fielders:
        # The ball passes a point beside the robot, like an inexact pass.
        receiver, (beside_x, beside_y) = robots[:, fielders[0]], aside.T
        way_x, way_y = receiver["x"] + beside_x - ball["x"], receiver["y"] + beside_y - ball["y"]
        speed = np.hypot(ball["vx"], ball["vy"]) / np.hypot(way_x, way_y)
        ball["vx"][coming], ball["vy"][coming] = (way_x * speed)[coming], (way_y * speed)[coming]
    held = rng.random(count) < starts.held
    by_blue = np.full(count, starts.holder == "blue")
    if starts.holder == "either":
        by_blue = rng.random(count) < 0.5
    ahead = settings.simulator.body.face + BALL_RADIUS + MOUTH_GAP
    for chosen, first, last in ((held & by_blue, 0, blue), (held & ~by_blue, blue, total)):
        players = [index for index in range(first, last) if not keeping[index]]
        if players:
            holder = robots[chosen, players[0]]
            ball["x"][chosen] = holder["x"] + ahead * np.cos(holder["heading"])
            ball["y"][chosen] = holder["y"] + ahead * np.sin(holder["heading"])
            ball["vx"][chosen] = ball["vy"][chosen] = 0.0
    return rows


def _free(
    rng: np.random.Generator,
    ranges: tuple[Span, Span],
    taken: RecordArray,
    apart: float,
) -> FloatArray:
    """Draw a place in each start, x and y (2, n), that is far enough from the robots ``taken`` (n, k)."""
    drawn = np.zeros((2, len(taken)))
    open_ = np.arange(len(taken))
    for _ in range(GIVE_UP):
        x, y = drawn[:, open_] = [rng.uniform(*span, len(open_)) for span in ranges]
        others = taken[open_]
        close = np.hypot(others["x"] - x[:, None], others["y"] - y[:, None]) < apart
        open_ = open_[close.any(axis=1)]
        if len(open_) == 0:
            return drawn
    raise ValueError(f"starts: no place is {apart:g} m from all others")
