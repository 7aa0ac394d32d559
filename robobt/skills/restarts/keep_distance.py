"""Clear the ball while the opponents or the referee have it."""

from __future__ import annotations

from math import cos, pi, sin

from robobt.motion.path_planner import allowed_target, travel
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import Point, direction, distance
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS

_MARGIN = 0.05
_TURNS = (0.0, 0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0, -2.0, 2.5, -2.5, pi)


@skill
class KeepDistance(Skill):
    """Drive away from the ball, and from where it will be put down, until far enough from both.

    SUCCESS once the hull is at least ``distance`` away; no faster than the rules
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
        places = [frame.ball.position]
        if frame.game.placement is not None and not frame.game.in_play:
            # First of all from where the ball will lie; where it rolls now it will not stay.
            places.insert(0, frame.game.placement)
        near = [place for place in places if distance(me.position, place) < keep]
        if not near:
            return self.succeed("far enough")
        # Aimed farther than needed, so that the robot does not creep up to the limit.
        target = self._way_out(near[0], keep + 2.0 * _MARGIN)
        self.store.command = travel(
            frame, me, target, direction(me.position, near[0]), me.limits, goalkeeper=self.goalkeeper
        )
        return self.run("clearing the ball")

    def _way_out(self, place: Point, reach: float) -> Point:
        """Return a point straight away from ``place``, or as little aside as robots may stand there."""
        frame, me = self.frame, self.me
        away = direction(place, me.position)
        for turn in _TURNS:
            target = (place[0] + reach * cos(away + turn), place[1] + reach * sin(away + turn))
            if allowed_target(frame, me, target, goalkeeper=self.goalkeeper) == target:
                return target
        return (0.0, 0.0)
