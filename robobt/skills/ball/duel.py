"""Get the ball from one opponent and score, all of it learned."""

from __future__ import annotations

from robobt.skills.ball.policy_skill import PolicySkill
from robobt.skills.base import skill


@skill
class Duel(PolicySkill):
    """Play one against one by a trained policy: get the ball, keep it, score; runs for as long as ticked.

    It sees the nearest opponent and no mate, and carries the ball as far as it likes. It decides as often as
    in training, and fails, and the robot stops, when the policy's answer is not a valid action.

    Args:
        policy: name or file of a model for Duel (``robobt train duel`` or ``duel_with_script``); without one
            the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    doing = "in the duel"
