"""The robot that attacks by what it has learned."""

from __future__ import annotations

from robobt.plays.base import PLAYS
from robobt.skills.ball.score import Score
from robobt.tree import Behaviour


@PLAYS.register("attack_learned")
def attack_learned(*, policy: str = "") -> Behaviour:
    """Get the ball and score on the goalkeeper by one learned policy, from first touch to goal.

    It learned in the attacked half, alone with a goalkeeper: it sees no other robot, and carries the ball
    as far as it likes, so that it is for scenarios of one attacker without a referee. No model for it
    ships: see what they can do in docs/learning.md, and train your own.

    Args:
        policy: name or file of a model for Score; without one the robot stands still.
    """
    return Score(policy=policy)
