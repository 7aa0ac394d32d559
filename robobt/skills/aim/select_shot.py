"""Choose where to shoot."""

from __future__ import annotations

from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch
from robobt.skills.aim.raters import Rater, make_rater
from robobt.skills.aim.raters.goal_line import judged_goal_line
from robobt.skills.aim.raters.shot_predictor import LearnedRater
from robobt.skills.base import Skill, skill
from robobt.skills.store import Shot
from robobt.tree import Status
from robobt.world.geometry import Point, direction, distance, wrap_angle


@skill
class SelectShot(Skill):
    """Rate the shots from where the ball lies and write the best one to ``shot``.

    SUCCESS when there is one good enough. FAILURE otherwise, with the reason, and
    ``shot`` is None. If the rater judges every point of the goal line, the result is written to ``goal_line``
    for recordings and display.

    Args:
        rater: a shot rater: its name, ``{name: NAME, SETTING: VALUE}``, or the rater itself.
        min_score: worst score still accepted, 0 to 1; its meaning depends on the rater.
        max_distance: no shots from farther than this from the goal's centre [m]; None for no limit.
        keep: stay with the opening of the last shot while it scores at most this much worse than the best, so
            that the aim does not jump between two similar openings.
    """

    reads = ("shot",)
    writes = ("shot", "goal_line")
    optional = ("shot",)

    rater: Rater = "segment_clearance"
    min_score: float = 0.0
    max_distance: float | None = None
    keep: float = 0.1

    def __post_init__(self) -> None:
        super().__post_init__()
        self._rater = make_rater(self.rater)

    def on_running(self) -> Status:
        """Rate and choose."""
        last, self.store.shot = self.store.shot, None
        judged, self.store.goal_line = self.store.goal_line, None
        frame = self.frame
        watch = self.store.team.shared(GoalkeeperWatch)
        watch.follow(frame)
        origin = self.ball.position
        if self.max_distance is not None and distance(origin, frame.field.their_goal) > self.max_distance:
            return self.fail(f"farther than {self.max_distance:g} m from the goal")
        if isinstance(self._rater, LearnedRater):
            shots, chances = self._rater.judge(frame, origin, self.me, watch=watch)
        else:
            shots, chances = self._rater.judge(frame, origin, self.me)
        if chances is not None:
            self.store.goal_line = judged_goal_line(*chances, judged)
        if not shots:
            return self.fail("no way to the goal is free")
        best = shots[0].score
        if best < self.min_score:
            return self.fail(f"the best shot scores {best:.2f}")
        shot = shots[0] if last is None else _stay(shots, last, origin, max(self.min_score, best - self.keep))
        self.store.shot = shot
        return self.succeed(f"score {shot.score:.2f}")


def _stay(shots: list[Shot], last: Shot, origin: Point, worst: float) -> Shot:
    """Return the best shot, unless ``last`` aims into another opening that scores at least ``worst``."""
    aim = direction(origin, last.target)
    for shot in shots:
        if shot.score < worst:
            break
        if abs(wrap_angle(direction(origin, shot.target) - aim)) <= shot.tolerance:
            return shot
    return shots[0]
