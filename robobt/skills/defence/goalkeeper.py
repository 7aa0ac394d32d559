"""Keep goal, all of it learned."""

from __future__ import annotations

from robobt.skills.ball.policy_skill import PolicySkill
from robobt.skills.base import skill


@skill
class Goalkeeper(PolicySkill):
    """Keep the own goal by a trained policy; runs for as long as it is ticked.

    It was trained against one attacker with the ball in the own half and sees the nearest opponent alone. It
    knows nothing of the referee, of mates, or of what to do with a ball that it has: those are for the tree
    round it. It decides as often as in training, and fails, and the robot stops, when the policy's answer is
    not a valid action.

    Args:
        policy: name or file of a model for Goalkeeper (``robobt train save``); without one the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    doing = "keeping goal"
