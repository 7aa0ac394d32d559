"""Get the ball and score, by one learned policy."""

from __future__ import annotations

from robobt.skills.ball.policy_skill import PolicySkill
from robobt.skills.base import skill
from robobt.tree import Status


@skill
class Score(PolicySkill):
    """Attack by a trained policy, from first touch to goal; runs for as long as it is ticked.

    The policy sees only the robots that its model was trained with. A model for Score-On-Goalkeeper sees the
    goalkeeper (:data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`); a model for
    Score-On-Goalkeeper-And-Defenders sees the nearest opponents (:func:`robobt.world.team_view.team_view`),
    as many as it was trained against. It drives into all other robots, so guard it with conditions if there
    are more. It decides as often as in training. If the policy's answer is not a valid action, the skill
    fails and the robot stops.

    A policy carries the ball as its robot in training could. A robot whose dribbler is much weaker loses it,
    also one whose dribbler loses a ball that it moves sideways (``limits.carry_aside``) if that in training
    did not. Hand-written skills then score as often or more often; with ``weakest`` the leaf leaves the ball
    to them.

    Args:
        policy: name or file of a model for Score (``robobt train score_on_goalkeeper`` or
            ``score_on_goalkeeper_and_defenders``); without one the leaf fails.
        weakest: the leaf fails on a robot whose dribbler holds less than this share of what the dribbler in
            training held (``limits.hold_acceleration``), 0 to 1; above 0 also on one that can carry a ball
            sideways only slowly, unless that is so in training.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
        ValueError: ``weakest`` is not 0 to 1.
    """

    doing = "attacking"

    weakest: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0.0 <= self.weakest <= 1.0:
            raise ValueError(f"weakest must be 0 to 1, not {self.weakest}")
        trained = None if self._control is None else self._control.card.limits
        self._least = 0.0 if trained is None else self.weakest * trained.hold_acceleration
        self._any_direction = self.weakest > 0.0 and trained is not None and trained.carry_aside is None

    def on_running(self) -> Status:
        """Decide, or repeat the last decision, for one tick."""
        limits = self.me.limits
        held = limits.hold_acceleration
        if held < self._least:
            return self.fail(f"its dribbler holds {held:g} m/s^2, less than the policy's {self._least:g}")
        if self._any_direction and limits.carry_aside is not None:
            return self.fail("its dribbler loses a ball sideways that the policy's kept")
        return super().on_running()
