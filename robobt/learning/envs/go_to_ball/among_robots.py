"""Go-To-Ball among robots that move, as Gymnasium knows it: its specification."""

from __future__ import annotations

from robobt.learning.envs.gymnasium_base import TaskEnv, TaskVectorEnv


class GoToBallAmongRobotsEnv(TaskEnv):
    """Go-To-Ball among robots: drive to the ball and touch nobody.

    :class:`~robobt.learning.envs.GoToBallEnv` with five other robots. What is given here are the defaults of
    :class:`~robobt.learning.envs.GoToBallAmongRobotsSettings`, where all of it can be changed.

    One step is a decision and holds for two control periods of 30 ms, each of 4 physics steps.

    **The others** drive to and fro between two points, with a top speed of 0.5 to 1.5 m/s, and look at nothing.
    One that is held up for 10 periods turns round.

    **Observation**, float32, :data:`robobt.world.avoiding.GO_TO_BALL_AMONG_ROBOTS`; the frame is the robot's,
    x ahead and y to its left:

    | entry | meaning | unit | range |
    | --- | --- | --- | --- |
    | 0, 1 | direction to the ball, of length 1 | 1 | [-1, 1] |
    | 2 | distance of the centres of robot and ball | m | [0, diagonal inside the walls] |
    | 3, 4, 5 | the robot's velocity and turning rate | m/s, rad/s | as for Go-To-Ball |
    | 6 to 21 | for how long 16 ways at 1.5 m/s stay free of others, evenly round, the first to the ball | s | [0, 2] |
    | 22 to 29 | the same for 8 ways at 0.75 m/s | s | [0, 2] |
    | 30 | the same for standing | s | [0, 2] |

    A way is free until the robot and another, if that goes on as it does, are nearer than 0.08 m hull to hull.

    **Action**: as for Go-To-Ball, at most 1.5 m/s and 1.395 rad/s.

    **Reward** a period of 30 ms; the weights are in
    :class:`~robobt.learning.envs.go_to_ball.rewards.GoToBallReward`:

    | term | value |
    | --- | --- |
    | contact | 5 where the ball is reached |
    | touched | -5 where another robot is touched |
    | closing | 0.015 times the speed towards the ball: 0.5 for each metre |
    | near | -0.05 (1 - gap / 0.2 m), where the nearest robot is nearer than 0.2 m |
    | time | -0.005 |

    **Start**: ball and robot each anywhere inside the lines less 0.1 m, at least 2 m apart, the robot with any
    heading, both at rest. The ends of the others' ways are anywhere there, at least 1.5 m apart; with a chance of
    0.6 a way crosses the straight one from robot to ball. No way comes nearer to the ball than 0.4 m. They begin
    somewhere on their ways, at their top speed, at least 1 m from the robot and 0.27 m from each other.

    **End**: terminated within 0.2 m of the ball, which is success; terminated by a touch, two centres within
    0.185 m; truncated after 330 periods (9.9 s).

    Args:
        settings: a :class:`~robobt.learning.envs.GoToBallAmongRobotsSettings` or the mapping that makes one, as
            out of a YAML file.
        render_mode: None or "rgb_array".
    """  # noqa: E501 - a table's row is a line

    task_name = "go_to_ball_among_robots"


class GoToBallAmongRobotsVectorEnv(TaskVectorEnv):
    """Many arenas of :class:`GoToBallAmongRobotsEnv`, which says what is observed, rewarded and ended."""

    task_name = "go_to_ball_among_robots"
