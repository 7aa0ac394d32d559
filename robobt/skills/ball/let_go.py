"""Let go of the ball."""

from __future__ import annotations

from math import cos, sin

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import KickTrigger
from robobt.world.compiled import compilable
from robobt.world.records import Ball, Robot
from robobt.world.rules import keeps_ball

FASTER = 1.0
"""How much faster the ball leaves than it moved along the heading before [m/s]."""

BACKING = 1.0
"""Speed with which a robot backs away from a ball that lies in its mouth [m/s]."""

_BACKS_BELOW = 0.1
"""A robot that drives ahead more slowly than this backs away [m/s]."""


@skill
class LetGo(Skill):
    """Release the ball at once: push it gently ahead with the kicker, and brake.

    Runs for as long as it is ticked. Braking alone soon separates the robot from a ball in its direction of
    travel, but a ball carried sideways would stay for up to another 0.5 m. In its own half, facing its own
    goal, the robot only brakes, and backs away once it has stopped: the ball may still be in its mouth.
    """

    def on_running(self) -> Status:
        """Kick if the ball is before the kicker."""
        me, ball, command = self.me, self.ball, self.store.command
        speed = push_speed(me, ball)
        if speed > 0.0 and keeps_ball(me, ball):
            command.kick_speed, command.kick_trigger = speed, KickTrigger.NOW
        elif cos(me.heading) * me.vx + sin(me.heading) * me.vy < _BACKS_BELOW:
            command.vx = -BACKING
        return self.run("letting go")


@compilable
def push_speed(me: Robot, ball: Ball, side: float = 1.0) -> float:
    """Return the speed with which the kicker pushes the ball off [m/s]; 0 where it backs away.

    ``side`` is 1 for a team that attacks towards +x, -1 for one that attacks towards -x.
    """
    if side * ball.x <= 0.0 and side * cos(me.heading) <= 0.0:
        return 0.0
    return max(0.0, cos(me.heading) * ball.vx + sin(me.heading) * ball.vy) + FASTER
