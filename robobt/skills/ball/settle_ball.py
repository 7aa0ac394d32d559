"""Come to rest with a ball that was taken on the move."""

from __future__ import annotations

from dataclasses import dataclass, field

from robobt.motion.dribbling import dribbling_limits, turn_with_ball
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.rules import CARRY_DISTANCE, has_ball


@dataclass(slots=True)
class Settling:
    """When the robot last had the ball [s], and whether the ball has been slow since the robot took it."""

    had: float = -10.0
    settled: float = 0.0


@compilable
def is_settled(settling: Settling, now: float, speed: float, slow: float, pause: float) -> bool:
    """Note that the robot has a ball of this ``speed`` [m/s]; return whether the robot may turn with it.

    ``slow`` and ``pause`` are as in :class:`SettleBall`.
    """
    settled = (settling.settled > 0.0 and now - settling.had <= pause) or speed < slow
    settling.had, settling.settled = now, 1.0 if settled else 0.0
    return settled


@compilable
def is_braked(speed: float, held: float) -> bool:
    """Return whether a dribbler that holds the ball against ``held`` can stop it within the rules' distance.

    ``speed`` is the ball's [m/s], ``held`` an acceleration [m/s^2].
    """
    return speed * speed <= 2.0 * held * CARRY_DISTANCE


@skill
class SettleBall(Skill):
    """Brake with the ball, as hard as the dribbler can hold it, until it is slow enough to turn with.

    A ball too fast to be stopped that way within a metre, the rules' limit for dribbling, is let go: the
    robot brakes as hard as it can, and takes the ball again once it has slowed down.

    FAILURE without the ball, and once it has settled until it has been lost for ``pause``: afterwards the
    robot may move with the ball at any speed. Tick it in every tick.

    Args:
        slow: speed of the ball at which it is settled [m/s].
        pause: time without the ball after which it has to settle again [s].
        share: share of the deceleration at which the dribbler still holds the ball.

    Raises:
        ValueError: ``slow`` or ``pause`` is negative, or ``share`` is not above 0 and at most 1.
    """

    slow: float = 0.6
    pause: float = 0.3
    share: float = 0.85
    _settling: Settling = field(default_factory=Settling, init=False)

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
        if is_settled(self._settling, frame.time, ball.speed, self.slow, self.pause):
            return self.fail("the ball is settled")
        held = self.share * me.limits.holds_straight
        if not is_braked(ball.speed, held):
            self.store.command = turn_with_ball(me, me.heading, me.limits, frame.period)
            return self.run("letting it roll ahead")
        limits = dribbling_limits(max_acceleration=held)
        self.store.command = turn_with_ball(me, me.heading, limits, frame.period)
        return self.run("braking with the ball")
