"""Go-To-Ball among moving robots."""

from __future__ import annotations

from robobt.learning.envs.go_to_ball.settings import GoToBallAmongRobotsSettings
from robobt.learning.envs.go_to_ball.task import GoToBallTask


class GoToBallAmongRobotsTask(GoToBallTask):
    """Drive to the ball among other robots.

    :class:`~robobt.learning.envs.GoToBallTask` with five other robots. The values below are the defaults of
    :class:`~robobt.learning.envs.GoToBallAmongRobotsSettings`, where all of them can be changed.

    One step is a decision that holds for two control periods of 30 ms, each of 4 physics steps.

    **The others** drive back and forth between two points, with a top speed of 0.5 to 1.5 m/s, and ignore all
    robots. A robot that is blocked for 10 periods turns round.

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

    A way is free until the robot and another robot with constant velocity are nearer than 0.08 m hull to
    hull.

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

    **Start**: ball and robot are anywhere at least 0.1 m inside the lines and at least 2 m apart, the robot
    with any heading, both at rest. The ends of the others' ways are also anywhere there, at least 1.5 m
    apart; with probability 0.6 a way crosses the straight line from robot to ball. No way comes closer to the
    ball than 0.4 m. The others start anywhere on their ways, at top speed, at least 1 m from the robot and
    0.27 m from each other.

    **End**: terminated within 0.2 m of the ball, which is success; terminated by a touch, two centres within
    0.185 m; truncated after 330 periods (9.9 s).
    """  # noqa: E501 - a table's row is a line

    Settings = GoToBallAmongRobotsSettings
