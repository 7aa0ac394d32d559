"""An attacker driven by one learned policy."""

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

    The policy sees only the robots that it was trained to see, and ignores the rules: it carries the ball any
    distance, so use it in scenarios without a referee. The shipped model ``score_on_goalkeeper_ppo`` plays
    against one goalkeeper; other models are for defenders and for a duel (docs/several_robots.md).

    With robots or a ball that differ from training, a policy may stop at a ball that it does not get into its
    mouth. Then hand-written skills get the ball, and the policy continues from there.

    Args:
        policy: name or file of a model for Score, Duel or another task with several robots; without a model
            the robot stands still.
        patience: how long the robot may be at the ball without getting it [s].
    """
    if not policy:
        return Score()
    return first_of("attack", get_where_stuck(patience), learned(policy))


def learned(policy: str) -> Skill:
    """Return the leaf for which the model was trained.

    Args:
        policy: name or file of a model for Score, Duel or another task with several robots.

    Raises:
        ModelError: it is another model; the message names its skill and task, and those that fit.
    """
    attacks = "Score", "Duel", "LearnedSkill"
    skill = read_fitting_model(policy, kind="policy", skill=attacks).card.skill
    if skill == "Duel":
        return Duel(policy=policy)
    return Score(policy=policy) if skill == "Score" else LearnedSkill(model=policy)
