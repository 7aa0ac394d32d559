"""Starts of Go-To-Ball."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.go_to_ball.settings import GoToBallSettings
from robobt.learning.envs.starts import (
    BALL_COLUMNS,
    GIVE_UP,
    ROBOT_COLUMNS,
    places_of,
    start_parts,
    velocities,
)
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.patrols import PATROL, PATROL_TRAITS
from robobt.sim.records import RecordArray
from robobt.world.state import ROBOT_RADIUS


def go_to_ball_starts(settings: GoToBallSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts of Go-To-Ball, columns :func:`columns_of`.

    Robot and ball are anywhere in their ranges, drawn again until their distance fits. Return the starts.

    Raises:
        ValueError: no start with that distance was found.
    """
    starts, field = settings.starts, settings.field
    x = (-field.half_length + starts.inset, field.half_length - starts.inset)
    y = (-field.half_width + starts.inset, field.half_width - starts.inset)
    rows = np.zeros((count, len(columns_of(settings))))
    robots, ball, traits = start_parts(rows, 1 + settings.others.count)
    robot = robots[:, 0]
    open_ = np.arange(count)
    for _ in range(GIVE_UP):
        robot["x"][open_] = rng.uniform(*(starts.robot_x or x), len(open_))
        robot["y"][open_] = rng.uniform(*(starts.robot_y or y), len(open_))
        ball["x"][open_] = rng.uniform(*(starts.ball_x or x), len(open_))
        ball["y"][open_] = rng.uniform(*(starts.ball_y or y), len(open_))
        gap = np.hypot(ball["x"] - robot["x"], ball["y"] - robot["y"])[open_]
        least, most = starts.distance
        open_ = open_[(gap < least) | (gap > most)]
        if len(open_) == 0:
            break
    else:
        raise ValueError(f"starts: no robot and ball {least:g} m to {most:g} m apart")
    robot["heading"] = rng.uniform(*starts.heading, count)
    robot["vx"], robot["vy"] = velocities(rng, starts.robot_speed, count)
    robot["omega"] = rng.uniform(*starts.robot_turn, count)
    ball["vx"], ball["vy"] = velocities(rng, starts.ball_speed, count)
    if settings.others.count > 0:
        _place_others(settings, rng, robots, ball, traits.view(PATROL))
    return rows


def _place_others(
    settings: GoToBallSettings,
    rng: np.random.Generator,
    robots: RecordArray,
    balls: RecordArray,
    patrols: RecordArray,
) -> None:
    """Draw the moving obstacles, each anywhere between the ends of its way.

    Args:
        settings: settings of the task.
        rng: source of randomness.
        robots: (n, R), the first placed; the others' states are filled.
        balls: (n,) placed.
        patrols: (n, R - 1) filled.

    Raises:
        ValueError: no way was found that is long enough and far enough from the ball.
    """
    others, field, count = settings.others, settings.field, len(robots)
    most = np.array([field.half_length, field.half_width]) - settings.starts.inset
    me, ball = places_of(robots[:, 0]), places_of(balls)
    for k in range(1, 1 + others.count):
        open_, crossing = np.arange(count), rng.random(count) < others.crossing
        for _ in range(GIVE_UP):
            begin, end = rng.uniform(-most, most, (2, len(open_), 2))
            between = me[open_] + rng.random((len(open_), 1)) * (ball[open_] - me[open_])
            # The other end is mirrored at a point of the robot's way, limited to the field.
            mirrored = np.clip(2.0 * between - begin, -most, most)
            end = np.where(crossing[open_, None], mirrored, end)
            way = end - begin
            at = begin + rng.random((len(open_), 1)) * way
            length = np.hypot(*way.T)
            along = way / np.maximum(length, 1e-9)[:, None]
            to_ball = ball[open_] - begin
            nearest = np.clip((to_ball * along).sum(1), 0.0, length)
            from_ball = np.hypot(*(to_ball - nearest[:, None] * along).T)
            apart = np.hypot(*(at - me[open_]).T) < others.apart
            # Keep space between any two robots, so that none starts inside another.
            placed = places_of(robots[open_, 1:k])
            close = np.hypot(*(placed - at[:, None]).transpose(2, 0, 1)) < 3 * ROBOT_RADIUS
            fits = (length >= others.way) & (from_ball >= others.from_ball) & ~apart & ~close.any(axis=1)
            done = open_[fits]
            speed = rng.uniform(*others.speed, len(open_))[fits]
            robot, patrol, ahead = robots[:, k], patrols[:, k - 1], along[fits].T
            robot["x"][done], robot["y"][done] = at[fits].T
            robot["heading"][done] = np.arctan2(*ahead[::-1])
            robot["vx"][done], robot["vy"][done] = ahead * speed
            patrol["from_x"][done], patrol["from_y"][done] = begin[fits].T
            patrol["to_x"][done], patrol["to_y"][done] = end[fits].T
            patrol["speed"][done] = speed
            open_ = open_[~fits]
            if len(open_) == 0:
                break
        else:
            raise ValueError(
                f"others: no way of {others.way:g} m that is {others.from_ball:g} m from the ball and begins "
                f"{others.apart:g} m from the robot"
            )


def columns_of(settings: GoToBallSettings) -> tuple[str, ...]:
    """Return the columns of a start: robot, the others, ball, and the ways of the others."""
    names = [f"other_{k}_{name}" for k in range(settings.others.count) for name in ROBOT_COLUMNS]
    traits = [f"other_{k}_{name}" for k in range(settings.others.count) for name in PATROL_TRAITS]
    return (*ROBOT_COLUMNS, *names, *BALL_COLUMNS, *traits)
