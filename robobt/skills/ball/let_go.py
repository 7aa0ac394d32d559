"""Let go of the ball."""

from __future__ import annotations

from math import cos, sin

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import KickTrigger

FASTER = 1.0
"""How much faster than along the heading so far the ball leaves [m/s]."""


@skill
class LetGo(Skill):
    """Get off the ball at once: push it ahead with the kicker, gently, and brake.

    Runs for as long as it is ticked. A robot that only brakes is soon off a ball that it drives at, but takes
    one that it carries sideways along for up to another 0.5 m. Looking towards its own goal, in its own half,
    it only brakes.
    """

    def on_running(self) -> Status:
        """Kick if the ball is before the kicker."""
        ball, heading, command = self.ball, self.me.heading, self.store.command
        if ball.x > 0.0 or cos(heading) > 0.0:
            along = cos(heading) * ball.vx + sin(heading) * ball.vy
            command.kick_speed, command.kick_trigger = max(0.0, along) + FASTER, KickTrigger.NOW
        return self.run("letting go")
