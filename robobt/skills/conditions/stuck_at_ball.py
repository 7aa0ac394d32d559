"""Condition: this robot has been at the ball for a while and does not get it."""

from __future__ import annotations

from math import hypot, inf

from robobt.skills.base import Condition, skill
from robobt.skills.debounce import Debounce
from robobt.tree import Status

HELD = 0.1
"""How long the ball has to be held until the robot is not stuck any more [s]."""


@skill
class StuckAtBall(Condition):
    """SUCCESS once the robot has been near the ball for ``patience`` without having it, until it has it.

    Near is within ``distance`` between centres, and what says that it has the ball is the sensor in its
    mouth: a ball at the hull beside the mouth is what it is most often stuck at. Being away from the ball for
    0.1 s ends it, as having it does. To be ticked every tick; after a pause it counts anew.

    Args:
        distance: [m].
        patience: [s].

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
        self._stuck = Debounce(rise=self.patience, fall=HELD, on=False)
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
