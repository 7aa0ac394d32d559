"""Where episodes of Go-To-Ball start."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.go_to_ball.settings import GoToBallSettings
from robobt.learning.envs.starts import BALL_COLUMNS, GIVE_UP, ROBOT_COLUMNS, START_COLUMNS, velocities
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.patrols import TRAITS
from robobt.world.state import ROBOT_RADIUS


def go_to_ball_starts(settings: GoToBallSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts of Go-To-Ball, columns :func:`columns_of`.

    Robot and ball anywhere in their ranges, drawn again until their distance fits.

    Raises:
        ValueError: no start with that distance was found.
    """
    starts, field = settings.starts, settings.field
    x = (-field.half_length + starts.inset, field.half_length - starts.inset)
    y = (-field.half_width + starts.inset, field.half_width - starts.inset)
    rows = np.zeros((count, len(START_COLUMNS)))
    open_ = np.arange(count)
    for _ in range(GIVE_UP):
        rows[open_, 0] = rng.uniform(*(starts.robot_x or x), len(open_))
        rows[open_, 1] = rng.uniform(*(starts.robot_y or y), len(open_))
        rows[open_, 6] = rng.uniform(*(starts.ball_x or x), len(open_))
        rows[open_, 7] = rng.uniform(*(starts.ball_y or y), len(open_))
        gap = np.hypot(rows[open_, 6] - rows[open_, 0], rows[open_, 7] - rows[open_, 1])
        open_ = open_[(gap < starts.distance[0]) | (gap > starts.distance[1])]
        if len(open_) == 0:
            break
    else:
        raise ValueError(
            f"starts: no robot and ball {starts.distance[0]:g} m to {starts.distance[1]:g} m apart"
        )
    rows[:, 2] = rng.uniform(*starts.heading, count)
    rows[:, 3:5] = velocities(rng, starts.robot_speed, count)
    rows[:, 5] = rng.uniform(*starts.robot_turn, count)
    rows[:, 8:10] = velocities(rng, starts.ball_speed, count)
    if settings.others.count == 0:
        return rows
    others, traits = _others(settings, rng, rows)
    return np.column_stack((rows[:, :6], others, rows[:, 6:], traits))


def _others(
    settings: GoToBallSettings, rng: np.random.Generator, rows: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Draw the robots in the way, somewhere between the ends of their ways: states and traits, a row a start.

    Raises:
        ValueError: no way was found that is long enough and far enough from the ball.
    """
    others, field, count = settings.others, settings.field, len(rows)
    most = np.array([field.half_length, field.half_width]) - settings.starts.inset
    states, traits = np.zeros((count, others.count, 6)), np.zeros((count, others.count, len(TRAITS)))
    for k in range(others.count):
        open_, crossing = np.arange(count), rng.random(count) < others.crossing
        for _ in range(GIVE_UP):
            ends = rng.uniform(-most, most, (2, len(open_), 2))
            between = rows[open_, :2] + rng.random((len(open_), 1)) * (rows[open_, 6:8] - rows[open_, :2])
            # Mirrored at a point of the robot's way, as far as the field goes.
            mirrored = np.clip(2.0 * between - ends[0], -most, most)
            ends[1] = np.where(crossing[open_, None], mirrored, ends[1])
            way = ends[1] - ends[0]
            at = ends[0] + rng.random((len(open_), 1)) * way
            length = np.hypot(*way.T)
            along = way / np.maximum(length, 1e-9)[:, None]
            to_ball = rows[open_, 6:8] - ends[0]
            nearest = np.clip((to_ball * along).sum(1), 0.0, length)
            from_ball = np.hypot(*(to_ball - nearest[:, None] * along).T)
            apart = np.hypot(*(at - rows[open_, :2]).T) < others.apart
            # Room between any two of them, so that nobody begins inside another.
            close = np.hypot(*(states[open_, :k, :2] - at[:, None]).transpose(2, 0, 1)) < 3 * ROBOT_RADIUS
            fits = (length >= others.way) & (from_ball >= others.from_ball) & ~apart & ~close.any(axis=1)
            done = open_[fits]
            speed = rng.uniform(*others.speed, len(open_))[fits]
            states[done, k, :2] = at[fits]
            states[done, k, 2] = np.arctan2(along[fits, 1], along[fits, 0])
            states[done, k, 3:5] = along[fits] * speed[:, None]
            traits[done, k, :2], traits[done, k, 2:4], traits[done, k, 4] = (
                ends[0, fits],
                ends[1, fits],
                speed,
            )
            open_ = open_[~fits]
            if len(open_) == 0:
                break
        else:
            raise ValueError(
                f"others: no way of {others.way:g} m that is {others.from_ball:g} m from the ball and begins "
                f"{others.apart:g} m from the robot"
            )
    return states.reshape(count, -1), traits.reshape(count, -1)


def columns_of(settings: GoToBallSettings) -> tuple[str, ...]:
    """Return the columns of a start: robot, the others, ball, and what makes the others' ways."""
    names = [f"other_{k}_{name}" for k in range(settings.others.count) for name in ROBOT_COLUMNS]
    traits = [f"other_{k}_{name}" for k in range(settings.others.count) for name in TRAITS]
    return (*ROBOT_COLUMNS, *names, *BALL_COLUMNS, *traits)
