"""Clear the ball while the opponents or the referee have it."""

from __future__ import annotations

from math import cos, pi, sin

from robobt.motion.path_planner import allowed_target
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.game import Restart
from robobt.world.geometry import Point, closest_point_on_segment, direction, distance
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

_MARGIN = 0.05
_TURNS = (0.0, 0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0, -2.0, 2.5, -2.5, pi)


@skill
class KeepDistance(Skill):
    """Drive away from the ball, from where it will be put down and from the way there.

    SUCCESS once the hull is at least ``distance`` away from them; no faster than the rules
    allow on the way.

    Args:
        distance: from the hull to the ball [m].
        goalkeeper: may stay in the own defence area.
    """

    distance: float = STOP_DISTANCE
    goalkeeper: bool = False

    def on_running(self) -> Status:
        """Drive straight away from the place that is too near."""
        frame, me = self.frame, self.me
        keep = self.distance + ROBOT_RADIUS + _MARGIN
        game, places = frame.game, [frame.ball.position]
        if game.placement is not None and not game.in_play:
            # First of all from where the ball will lie; where it rolls now it will not stay.
            places.insert(0, game.placement)
            if game.restart is Restart.BALL_PLACEMENT:
                # Whoever places the ball needs the way to the spot free, too.
                places = [closest_point_on_segment(me.position, frame.ball.position, game.placement)]
        near = [place for place in places if distance(me.position, place) < keep]
        if not near:
            return self.succeed("far enough")
        # Aimed farther than needed, so that the robot does not creep up to the limit.
        target = way_out(frame, me, near[0], keep + 2.0 * _MARGIN, goalkeeper=self.goalkeeper)
        self.drive_to(target, near[0], goalkeeper=self.goalkeeper, thereabouts=True)
        return self.run("clearing the ball")


def way_out(frame: Frame, me: RobotState, place: Point, reach: float, *, goalkeeper: bool = False) -> Point:
    """Return a point straight away from ``place``, or as little aside as robots may stand there.

    ``reach`` is how far to go [m]; ``goalkeeper`` says whether the robot may stay in its own defence area.
    """
    away = direction(place, me.position)
    for turn in _TURNS:
        target = (place[0] + reach * cos(away + turn), place[1] + reach * sin(away + turn))
        if allowed_target(frame, me, target, goalkeeper=goalkeeper) == target:
            return target
    return (0.0, 0.0)
