"""Field players of a few simple kinds over many arenas: who opposes learners, and the scripts to beat."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, inf, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from robobt.plays.baselines.agreement import MARK_FROM
from robobt.plays.baselines.mark_opponent import MarkOpponent
from robobt.skills.defence.wall import wall_place
from robobt.world.compiled import compilable, compiled, numbers_dtype, numbers_of
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits

PLAYERS = ("still", "press", "mark", "wall", "attack", "pass", "redirect")
"""What a field player does.

``still`` stands; ``press`` drives at the ball. ``wall`` stands where the skill ``Wall`` does, at the edge of
its own defence area on the ball's line to its goal, several of them side by side; ``mark`` where
``MarkOpponent`` does, but that whom it marks already is not preferred. ``attack`` and ``pass``: whoever of
them is nearest fetches the ball and carries it to a shot at the corner farther from the goalkeeper, or turns
to the mate with the freest way and passes; the others wait, those who attack before the goal. ``redirect``
waits on the ball's way, turned to the goal, and kicks it as it comes.
"""

_STILL, _PRESS, _MARK, _WALL, _ATTACK, _PASS, _REDIRECT = range(7)
_FIELD = numbers_dtype(FieldGeometry)
_LOOK = 6.0
"""How fast they turn for each radian [1/s]."""
_GENTLE = 2.5
"""At most so fast with the ball [rad/s]."""
_CARRYING = 1.2
"""How fast they drive with it [m/s]."""
_NEAR = 1.9
"""From this far they shoot [m]."""
_AIMED = 0.06
"""How far off they kick [rad]."""
SHOT = 6.0
"""Speed of shots [m/s]."""
_LEAD = 0.5
"""How far ahead a rolling ball is thought of [s]."""
_ARRIVES = 0.8
"""Speed with which a pass comes to a mate [m/s]."""
_KEPT, _ROLLING = 0.66, 0.3
"""What is left of a kick's speed once the ball rolls, and how it slows down then [m/s^2]."""
_MOUTH = 0.09
"""How far before a robot's centre the ball lies in its mouth [m]."""
_BESIDE = MarkOpponent.gap
_FREE = 0.35
"""A way to a mate that passes nobody nearer is free [m]."""


