"""Keep away from the ball while the opponents or the referee have it."""

from __future__ import annotations

from dataclasses import field
from math import cos, inf, pi, sin

from robobt.motion.path_planner import allowed_target
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.game import Restart
from robobt.world.geometry import (
    Point,
    closest_point_on_segment,
    direction,
    distance,
    segment_distance,
    segments_distance,
)
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

_DISTANCE_MARGIN = 0.05
_WAY_OUT_TURNS = (0.0, *(side * step * pi / 12.0 for step in range(1, 12) for side in (1.0, -1.0)), pi)
_WAY_OUT_REACHES = (1.0, 1.5, 2.5)
"""The ways out that are tried: turn from the direction straight away, and factor on the distance."""

_DETOUR_COST = 0.2
"""Gap to the ball that a way out has to gain for each metre of additional length."""


@skill
class KeepDistance(Skill):
    """Drive away from the ball, from the spot of its placement and from the line between them.

    SUCCESS once the hull is at least ``distance`` away from them. The speed stays within the rules' limit.

    Args:
        distance: from the hull to the ball [m].
        goalkeeper: may stay in the own defence area.
    """

    distance: float = STOP_DISTANCE
    goalkeeper: bool = False

    _refuge: Point | None = field(default=None, init=False)

    def on_start(self) -> None:
        """Forget the place to go to."""
        self._refuge = None

    def on_running(self) -> Status:
        """Drive straight away from the place that is too near."""
        frame, me, game = self.frame, self.me, self.frame.game
        keep = self.distance + ROBOT_RADIUS + _DISTANCE_MARGIN
        ball = frame.ball.position
        spot = ball if game.placement is None or game.in_play else game.placement
        ways = [(spot, spot), (ball, ball)]
        if game.restart is Restart.BALL_PLACEMENT:
            # The robot that places the ball also needs the way to the spot to be free.
            ways = [(ball, spot)]
        near = [way for way in ways if segment_distance(me.position, *way) < keep]
        if not near:
            return self.succeed("far enough")
        # The ball's placement counts first, because a rolling ball does not stay where it is.
        way = near[0]
        if self._refuge is None or segment_distance(self._refuge, *way) < keep:
            # The target is farther than needed, so that the robot does not creep up to the limit.
            self._refuge = way_out(frame, me, way, keep + 2.0 * _DISTANCE_MARGIN, goalkeeper=self.goalkeeper)
        place = closest_point_on_segment(me.position, *way)
        self.drive_to(self._refuge, place, goalkeeper=self.goalkeeper, thereabouts=True)
        return self.run("clearing the ball")


def way_out(
    frame: Frame, me: RobotState, way: tuple[Point, Point], reach: float, *, goalkeeper: bool = False
) -> Point:
    """Return a point ``reach`` [m] from the segment ``way``, straight away from it if robots may stand there.

    Otherwise, as in a corner, take the point on whose way the robot keeps farthest from the segment, or the
    middle of the field if there is none. ``goalkeeper`` says whether the robot may stay in its own defence
    area.
    """
    place = closest_point_on_segment(me.position, *way)
    away = direction(place, me.position)
    best: Point = (0.0, 0.0)
    most = -inf
    for far in _WAY_OUT_REACHES:
        for turn in _WAY_OUT_TURNS:
            angle = away + turn
            target = (place[0] + far * reach * cos(angle), place[1] + far * reach * sin(angle))
            if segment_distance(target, *way) < reach - 1e-9:
                continue
            if allowed_target(frame, me, target, goalkeeper=goalkeeper) != target:
                continue
            if turn == 0.0:
                return target
            gain = segments_distance(me.position, target, *way) - _DETOUR_COST * distance(me.position, target)
            if gain > most:
                best, most = target, gain
    return best
