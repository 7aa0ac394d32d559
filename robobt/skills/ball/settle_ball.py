"""Come to rest with a ball that was taken on the move."""

from __future__ import annotations

from dataclasses import field

from robobt.motion.dribbling import dribbling_limits, turn_with_ball
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.rules import has_ball


@skill
class SettleBall(Skill):
    """Brake with the ball, as hard as the dribbler bears, until it is slow enough to be turned with.

    FAILURE without the ball, and from then on until it has been lost for ``pause``: what the robot
    does with the ball afterwards may be as fast as it likes. To be ticked every tick.

    Args:
        slow: speed of the ball at which it is settled [m/s].
        pause: so long after the robot had the ball it takes it anew [s].
        share: share of what the dribbler bears.

    Raises:
        ValueError: ``slow`` or ``pause`` is negative, or ``share`` is not above 0 and at most 1.
    """

    slow: float = 0.6
    pause: float = 0.3
    share: float = 0.85
    _settled: bool = field(default=False, init=False)
    _had: float = field(default=-10.0, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        for setting in ("slow", "pause"):
            if not getattr(self, setting) >= 0.0:
                raise ValueError(f"{setting} must be 0 or more, not {getattr(self, setting)}")
        if not 0.0 < self.share <= 1.0:
            raise ValueError(f"share must be above 0 and at most 1, not {self.share}")

    def on_running(self) -> Status:
        """Brake for one tick."""
        frame, me, ball = self.frame, self.me, self.ball
        if not has_ball(me, ball):
            return self.fail("it does not have the ball")
        if frame.time - self._had > self.pause:
            self._settled = False
        self._had = frame.time
        self._settled = self._settled or ball.speed < self.slow
        if self._settled:
            return self.fail("the ball is settled")
        limits = dribbling_limits(max_acceleration=self.share * me.limits.hold_acceleration)
        self.store.command = turn_with_ball(me, me.heading, limits, frame.period)
        return self.run("braking with the ball")
