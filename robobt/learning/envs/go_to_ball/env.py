"""The specification of Go-To-Ball, for Gymnasium."""

from __future__ import annotations

from robobt.learning.envs.gymnasium_base import TaskEnv, TaskVectorEnv


class GoToBallEnv(TaskEnv):
    """Go-To-Ball: drive an omnidirectional robot to the ball.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    with the choices of the authors' published code where the paper is silent. The equations of the reward are
    its Eqs. 7 to 9. The values below are the defaults of :class:`~robobt.learning.envs.GoToBallSettings`,
    where all of them can be changed.

    One step is one control period of 30 ms, in 4 physics steps with walls, goals
    and ball contacts.

    **Observation**, float32, :data:`robobt.world.features.GO_TO_BALL`; the frame
    is the robot's, x ahead and y to its left:

    | entry | meaning | unit | range |
    | --- | --- | --- | --- |
    | 0 | sine of the angle from the heading to the ball | 1 | [-1, 1] |
    | 1 | cosine of it | 1 | [-1, 1] |
    | 2 | distance of the centres of robot and ball | m | [0, diagonal inside the walls] |
    | 3 | the robot's velocity ahead | m/s | top speed + 0.5, either way |
    | 4 | the robot's velocity to the left | m/s | top speed + 0.5, either way |
    | 5 | its turning rate, counter-clockwise | rad/s | top rate + what a wall may add |

    **Action**, float32, :data:`robobt.models.actions.GO_TO_BALL_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0 | velocity ahead | 1.5 m/s | [-1, 1] |
    | 1 | velocity to the left | 1.5 m/s | [-1, 1] |
    | 2 | turning rate | 1.395 rad/s | [-1, 1] |

    The velocity is shortened to 1.5 m/s; the robot follows within its
    accelerations.

    **Reward** per step, with d the distance [m] and theta the angle to the ball [rad] after the step:

    | term | value | equation |
    | --- | --- | --- |
    | contact | 100 where d <= 0.2 m | 7 |
    | distance | 5 / sqrt(2 pi) exp(-d^2 / 2) - 2 | 8 |
    | orientation | 1 / sqrt(2 pi) exp(-2 abs(theta) / pi^2) | 9 |

    Hovering just outside 0.2 m, facing the ball, earns 0.354 a step: with a
    discount below 0.996 that is worth less than the contact. The undiscounted
    return rewards hovering; compare policies by success and time.

    **Start**: ball and robot are anywhere at least 0.1 m inside the lines and at least 0.2 m apart, with any
    heading in [-pi, pi), at rest.

    **End**: terminated by contact, which is success; truncated after 330 steps
    (9.9 s).

    Args:
        settings: a :class:`~robobt.learning.envs.GoToBallSettings` or a mapping of its fields, as from a YAML
            file.
        render_mode: None or "rgb_array".
    """

    task_name = "go_to_ball"


class GoToBallVectorEnv(TaskVectorEnv):
    """Many arenas of :class:`GoToBallEnv`, which specifies observation, reward and ends."""

    task_name = "go_to_ball"
