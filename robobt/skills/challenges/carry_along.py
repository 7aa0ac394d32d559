"""Carry the ball along the way of the dribbling challenge."""

from __future__ import annotations

from dataclasses import field
from math import atan2, hypot, inf, pi

from robobt.motion.dribbling import carrying_limits
from robobt.motion.pilot import drive
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import Point, distance, wrap_angle
from robobt.world.rules import has_ball

GATE_POSTS = {"A": (0, 1), "B": (1, 2), "C": (2, 3), "D": (3, 0), "E": (0, 4), "F": (5, 6)}
"""The two robots of each gate. Source: dribbling challenge of 2022."""

GATES = ("A", "A", "B", "B", "C", "C", "D", "E", "F")
"""The gates in the order in which they are passed. Source: as above."""

_CENTRE = (-3.5, -2.37)
"""Middle of the four robots around the ball [m]."""

_BEHIND_GATE = 0.22
"""How far beyond a gate's line the robot's centre goes, so that robot and ball are behind it [m]."""

_POSE_REACHED, _HEADING_REACHED = 0.03, 0.06
"""Distance and angle within which a pose on the way is reached [m, rad]."""

_CARRY_PACE, _CARRY_TURN, _CARRY_ACCELERATION_AT_GATES = 0.7, 2.0, 1.0
"""Speed, turning rate and acceleration with the ball [m/s, rad/s, m/s^2]."""

_LEFT_BEHIND = 0.3
"""Distance from the ball at which the robot has left it [m]."""

_BALL_GRACE = 0.2
"""The ball counts as lost once it has been out of the mouth for this long [s]."""

Pose = tuple[float, float, float]
"""x, y and heading [m, m, rad]."""

_SQUARE = {0: (-3.0, -2.3), 1: (-3.5, -2.75), 2: (-4.0, -2.3), 3: (-3.5, -2.0)}
"""The robots around the ball [m]. Source: the challenge's picture."""


def gate_poses() -> list[Pose]:
    """Return the robot's poses on the way through all gates, in the order of the rules."""
    poses: list[Pose] = []
    for gate in "ABCD":
        (ax, ay), (bx, by) = (_SQUARE[number] for number in GATE_POSTS[gate])
        x, y = 0.5 * (ax + bx), 0.5 * (ay + by)
        nx, ny = ay - by, bx - ax
        length = hypot(nx, ny)
        nx, ny = nx / length, ny / length
        if nx * (x - _CENTRE[0]) + ny * (y - _CENTRE[1]) < 0.0:
            nx, ny = -nx, -ny
        heading = atan2(ny, nx)
        start = (x - 0.3 * nx, y - 0.3 * ny)
        poses += [
            (*_CENTRE, heading),
            (*start, heading),
            (x + _BEHIND_GATE * nx, y + _BEHIND_GATE * ny, heading),
        ]
        if gate != "D":
            poses += [(*start, heading)]
    down, up = -pi / 2.0, pi / 2.0
    return [
        *poses,
        (-2.95, -1.75, down),
        (-2.75, -1.9, down),
        (-2.75, -2.6, down),
        (-2.0, -2.6, down),
        (-2.0, -2.0, up),
        (0.75, 2.0, up),
        (0.75, 2.75, up),
        (0.75, 1.42, up),
    ]


@skill
class CarryAlong(Skill):
    """Carry the ball along poses, in order, in any direction, and leave it at the last; never ends.

    The robot turns where it stands and keeps its heading on the way, so that it can pull the ball back
    through a gap. FAILURE while it does not have the ball; it then goes on where it was.

    Args:
        forwards: turn into the way instead, so that the robot always drives ahead.
    """

    forwards: bool = False
    _poses: list[Pose] = field(default_factory=gate_poses, init=False)
    _next: int = field(default=0, init=False)
    _had: float = field(default=-inf, init=False)

    def on_running(self) -> Status:
        """Carry for one tick."""
        frame, me = self.frame, self.me
        if self._next == len(self._poses):
            # Back off, so that the ball lies by itself.
            if distance(me.position, self.ball.position) < _LEFT_BEHIND:
                self.store.command.vx = -0.3
            return self.run("done")
        if has_ball(me, self.ball):
            self._had = frame.time
        if frame.time - self._had > _BALL_GRACE:
            return self.fail("it does not have the ball")
        x, y, heading = self._poses[self._next]
        here, target = me.position, (x, y)
        gap = distance(here, target)
        if self.forwards and gap > _POSE_REACHED:
            heading = atan2(y - me.y, x - me.x)
        off = abs(wrap_angle(heading - me.heading))
        if gap < _POSE_REACHED and (off < _HEADING_REACHED or self.forwards):
            self._next += 1
        limits = carrying_limits(me.limits, _CARRY_PACE, _CARRY_TURN, _CARRY_ACCELERATION_AT_GATES)
        held: Point = here if off > 2.0 * _HEADING_REACHED else target
        self.store.command = drive(me, held, heading, limits, frame.period)
        self.store.command.dribbler = True
        return self.run(f"pose {self._next} of {len(self._poses)}")
