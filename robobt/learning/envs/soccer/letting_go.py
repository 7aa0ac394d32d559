"""Make learners release the ball before they carry it too far, as plays do."""

from __future__ import annotations

from math import isnan

from robobt.learning.envs.soccer.judge import MIND
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.sim.records import COMMAND
from robobt.skills.ball.let_go import push_speed
from robobt.skills.conditions.carried_far import way_carried
from robobt.world.compiled import compiled_lean
from robobt.world.records import BALL, ROBOT
from robobt.world.rules import keeps_ball


@compiled_lean
def let_go(
    limit: float,
    who: IntArray,
    blue: int,
    robots_: FloatArray,
    balls_: FloatArray,
    minds_: FloatArray,
    commands_: FloatArray,
) -> None:
    """Make each learner that has carried the ball ``limit`` [m] or farther release it.

    The distance is measured as in :class:`~robobt.skills.conditions.carried_far.CarriedFar`, and the release
    works as in :class:`~robobt.skills.ball.let_go.LetGo`.

    Args:
        limit: carried distance [m].
        who: (L,) indices of the learners.
        blue: number of robots, the first ones, that attack towards +x.
        robots_: (n, R, size(ROBOT)) states.
        balls_: (n, size(BALL)) states.
        minds_: (n, size(MIND)) of :class:`~robobt.learning.envs.soccer.judge.Mind`.
        commands_: (n, R, size(COMMAND)) commands, which are changed.
    """
    robots, balls = robots_.view(ROBOT)[..., 0], balls_.view(BALL)[..., 0]
    minds, commands = minds_.view(MIND)[..., 0], commands_.view(COMMAND)[..., 0]
    for i in range(len(balls)):
        mind, ball = minds[i], balls[i]
        for index in who:
            robot = robots[i, index]
            if mind.last != index or isnan(mind.taken_x) or not keeps_ball(robot, ball):
                continue
            if way_carried(ball, mind.taken_x, mind.taken_y) >= limit:
                commands_[i, index] = 0.0
                commands[i, index].kick_speed = push_speed(robot, ball, 1.0 if index < blue else -1.0)
