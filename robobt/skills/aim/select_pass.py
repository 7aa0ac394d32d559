"""Choose whom to pass to."""

from __future__ import annotations

from dataclasses import field

from robobt.skills.aim.pass_rater import PassRater
from robobt.skills.base import Skill, skill
from robobt.skills.rate_limit import RateLimit
from robobt.skills.store import Pass
from robobt.tree import Status


@skill
class SelectPass(Skill):
    """Rate the passes from where the ball lies and write the best one to ``pass_``.

    SUCCESS when there is one good enough. FAILURE otherwise, with the reason, and
    ``pass_`` is None.

    Args:
        rater: judges the passes; its settings define what counts and how much.
        min_score: worst score still accepted, 0 to 1.
        keep: stay with the last receiver while it scores at most this much worse
            than the best.
        every: time between two ratings [s]; in between the last choice is kept.
    """

    reads = ("pass_",)
    writes = ("pass_",)
    optional = ("pass_",)

    rater: PassRater | None = None
    min_score: float = 0.3
    keep: float = 0.1
    every: float = 0.1
    _choice: Pass | None = field(default=None, init=False)
    _remark: str = field(default="", init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._rater = self.rater or PassRater()
        self._look = RateLimit(self.every)

    def on_running(self) -> Status:
        """Choose again when ``every`` has passed."""
        if self._look.due(self.frame.time):
            self._choice, self._remark = self._choose()
        self.store.pass_ = self._choice
        return self.fail(self._remark) if self._choice is None else self.succeed(self._remark)

    def _choose(self) -> tuple[Pass | None, str]:
        passes = self._rater.rate_all(self.frame, self.me)
        if not passes:
            return None, "no team-mate can be reached"
        best = passes[0]
        last = self.store.pass_
        if last is not None:
            for other in passes:
                if other.receiver == last.receiver and other.score >= best.score - self.keep:
                    best = other
        if best.score < self.min_score:
            return None, f"the best pass scores {best.score:.2f}"
        return best, f"to {best.receiver}, score {best.score:.2f}"
