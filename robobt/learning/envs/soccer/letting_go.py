"""Learners that let go of the ball before they have carried it too far, as plays do for them."""

from __future__ import annotations

from math import cos, hypot, isnan, sin

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.soccer.judge import KEPT, LAST, TAKEN_X, TAKEN_Y
from robobt.learning.envs.task import FloatArray
from robobt.sim.records import COMMAND
from robobt.skills.ball.let_go import FASTER
from robobt.skills.conditions.carried_far import LETTING_GO
from robobt.world.compiled import compiled


@compiled
def let_go(
    limit: float,
    who: NDArray[np.int64],
    blue: int,
    robots: FloatArray,
    balls: FloatArray,
    minds: FloatArray,
    commands: FloatArray,
) -> None:
    """Let each learner that has carried the ball ``limit`` [m] or farther get off it.

    What counts is what :class:`~robobt.skills.conditions.carried_far.CarriedFar` measures, and they do as
    :class:`~robobt.skills.ball.let_go.LetGo` does.

    Args:
        limit: [m].
        who: (L,) indices of the learners.
        blue: how many robots, the first, attack towards +x.
        robots: (n, R, 6) states.
        balls: (n, 4) states.
        minds: (n, MIND) as of :func:`~robobt.learning.envs.soccer.judge.judge`.
        commands: (n, R, size(COMMAND)); changed.
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
                c, s = cos(robot[2]), sin(robot[2])
                commands[i, index] = 0.0
                side = 1.0 if index < blue else -1.0
                if side * ball[0] > 0.0 or side * c > 0.0:
                    commands.view(COMMAND)[i, index, 0].kick_speed = (
                        max(0.0, c * ball[2] + s * ball[3]) + FASTER
                    )
