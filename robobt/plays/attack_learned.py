"""The robot that attacks by what it has learned."""

from __future__ import annotations

from robobt.models.find import read_fitting_model
from robobt.plays.base import PLAYS, first_of
from robobt.plays.stuck import get_where_stuck
from robobt.skills.ball.duel import Duel
from robobt.skills.ball.learned_skill import LearnedSkill
from robobt.skills.ball.score import Score
from robobt.skills.base import Skill
from robobt.tree import Behaviour


@PLAYS.register("attack_learned")
def attack_learned(*, policy: str = "", patience: float = 0.6) -> Behaviour:
    """Get the ball and score by one learned policy, from first touch to goal.

    It knows of other robots what it was trained to see, and of rules nothing: it carries the ball as far as
    it likes, so that it is for scenarios without a referee. ``score_on_goalkeeper_ppo`` ships for one
    goalkeeper, others for its defenders and for a duel: docs/several_robots.md says what they can do.

    Where robots and ball are others than in training, a policy may stop at a ball that it does not get into
    its mouth. Then the written skills get the ball, and it goes on from there.

    Args:
        policy: name or file of a model for Score or Duel, or of another task of several robots; without one
            the robot stands still.
        patience: how long it may be at the ball without getting it [s].
    """
    if not policy:
        return Score()
    return first_of("attack", get_where_stuck(patience), learned(policy))


def learned(policy: str) -> Skill:
    """Return the leaf for which the model was trained."""
    skill = read_fitting_model(policy, kind="policy").card.skill
    if skill == "Duel":
        return Duel(policy=policy)
    return Score(policy=policy) if skill == "Score" else LearnedSkill(model=policy)
