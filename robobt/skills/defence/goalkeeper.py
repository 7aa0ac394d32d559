"""Keep goal, by one learned policy."""

from __future__ import annotations

from robobt.skills.ball.policy_skill import PolicySkill
from robobt.skills.base import skill


@skill
class Goalkeeper(PolicySkill):
    """Keep the own goal by a trained policy; runs for as long as it is ticked.

    It was trained against one attacker with the ball in the own half and sees only the nearest opponent. The
    referee, team-mates and what to do with a held ball are left to the tree around it. It decides as often as
    in training. If the policy's answer is not a valid action, the skill fails and the robot stops.

    Args:
        policy: name or file of a model for Goalkeeper (``robobt train save``); without one the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    doing = "keeping goal"
