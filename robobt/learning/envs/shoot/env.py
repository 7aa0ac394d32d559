"""The specification of Shoot-Towards-Goal, for Gymnasium."""

from __future__ import annotations

from robobt.learning.envs.gymnasium_base import TaskEnv, TaskVectorEnv


class ShootTowardsGoalEnv(TaskEnv):
    """Shoot-Towards-Goal: turn on the spot with the ball and kick it into the goal.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    with the choices of the authors' published code where the paper is silent. The
    equations of the reward are its Eqs. 12 and 13. The values below are the defaults of
    :class:`~robobt.learning.envs.ShootSettings`, where all of them can be changed.

    One step is one control period of 30 ms, in 4 physics steps with walls, goals
    and ball contacts. The dribbler is on all the time. It holds the ball with limited force: a robot that
    turns too fast loses it.

    **Observation**, float32, :data:`robobt.world.features.SHOOT`; the frame is the
    robot's, x ahead and y to its left:

    | entry | meaning | unit | range |
    | --- | --- | --- | --- |
    | 0, 1 | position of the ball | m | diagonal inside the walls, either way |
    | 2, 3 | velocity of the ball over the field | m/s | fastest kick + 2.3, either way |
    | 4 | the robot's turning rate, counter-clockwise | rad/s | top rate + 5.6, either way |
    | 5 | distance to the middle of the goal | m | [0, diagonal inside the walls] |
    | 6, 7 | sine and cosine of the angle from the heading to the left post | 1 | [-1, 1] |
    | 8, 9 | sine and cosine of the angle to the right post | 1 | [-1, 1] |

    **Action**, float32, :data:`robobt.models.actions.SHOOT_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0 | turning rate | 10 rad/s | [-1, 1] |
    | 1 | kick where above 0, with 5 m/s, if the ball is in the mouth | - | [-1, 1] |

    **Reward** per step. alpha is the angle between the posts seen from the robot, beta the larger of the
    angles from the heading to the posts, v the ball's speed; the robot faces the goal where alpha >= beta:

    | term | value | equation |
    | --- | --- | --- |
    | facing the goal | 0.05 (alpha - beta) v where it faces it, else (alpha - beta) v | 12 |
    | kick | +10 on the first step with a kick action, if facing | 13 |
    | waiting | -0.25 before the first kick action, and whenever not facing | 13 |
    | goal | +20 instead of all the above, on the step that ends in a goal | - |

    The goal term is only in the authors' code. A step that ends out of play earns 0. As in that code, the +10
    is paid for the kick action, with or without the ball or a goal. Turning with the ball by D costs about
    3.2 (D - alpha)^2 / 2 at any rate, while never kicking costs 0.25 per step, so not kicking is a local
    optimum.

    **Start**: x from 0.3 m to 0.3 m in front of the defence area, y at least 0.1 m inside the touch lines,
    heading in [-pi, pi), at rest; the ball is in the mouth, where the dribbler holds it after 3 steps of
    warm-up.

    **End**, checked in this order: terminated by a goal, which is success (the whole ball crosses the goal
    line between the posts, as :mod:`robobt.world.rules` decides it for matches); terminated out of play (the
    whole ball over a line of the field, its centre behind the halfway line, or the robot 0.2 m behind the
    halfway line, over a touch line or in the defence area); truncated after 100 steps (3 s).

    Args:
        settings: a :class:`~robobt.learning.envs.ShootSettings` or a mapping of its fields, as from a YAML
            file.
        render_mode: None or "rgb_array".
    """

    task_name = "shoot"


class ShootTowardsGoalVectorEnv(TaskVectorEnv):
    """Many arenas of :class:`ShootTowardsGoalEnv`, which specifies observation, reward and ends."""

    task_name = "shoot"
