"""Let go of the ball."""

from __future__ import annotations

from math import cos, sin

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import KickTrigger
from robobt.world.compiled import compilable
from robobt.world.records import Ball, Robot

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
        speed, command = push_speed(self.me, self.ball), self.store.command
        if speed > 0.0:
            command.kick_speed, command.kick_trigger = speed, KickTrigger.NOW
        return self.run("letting go")


@compilable
def push_speed(me: Robot, ball: Ball, side: float = 1.0) -> float:
    """Return the speed with which the kicker pushes the ball off [m/s]; 0 where the robot only brakes.

    ``side`` is 1 for a team that attacks towards +x, -1 for one that attacks towards -x.
    """
    if side * ball.x <= 0.0 and side * cos(me.heading) <= 0.0:
        return 0.0
    return max(0.0, cos(me.heading) * ball.vx + sin(me.heading) * ball.vy) + FASTER
