"""Drive to and fro, as obstacles of a challenge do."""

from __future__ import annotations

from dataclasses import field

from robobt.motion.pilot import drive
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import Point, distance

_TURNS_WITHIN = 0.03
"""Distance from an end at which an obstacle turns back [m]."""

_PATROL_ACCELERATION = 1.0
"""Acceleration of a moving obstacle, gentle so that it keeps a ball [m/s^2]."""


@skill
class ToAndFro(Skill):
    """Drive to and fro between where it started and another point, whatever is in the way; never ends.

    Args:
        to: the other point [m]; None stands still.
        speed: top speed [m/s].
        dribbler: whether the dribbler turns, to carry a ball along.
    """

    to: Point | None = None
    speed: float = 1.0
    dribbler: bool = False
    _home: tuple[Point, float] | None = field(default=None, init=False)
    _back: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Drive one tick."""
        me = self.me
        if self._home is None:
            self._home = me.position, me.heading
        home, heading = self._home
        target = home if self.to is None or self._back else self.to
        if self.to is not None and distance(me.position, target) < _TURNS_WITHIN:
            self._back = not self._back
            target = home if self._back else self.to
        limits = me.limits.model_copy(
            update={
                "max_speed": self.speed,
                "acceleration": _PATROL_ACCELERATION,
                "side_acceleration": _PATROL_ACCELERATION,
                "braking": _PATROL_ACCELERATION,
                "side_braking": _PATROL_ACCELERATION,
            }
        )
        self.store.command = drive(me, target, heading, limits, self.frame.period)
        self.store.command.dribbler = self.dribbler
        return self.run("to and fro")
