"""Kick a ball loose that two opposing robots both hold."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, inf, sin

from robobt.motion.dribbling import carrying_share
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import KickTrigger
from robobt.world.compiled import compilable
from robobt.world.rules import has_ball

_HOLD_INTERRUPTION = 0.1
"""An interruption longer than this resets the hold's duration [s]."""

LOOSE_KICK_SPEED = 2.0
"""Speed of the kick: the ball comes out to the side and should stay in the field [m/s]."""

FOLLOW = 0.3
"""How fast the robot goes after the ball [m/s]."""

_TWIST = 6.0
"""Turning rate at which a ball leaves two weak dribblers sideways [rad/s]."""


@dataclass(slots=True)
class Hold:
    """Since when, and when last, an opponent held the ball too [s]."""

    since: float = -inf
    seen: float = -inf


@compilable
def has_lasted(hold: Hold, now: float, heading: float, patience: float) -> bool:
    """Note that an opponent holds the ball too; return whether the hold has lasted long enough to kick.

    ``heading`` is the robot's [rad], ``patience`` as in :class:`KickLoose`.
    """
    if not 0.0 <= now - hold.seen < _HOLD_INTERRUPTION:
        hold.since = now
    hold.seen = now
    return now - hold.since >= patience * (1.0 if cos(heading) > 0.0 else 2.0)


@skill
class KickLoose(Skill):
    """Release a ball that an opponent also holds, and kick it.

    Two dribblers can hold a ball between them for as long as both turn: grSim attaches the ball to each robot
    that holds it, so neither can drive away with it. FAILURE without such a hold, and until it has lasted for
    ``patience``, or twice that if the robot faces its own goal.

    Args:
        patience: how long the robot first tries to drive away with the ball [s]; less with a weak dribbler.

    Raises:
        ValueError: ``patience`` is not positive.
    """

    patience: float = 0.6
    _hold: Hold = field(default_factory=Hold, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.patience > 0.0:
            raise ValueError(f"patience must be positive, not {self.patience}")

    def on_running(self) -> Status:
        """Look for a hold, and kick once it has lasted."""
        frame, me, ball, now = self.frame, self.me, self.ball, self.frame.time
        holders = [other for other in frame.opponents if has_ball(other, ball)]
        if not has_ball(me, ball) or not holders:
            return self.fail("no opponent holds the ball too")
        strength = carrying_share(me.limits)
        patience = self.patience * strength
        if not has_lasted(self._hold, now, me.heading, patience):
            return self.fail("it may get away with the ball yet")
        command = self.store.command
        if strength < 1.0:
            # Two rollers drive a kicked ball back between them, but neither holds one that is turned out.
            other = holders[0]
            left = cos(me.heading) * (other.y - me.y) - sin(me.heading) * (other.x - me.x)
            command.vx, command.omega, command.dribbler = FOLLOW, -_TWIST if left > 0.0 else _TWIST, True
            return self.run("turning it out")
        command.vx, command.kick_speed, command.kick_trigger = (
            FOLLOW,
            LOOSE_KICK_SPEED,
            KickTrigger.ON_CONTACT,
        )
        return self.run("kicking it loose")
