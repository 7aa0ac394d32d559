"""Choose a kick that gains ground when there is neither a shot nor a pass."""

from __future__ import annotations

from math import atan2, cos, inf, radians, sin

import numpy as np

from robobt.skills.base import Skill, skill
from robobt.skills.store import Shot
from robobt.tree import Status
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, Point, segment_distance, wrap_angle
from robobt.world.records import mover_records, movers_of
from robobt.world.rules import has_ball

_UPFIELD_TURNS = tuple(radians(turn) for turn in (0, 15, -15, 30, -30, 45, -45, 60, -60, 75, -75, 90, -90))
_WIDEST_LANE = 0.5
_UPFIELD_TOLERANCE = radians(6.0)


@skill
class AimUpfield(Skill):
    """Write to ``shot`` a kick that keeps the ball in the field and gains ground. Always SUCCESS.

    It tries directions around the one to the opponent's goal and takes the lane that stays inside the field
    and is farthest from all opponents; a clearance above half a metre counts as half a metre. Among equal
    lanes it takes the straightest or, with the ball in the mouth, the one that needs the smallest turn.

    Args:
        reach: length of the lane [m].
    """

    writes = ("shot",)

    reach: float = 2.5

    def on_running(self) -> Status:
        """Compare the lanes."""
        frame = self.frame
        x, y = frame.ball.position
        goal_x, goal_y = frame.field.their_goal
        ahead = atan2(goal_y - y, goal_x - x)
        rooms = _rooms(x, y, ahead, self.reach, movers_of(frame)[len(frame.own) :]).tolist()
        held = has_ball(self.me, frame.ball)
        best: Point = (goal_x, goal_y)
        most = -inf
        for turn, room in zip(_UPFIELD_TURNS, rooms, strict=True):
            end = (x + self.reach * cos(ahead + turn), y + self.reach * sin(ahead + turn))
            outside = max(0.0, abs(end[0]) - frame.field.half_length, abs(end[1]) - frame.field.half_width)
            value = room - 0.1 * abs(turn) - outside
            if held:
                value -= 0.1 * abs(wrap_angle(ahead + turn - self.me.heading))
            if value > most:
                best, most = end, value
        self.store.shot = Shot(best, _UPFIELD_TOLERANCE, 0.0)
        return self.succeed("upfield")


@compiled
def _rooms(x: float, y: float, ahead: float, reach: float, opponents_: FloatArray) -> FloatArray:
    """Return how far the nearest opponent is from the lane at each turn, at most ``_WIDEST_LANE`` [m].

    Args:
        x: x coordinate of the ball [m].
        y: y coordinate of the ball [m].
        ahead: direction from which the turns are measured [rad].
        reach: length of the lanes [m].
        opponents_: the opponents, as :func:`~robobt.world.records.movers` returns them.
    """
    rooms, opponents = np.full(len(_UPFIELD_TURNS), _WIDEST_LANE), mover_records(opponents_)
    for k, turn in enumerate(_UPFIELD_TURNS):
        end = (x + reach * cos(ahead + turn), y + reach * sin(ahead + turn))
        for opponent in opponents:
            room = segment_distance((opponent.x, opponent.y), (x, y), end)
            rooms[k] = min(rooms[k], room)
    return rooms
