"""Take position for a penalty kick."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.state import ROBOT_RADIUS

_WAITING_DISTANCE = 1.0 + 3.0 * ROBOT_RADIUS
"""Distance behind mark and ball at which all but kicker and goalkeeper wait; the rules ask for 1 m [m]."""


@skill
class GoToPenaltyPosition(Skill):
    """Wait behind the ball until the penalty kick is over; the goalkeeper waits on its goal line.

    Robots spread over the field's width in order of their numbers, each team on
    its own left. Never ends by itself. The kicking team's goalkeeper waits before its goal.

    Args:
        goalkeeper: whether this robot is the goalkeeper.
    """

    goalkeeper: bool = False

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame, me = self.frame, self.me
        field, game = frame.field, frame.game
        ours = (game.penalty or game.restart_team) is frame.team
        away = -1.0 if ours else 1.0
        mark = away * (field.penalty_distance - field.half_length)
        if self.goalkeeper:
            target = (-field.half_length + (0.5 * field.defense_depth if ours else 0.5 * ROBOT_RADIUS), 0.0)
        else:
            number = [robot.id for robot in frame.own].index(me.id)
            y = (number + 0.5) / len(frame.own) * field.half_width
            # This also holds when the ball rolls back during play.
            x = away * (max(away * mark, away * frame.ball.x) + _WAITING_DISTANCE)
            target = (x, y)
        self.drive_to(target, frame.ball.position, avoid_ball=True, goalkeeper=self.goalkeeper)
        return self.run("taking position")
