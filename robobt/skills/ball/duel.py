"""Win the ball from one opponent and score, by one learned policy."""

from __future__ import annotations

from robobt.skills.ball.policy_skill import PolicySkill
from robobt.skills.base import skill


@skill
class Duel(PolicySkill):
    """Play one against one by a trained policy: get the ball, keep it, score; runs for as long as ticked.

    It sees the nearest opponent and no team-mates, and carries the ball without regard to the dribbling
    limit. It decides as often as in training. If the policy's answer is not a valid action, the skill fails
    and the robot stops.

    Args:
        policy: name or file of a model for Duel (``robobt train duel`` or ``duel_with_script``); without one
            the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    doing = "in the duel"
