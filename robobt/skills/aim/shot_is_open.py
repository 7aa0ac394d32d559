"""Is there a shot worth taking?"""

from __future__ import annotations

from robobt.skills.aim.raters import Rater, make_rater
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import distance


@skill
class ShotIsOpen(Skill):
    """SUCCESS when a shot from where the ball lies is good enough, else FAILURE with the reason.

    Rates as :class:`SelectShot` does and writes nothing.

    Args:
        rater: a shot rater: its name, ``{name: NAME, SETTING: VALUE}``, or the rater itself.
        min_score: worst score still accepted, 0 to 1.
        max_distance: no shots from farther than this from the goal's centre [m]; None for no limit.
    """

    rater: Rater = "segment_clearance"
    min_score: float = 0.0
    max_distance: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._rater = make_rater(self.rater)

    def on_running(self) -> Status:
        """Rate and compare."""
        frame = self.frame
        origin = self.ball.position
        if self.max_distance is not None and distance(origin, frame.field.their_goal) > self.max_distance:
            return self.fail(f"farther than {self.max_distance:g} m from the goal")
        shot = self._rater.rate(frame, origin, self.me)
        if shot is None:
            return self.fail("no way to the goal is free")
        if shot.score < self.min_score:
            return self.fail(f"the best shot scores {shot.score:.2f}")
        return self.succeed(f"score {shot.score:.2f}")