class FieldPlayers:
    """The robots of ``roles`` in each of ``n`` arenas.

    Args:
        field: dimensions.
        limits: what they can do.
        period: control period [s].
        roles: by the robots' indices, of :data:`PLAYERS`; the others' are left alone.
        blue: how many of an arena's robots, the first, attack towards +x.
        speed: their top speed [m/s]; None for the limits'.
    """

    def __init__(
        self,
        field: FieldGeometry,
        limits: RobotLimits,
        period: float,
        roles: Sequence[str],
        blue: int,
        speed: float | None = None,
    ) -> None:
        self._field = numbers_of(field)
        top = limits.max_speed if speed is None else min(speed, limits.max_speed)
        self._drive = np.array([top, min(limits.braking, limits.lateral_braking), limits.max_turn, period])
        self._roles = np.array([PLAYERS.index(role) if role in PLAYERS else -1 for role in roles])
        self._blue = blue
        self.any = bool((self._roles >= 0).any())

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick: fill these robots' commands (n, R, >= 6), given the arenas' state."""
        if self.any:
            _decide(self._field, self._drive, self._roles, self._blue, robots, balls, contact, commands)


@compiled
def _decide(
    field_: FloatArray,
    drive: FloatArray,
    roles: NDArray[np.int64],
    blue: int,
    robots: FloatArray,
    balls: FloatArray,
    contact: NDArray[np.bool_],
    commands: FloatArray,
) -> None:
    field: FieldGeometry = field_.view(_FIELD)[0]
    count = len(roles)
    for i in range(len(balls)):
        ball, all_ = balls[i], robots[i]
        for r in range(count):
            if roles[r] < 0:
                continue
            me, role, command = all_[r], roles[r], commands[i, r]
            sign = 1.0 if r < blue else -1.0
            first, last = (0, blue) if r < blue else (blue, count)
            x, y, look_x, look_y, top, kick = me[0], me[1], ball[0], ball[1], drive[0], 0.0
            turn = drive[2]
            if role == _PRESS:
                x, y = ball[0], ball[1]
            elif role == _MARK:
                x, y = _marked(all_, ball, contact[i], roles, r, first, last, sign, field.length / 2)
            elif role == _WALL:
                x, y = _walled(field, ball, roles, r, first, last, sign)
            elif role == _REDIRECT:
                x, y = _coming(me, ball)
                # There its mouth is to be, not its middle.
                x, y = x - _MOUTH * cos(me[2]), y - _MOUTH * sin(me[2])
                look_x, look_y, _ = shot_at(field, all_, me, sign, blue)
                kick = SHOT
            elif role in (_ATTACK, _PASS):
                if contact[i, r]:
                    turn = _GENTLE
                    if role == _PASS:
                        look_x, look_y, near = passed_to(all_, ball, r, first, last)
                    else:
                        look_x, look_y, near = shot_at(field, all_, me, sign, blue)
                        if not near:
                            x, y, top = look_x, look_y, _CARRYING
                    off = wrap_angle(atan2(look_y - me[1], look_x - me[0]) - me[2])
                    if near and abs(off) < _AIMED:
                        kick = (
                            SHOT if role == _ATTACK else pass_speed(hypot(look_x - ball[0], look_y - ball[1]))
                        )
                elif _nearest(all_, ball, first, last, roles) == r:
                    x, y = _coming(all_[r], ball)
                elif role == _ATTACK:
                    x = sign * (field.length / 2 - field.defense_depth - 0.6)
                    y = -1.2 if ball[1] > 0.0 else 1.2
            dx, dy = x - me[0], y - me[1]
            way = hypot(dx, dy)
            # As fast as it may be to stop there.
            speed = min(top, sqrt(2.0 * 0.8 * drive[1] * way), way / drive[3])
            vx, vy = (speed * dx / way, speed * dy / way) if way > 0.0 else (0.0, 0.0)
            c, s = cos(me[2]), sin(me[2])
            command[:] = 0.0
            command[0], command[1] = c * vx + s * vy, c * vy - s * vx
            omega = _LOOK * wrap_angle(atan2(look_y - me[1], look_x - me[0]) - me[2])
            command[2] = min(max(omega, -turn), turn)
            command[3] = kick
            command[5] = 1.0


@compilable
def pass_speed(way: float) -> float:
    """Return how fast a pass so far [m] is kicked [m/s]."""
    return sqrt(_ARRIVES * _ARRIVES + 2.0 * _ROLLING * way) / _KEPT


@compiled
def _nearest(robots: FloatArray, ball: FloatArray, first: int, last: int, roles: NDArray[np.int64]) -> int:
    """Return which of the team that fetch the ball is nearest to it."""
    best, who = inf, -1
    for r in range(first, last):
        # To where the ball is going to be: who has passed it is not to run after it.
        x, y = ball[0] + _LEAD * ball[2], ball[1] + _LEAD * ball[3]
        far = hypot(robots[r, 0] - x, robots[r, 1] - y)
        if roles[r] in (_ATTACK, _PASS) and far < best:
            best, who = far, r
    return who


@compilable
def _coming(me: FloatArray, ball: FloatArray) -> tuple[float, float]:
    """Return where to get the ball: on its way, if it comes."""
    fast = hypot(ball[2], ball[3])
    along = 0.0
    if fast > 0.3:
        along = max(((me[0] - ball[0]) * ball[2] + (me[1] - ball[1]) * ball[3]) / fast, _LEAD * fast)
    return ball[0] + along * ball[2] / max(fast, 0.3), ball[1] + along * ball[3] / max(fast, 0.3)


@compiled
def _marked(
    robots: FloatArray,
    ball: FloatArray,
    contact: NDArray[np.bool_],
    roles: NDArray[np.int64],
    me: int,
    first: int,
    last: int,
    sign: float,
    goal_x: float,
) -> tuple[float, float]:
    """Return where a marker stands: beside the one of the others who is its to mark, towards the ball.

    Those in the marker's own half, the nearest to its goal first, are each the nearest free marker's, but for
    who has the ball; a marker that is left over stays where it is. Its team attacks ``sign`` times x, and its
    goal is at ``-goal_x`` times that.
    """
    holder, near = -1, inf
    for r in range(len(robots)):
        far = hypot(robots[r, 0] - ball[0], robots[r, 1] - ball[1])
        if contact[r] and far < near:
            holder, near = r, far
    taken: NDArray[np.bool_] = np.zeros(len(robots), dtype=np.bool_)
    while True:
        best, threat = inf, -1
        for r in range(len(robots)):
            far = hypot(sign * robots[r, 0] + goal_x, robots[r, 1])
            there = not first <= r < last and not taken[r] and r != holder
            if there and sign * robots[r, 0] < MARK_FROM and far < best:
                best, threat = far, r
        best, marker = inf, -1
        for r in range(first, last):
            if threat >= 0 and roles[r] == _MARK and not taken[r]:
                far = hypot(robots[r, 0] - robots[threat, 0], robots[r, 1] - robots[threat, 1])
                if far < best:
                    best, marker = far, r
        if marker < 0:
            return robots[me, 0], robots[me, 1]
        if marker == me:
            dx, dy = ball[0] - robots[threat, 0], ball[1] - robots[threat, 1]
            share = _BESIDE / max(_BESIDE, hypot(dx, dy))
            return robots[threat, 0] + share * dx, robots[threat, 1] + share * dy
        taken[threat] = taken[marker] = True


@compiled
def _walled(
    field: FieldGeometry,
    ball: FloatArray,
    roles: NDArray[np.int64],
    me: int,
    first: int,
    last: int,
    sign: float,
) -> tuple[float, float]:
    """Return where one of a wall stands, round its own goal; its team attacks ``sign`` times x."""
    size = rank = 0
    for r in range(first, last):
        if roles[r] == _WALL:
            rank += r < me
            size += 1
    x, y = wall_place(field, sign * ball[0], sign * ball[1], rank, size)
    return sign * x, sign * y


@compiled
def shot_at(
    field: FieldGeometry, robots: FloatArray, me: FloatArray, sign: float, blue: int
) -> tuple[float, float, bool]:
    """Return the corner farther from who is nearest to the goal, and whether the attacker is near."""
    goal_x, post = sign * field.length / 2, field.goal_width / 2
    first, last = (blue, len(robots)) if sign > 0.0 else (0, blue)
    best, y = inf, 0.0
    for r in range(first, last):
        far = hypot(robots[r, 0] - goal_x, robots[r, 1])
        if far < best:
            best, y = far, robots[r, 1]
    corner = -0.7 * post if y > 0.0 else 0.7 * post
    return goal_x, corner, hypot(goal_x - me[0], me[1]) < _NEAR


@compiled
def passed_to(
    robots: FloatArray, ball: FloatArray, me: int, first: int, last: int
) -> tuple[float, float, bool]:
    """Return the mate whose way from the ball is the freest, and whether it is free."""
    best, who = -1.0, -1
    for mate in range(first, last):
        if mate == me:
            continue
        dx, dy = robots[mate, 0] - ball[0], robots[mate, 1] - ball[1]
        far = max(hypot(dx, dy), 1e-6)
        free = inf
        for r in range(len(robots)):
            if first <= r < last:
                continue
            ox, oy = robots[r, 0] - ball[0], robots[r, 1] - ball[1]
            along = min(max((ox * dx + oy * dy) / far, 0.0), far)
            free = min(free, hypot(ox - along * dx / far, oy - along * dy / far))
        if free > best:
            best, who = free, mate
    if who < 0:
        return ball[0], ball[1], False
    return robots[who, 0], robots[who, 1], best > _FREE
