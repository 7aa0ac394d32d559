"""Is there a pass worth playing?"""

from __future__ import annotations

from robobt.skills.aim.pass_rater import PassRater
from robobt.skills.base import Skill, skill
from robobt.tree import Status


@skill
class PassIsOpen(Skill):
    """SUCCESS when a pass from where the ball lies is good enough, else FAILURE with the reason.

    Rates as :class:`SelectPass` does and writes nothing.

    Args:
        rater: judges the passes; its settings define what counts and how much.
        min_score: worst score still accepted, 0 to 1.
    """

    rater: PassRater | None = None
    min_score: float = 0.3

    def __post_init__(self) -> None:
        super().__post_init__()
        self._rater = self.rater or PassRater()

    def on_running(self) -> Status:
        """Rate and compare."""
        passes = self._rater.rate_all(self.frame, self.me)
        if not passes:
            return self.fail("no team-mate can be reached")
        best = passes[0]
        if best.score < self.min_score:
            return self.fail(f"the best pass scores {best.score:.2f}")
        return self.succeed(f"to {best.receiver}, score {best.score:.2f}")
