"""The specification of Score-On-Goalkeeper, for Gymnasium."""

from __future__ import annotations

from robobt.learning.envs.gymnasium_base import TaskEnv, TaskVectorEnv


class ScoreOnGoalkeeperEnv(TaskEnv):
    """Score-On-Goalkeeper: get the ball, carry it to where it can be kicked past the goalkeeper, and score.

    The values below are the defaults of :class:`~robobt.learning.envs.ScoreOnGoalkeeperSettings`, where all
    of them can be changed.

    One step is a decision that holds for two control periods of 30 ms, each of 4 physics steps. The
    dribbler is on all the time and holds the ball with limited force.

    **Observation**, float32, :data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`; the frame is the robot's, x
    ahead and y to its left; velocities are relative to the field:

    | entry | meaning | unit |
    | --- | --- | --- |
    | 0, 1, 2 | the robot's velocity and turning rate | m/s, rad/s |
    | 3, 4 | position of the ball | m |
    | 5, 6 | its velocity | m/s |
    | 7, 8 | sine and cosine of the angle from the heading to the middle of the goal | 1 |
    | 9, 10 | position of the goal's left post | m |
    | 11, 12 | that of the right one | m |
    | 13, 14 | position of the goalkeeper | m |
    | 15, 16 | its velocity | m/s |
    | 17 | where a kick would cross the goal line, from its middle, at most 1 m either way | m |
    | 18 | how far to the left of that shot the goalkeeper is, at most 0.5 m either way | m |

    **Action**, float32, :data:`robobt.models.actions.SCORE_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0, 1 | velocity ahead and to the left, shortened to 3 m/s together | 3 m/s | [-1, 1] |
    | 2 | turning rate | 6 rad/s | [-1, 1] |
    | 3 | kick where above 0, with 6 m/s, if the ball is in the mouth | - | [-1, 1] |

    **Goalkeeper**: drawn for each episode, with a top speed of 1 to 3 m/s and a place 0.12 to 0.6 m in front
    of the line. There are four kinds, which before a shot follow the ball, the line from ball to goal, or the
    attacker's heading, or come out towards the ball (:mod:`robobt.learning.opponents.keepers`). The shipped
    play ``goalkeeper`` is the kind ``shipped``. It is left out of training, so that it can be used in
    evaluations.

    **Reward** per period of 30 ms; the weights are in
    :class:`~robobt.learning.envs.score_on_goalkeeper.rewards.ScoreReward`:

    | term | value |
    | --- | --- |
    | goal | 5 on a goal |
    | lost | -0.5 where the episode ends without one |
    | time | -0.005 |
    | aimed | 0.1 on a kick between the posts |
    | unreached | up to 2 on such a kick: a quarter where it just passes out of the goalkeeper's reach, diving at 6 m/s^2, all of it 0.23 m farther off, nothing 0.08 m nearer |
    | miss | -0.2 on a kick that will not go between the posts |
    | approach, advance, facing | what the state is worth more than the one before, but for a shot on its way: -0.5 for each metre from robot to ball, -0.6 for each from robot to goal down to 1.5 m, 0.5 (1 + cos) of the heading to the goal with the ball in the mouth |

    **Start**: the attacker is in the attacked half, up to 0.4 m in front of the defence area, more often near
    the goal and turned towards it. In six of ten episodes the ball is in its mouth; otherwise it is anywhere
    there, at up to 0.5 m/s.

    **End**: terminated by a goal, which is success; terminated by a ball over a line, a ball that the
    goalkeeper has held for 8 periods or that rests where the goalkeeper may take it, and by an attacker in
    the defence area, or partly inside with the ball; truncated after 334 periods (10 s).

    Args:
        settings: a :class:`~robobt.learning.envs.ScoreOnGoalkeeperSettings` or a mapping of its fields, as
            from a YAML file.
        render_mode: None or "rgb_array".
    """  # noqa: E501 - a table's row is a line

    task_name = "score_on_goalkeeper"


class ScoreOnGoalkeeperVectorEnv(TaskVectorEnv):
    """Many arenas of :class:`ScoreOnGoalkeeperEnv`, which specifies observation, reward and ends."""

    task_name = "score_on_goalkeeper"
