"""Where episodes of Go-To-Ball start."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.go_to_ball.settings import GoToBallSettings
from robobt.learning.envs.starts import GIVE_UP, START_COLUMNS, velocities
from robobt.learning.envs.task import FloatArray


def go_to_ball_starts(settings: GoToBallSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts (count, 10) of Go-To-Ball.

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
    return rows
