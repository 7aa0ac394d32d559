"""Learners that let go of the ball before they have carried it too far, as plays do for them."""

from __future__ import annotations

from math import hypot, isnan

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.soccer.judge import KEPT, LAST, TAKEN_X, TAKEN_Y
from robobt.learning.envs.task import FloatArray
from robobt.skills.conditions.carried_far import LETTING_GO
from robobt.world.compiled import compiled


@compiled
def let_go(
    limit: float,
    who: NDArray[np.int64],
    robots: FloatArray,
    balls: FloatArray,
    minds: FloatArray,
    commands: FloatArray,
) -> None:
    """Stop each learner that has carried the ball ``limit`` [m] or farther, and its dribbler.

    What counts is what :class:`~robobt.skills.conditions.carried_far.CarriedFar` measures.

    Args:
        limit: [m].
        who: (L,) indices of the learners.
        robots: (n, R, 6) states.
        balls: (n, 4) states.
        minds: (n, MIND) as of :func:`~robobt.learning.envs.soccer.judge.judge`.
        commands: (n, R, COMMAND); changed.
    """
    for i in range(len(balls)):
        mind, ball = minds[i], balls[i]
        for index in who:
            if mind[LAST] != index or isnan(mind[TAKEN_X]):
                continue
            robot = robots[i, index]
            if hypot(ball[0] - robot[0], ball[1] - robot[1]) > KEPT:
                continue
            way = hypot(ball[0] - mind[TAKEN_X], ball[1] - mind[TAKEN_Y])
            if way + LETTING_GO * hypot(ball[2], ball[3]) >= limit:
                commands[i, index] = 0.0
