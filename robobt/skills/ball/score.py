"""Get the ball and score, all of it learned."""

from __future__ import annotations

from robobt.skills.ball.policy_skill import PolicySkill
from robobt.skills.base import skill


@skill
class Score(PolicySkill):
    """Attack by a trained policy, from first touch to goal; runs for as long as it is ticked.

    What it knows of others is what its model was trained to see. One of Score-On-Goalkeeper looks at the
    goalkeeper alone (:data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`); one of
    Score-On-Goalkeeper-And-Defenders at the nearest opponents (:func:`robobt.world.team_view.team_view`), as
    many as it was trained against. Other robots it drives into, so that with more on the field conditions
    have to stand beside it. It decides as often as in training, and fails, and the robot stops, when the
    policy's answer is not a valid action.

    Args:
        policy: name or file of a model for Score (``robobt train score_on_goalkeeper`` or
            ``score_on_goalkeeper_and_defenders``); without one the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    doing = "attacking"
