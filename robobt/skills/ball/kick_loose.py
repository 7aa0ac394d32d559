"""Kick a ball loose that two opposing robots both hold."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, inf

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
        if not has_ball(me, ball) or not any(has_ball(other, ball) for other in frame.opponents):
            return self.fail("no opponent holds the ball too")
        patience = self.patience * carrying_share(me.limits)
        if not has_lasted(self._hold, now, me.heading, patience):
            return self.fail("it may get away with the ball yet")
        command = self.store.command
        command.vx, command.kick_speed, command.kick_trigger = (
            FOLLOW,
            LOOSE_KICK_SPEED,
            KickTrigger.ON_CONTACT,
        )
        return self.run("kicking it loose")
