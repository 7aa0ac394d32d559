"""Take position for a penalty kick."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.state import ROBOT_RADIUS

_BEHIND = 1.0 + 2.0 * ROBOT_RADIUS
"""How far behind the ball everybody but kicker and goalkeeper waits; the rules ask for 1 m [m]."""


@skill
class GoToPenaltyPosition(Skill):
    """Wait behind the ball; the goalkeeper waits on its goal line.

    Robots spread over the field's width in order of their numbers, each team on
    its own left. Never ends by itself.

    Args:
        goalkeeper: whether this robot is the goalkeeper.
    """

    goalkeeper: bool = False

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame, me = self.frame, self.me
        field, game = frame.field, frame.game
        spot = game.placement or frame.ball.position
        ours = game.restart_team is frame.team
        if self.goalkeeper and not ours:
            target = (ROBOT_RADIUS / 2 - field.half_length, 0.0)
        else:
            number = [robot.id for robot in frame.own].index(me.id)
            y = (number + 0.5) / len(frame.own) * field.half_width
            x = spot[0] - _BEHIND if ours else spot[0] + _BEHIND
            target = (x, y)
        self.drive_to(target, spot, avoid_ball=True, goalkeeper=self.goalkeeper)
        return self.run("taking position")
