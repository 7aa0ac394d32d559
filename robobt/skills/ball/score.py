"""Get the ball and score, by one learned policy."""

from __future__ import annotations

from robobt.skills.ball.policy_skill import PolicySkill
from robobt.skills.base import skill


@skill
class Score(PolicySkill):
    """Attack by a trained policy, from first touch to goal; runs for as long as it is ticked.

    The policy sees only the robots that its model was trained with. A model for Score-On-Goalkeeper sees the
    goalkeeper (:data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`); a model for
    Score-On-Goalkeeper-And-Defenders sees the nearest opponents (:func:`robobt.world.team_view.team_view`),
    as many as it was trained against. It drives into all other robots, so guard it with conditions if there
    are more. It decides as often as in training. If the policy's answer is not a valid action, the skill
    fails and the robot stops.

    Args:
        policy: name or file of a model for Score (``robobt train score_on_goalkeeper`` or
            ``score_on_goalkeeper_and_defenders``); without one the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    doing = "attacking"
