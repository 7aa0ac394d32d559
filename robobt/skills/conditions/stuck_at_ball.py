"""Condition: this robot has been at the ball for a while and does not get it."""

from __future__ import annotations

from math import hypot, inf

from robobt.skills.base import Condition, skill
from robobt.skills.debounce import Debounce
from robobt.tree import Status

HOLDING_TIME = 0.1
"""Time for which the robot has to hold the ball to be no longer stuck [s]."""


@skill
class StuckAtBall(Condition):
    """SUCCESS once the robot has been near the ball for ``patience`` without having it, until it has it.

    Near means within ``distance`` between centres. Having the ball is decided by the sensor in the mouth,
    because a robot is most often stuck at a ball that touches its hull beside the mouth. Being away from the
    ball or having it for 0.1 s resets the condition. Tick it in every tick; a pause resets the count.

    Args:
        distance: between the centres of robot and ball [m].
        patience: time near the ball without having it [s].

    Raises:
        ValueError: ``distance`` or ``patience`` is negative.
    """

    distance: float = 0.4
    patience: float = 0.6

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("distance", "patience"):
            value = getattr(self, name)
            if not value >= 0.0:
                raise ValueError(f"{name} must be 0 or more, not {value:g}")
        self._restart()

    def _restart(self) -> None:
        self._stuck = Debounce(rise=self.patience, fall=HOLDING_TIME, on=False)
        self._seen = -inf

    def on_running(self) -> Status:
        """Count the time."""
        me, ball, now = self.me, self.ball, self.frame.time
        if not 0.0 <= now - self._seen < 2.5 * self.frame.period:
            self._restart()
        self._seen = now
        free = hypot(ball.x - me.x, ball.y - me.y) <= self.distance and not me.ball_contact
        if self._stuck.update(free, now):
            return self.succeed("it does not get the ball")
        return self.fail("it is not stuck")
