"""Shoot-Towards-Goal as Gymnasium knows it: its specification."""

from __future__ import annotations

from robobt.learning.envs.gymnasium_base import TaskEnv, TaskVectorEnv


class ShootTowardsGoalEnv(TaskEnv):
    """Shoot-Towards-Goal: turn on the spot with the ball and kick it into the goal.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    with the choices of the authors' published code where the paper is silent. The
    equations of the reward are its Eqs. 12 and 13. What is given here are the
    defaults of :class:`~robobt.learning.envs.ShootSettings`, where all of it can
    be changed.

    One step is one control period of 30 ms, in 4 physics steps with walls, goals
    and ball contacts. The dribbler is on all the time. It holds the ball with
    limited force: who turns too fast loses it.

    **Observation**, float32, :data:`robobt.world.features.SHOOT`; the frame is the
    robot's, x ahead and y to its left:

    | entry | meaning | unit | range |
    | --- | --- | --- | --- |
    | 0, 1 | position of the ball | m | diagonal inside the walls, either way |
    | 2, 3 | velocity of the ball over the field | m/s | fastest kick + 2.3, either way |
    | 4 | the robot's turning rate, counter-clockwise | rad/s | top rate + 5.6, either way |
    | 5 | distance to the middle of the goal | m | [0, diagonal inside the walls] |
    | 6, 7 | sine and cosine of the angle from the heading to the left post | 1 | [-1, 1] |
    | 8, 9 | the same of the right post | 1 | [-1, 1] |

    **Action**, float32, :data:`robobt.models.actions.SHOOT_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0 | turning rate | 10 rad/s | [-1, 1] |
    | 1 | kick where above 0, with 5 m/s, if the ball is in the mouth | - | [-1, 1] |

    **Reward** a step. alpha is the angle between the posts seen from the robot,
    beta the larger of the angles from the heading to the posts, v the ball's
    speed; the robot faces the goal where alpha >= beta:

    | term | value | equation |
    | --- | --- | --- |
    | facing the goal | 0.05 (alpha - beta) v where it faces it, else (alpha - beta) v | 12 |
    | kick | +10 on the first step with a kick action, if facing | 13 |
    | waiting | -0.25 before the first kick action, and whenever not facing | 13 |
    | goal | +20 instead of all the above, on the step that ends in a goal | - |

    The last is of the authors' code alone. A step that ends out of play earns 0.
    As in that code the +10 is paid for the action, ball or not, goal or not. And
    turning with the ball by D costs about 3.2 (D - alpha)^2 / 2 at whatever rate,
    while never kicking costs 0.25 a step: not kicking is a local optimum.

    **Start**: x from 0.3 m to 0.3 m before the defence area, y inside the touch
    lines less 0.1 m, heading in [-pi, pi), at rest; the ball in the mouth, where
    the dribbler holds it after 3 steps of warm-up.

    **End**, looked at in this order: terminated by a goal, which is success (the
    whole ball crosses the goal line between the posts, as
    :mod:`robobt.world.rules` decides it for matches); terminated out of play (the
    whole ball over a line of the field, its centre behind the halfway line, or the
    robot 0.2 m behind the halfway line, over a touch line or in the defence area);
    truncated after 100 steps (3 s).

    Args:
        settings: a :class:`~robobt.learning.envs.ShootSettings` or the mapping that
            makes one, as out of a YAML file.
        render_mode: None or "rgb_array".
    """

    task_name = "shoot"


class ShootTowardsGoalVectorEnv(TaskVectorEnv):
    """Many arenas of :class:`ShootTowardsGoalEnv`, which says what is observed, rewarded and ended."""

    task_name = "shoot"
