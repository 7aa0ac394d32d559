"""What scripted robots of arenas do at a restart: one of the own team takes it, all others keep off."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, inf, sin, sqrt
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.challengers import CHALLENGE
from robobt.learning.opponents.field_players import PLAYERS, SHOT, pass_speed, passed_to, shot_at
from robobt.world.compiled import compilable, compiled, numbers_dtype, numbers_of, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


class RestartState(Protocol):
    """An arena's restarts.

    Attributes:
        team: whose the ball is, 1 blue's, -1 yellow's, 0 in play.
        spot_x, spot_y: where it was put [m].
        taker: who took the last restart and may not touch the ball, -1 for nobody.
        left: ticks left to take it.
        pause: ticks for which an opponent too near is no new fault.
        last_team: whose the last restart was, 0 before the first.
    """

    team: float
    spot_x: float
    spot_y: float
    taker: float
    left: float
    pause: float
    last_team: float


RESTART = record_dtype(RestartState)

_NOBODY, _KEEPER = -1, -2
_STILL, _PASS = PLAYERS.index("still"), PLAYERS.index("pass")
_FIELD = numbers_dtype(FieldGeometry)
_OFF = STOP_DISTANCE + ROBOT_RADIUS + 0.1
"""From the centre to a ball that others take [m]."""
_ASIDE = ROBOT_RADIUS + BALL_RADIUS + 0.1
"""And to one that it must not touch [m]."""
_BEHIND, _ROUND = 0.25, 0.3
"""From where a taker drives at the ball, and how far beside it on the way there [m]."""
_STRAIGHT, _AIMED = 0.03, 0.06
"""How far off the line through ball and target it may be then [m, rad]."""
_GENTLY = 0.5
"""How fast it drives at the ball [m/s]."""
_LOOK = 6.0
"""How fast it turns for each radian [1/s]."""


class RestartPlayers:
    """The scripted robots of ``roles`` while a restart is due, or may not be touched again by who took it.

    Whoever of a team's field players is nearest to its own ball takes the restart, if it is one of these: it
    drives behind the ball and kicks it, to a mate or at the goal. Others keep their distance from the ball,
    and go on else as they did.

    Args:
        field: dimensions.
        limits: what they can do.
        roles: by the robots' indices; learners and those that plays move are left alone.
        blue: how many of an arena's robots, the first, attack towards +x.
        speed: the field players' top speed [m/s].
    """

    def __init__(
        self, field: FieldGeometry, limits: RobotLimits, roles: Sequence[str], blue: int, speed: float
    ) -> None:
        self._field = numbers_of(field)
        braking = min(limits.braking, limits.lateral_braking)
        self._drive = np.array([min(speed, limits.max_speed), braking, limits.max_turn])
        kinds = {name: k for k, name in enumerate((*PLAYERS, CHALLENGE))} | {"goalkeeper": _KEEPER}
        self._roles = np.array([kinds.get(role, _NOBODY) for role in roles], dtype=np.int64)
        self._blue = blue

    def decide(
        self, restarts: FloatArray, robots: FloatArray, balls: FloatArray, commands: FloatArray
    ) -> None:
        """Change these robots' commands (n, R, >= 6) for one tick.

        Args:
            restarts: (n, size(RESTART)) of :class:`RestartState`.
            robots: (n, R, 6) states.
            balls: (n, 4) states.
            commands: what they would do in play.
        """
        _decide(self._field, self._drive, self._roles, self._blue, restarts, robots, balls, commands)


@compiled
def _decide(
    field_: FloatArray,
    drive: FloatArray,
    roles: NDArray[np.int64],
    blue: int,
    restarts: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    commands: FloatArray,
) -> None:
    field: FieldGeometry = field_.view(_FIELD)[0]
    for i in range(len(balls)):
        restart: RestartState = restarts.view(RESTART)[i, 0]
        team, barred, ball = restart.team, int(restart.taker), balls[i]
        if team == 0.0 and barred < 0:
            continue
        first, last = (0, blue) if team > 0.0 else (blue, len(roles))
        taker = _nearest(robots[i], ball, roles, first, last) if team != 0.0 else -1
        for r in range(len(roles)):
            if roles[r] in (_NOBODY, _STILL) or (team == 0.0 and r != barred):
                continue
            if r == taker:
                _take(field, drive, robots[i], ball, roles[r], r, first, last, blue, commands[i, r])
            else:
                keep = _ASIDE if team == 0.0 else _OFF
                _keep_off(drive, robots[i, r], ball, keep, commands[i, r])


@compilable
def _nearest(robots: FloatArray, ball: FloatArray, roles: NDArray[np.int64], first: int, last: int) -> int:
    best, who = inf, -1
    for r in range(first, last):
        far = hypot(robots[r, 0] - ball[0], robots[r, 1] - ball[1])
        if roles[r] not in (_KEEPER, _STILL) and far < best:
            best, who = far, r
    return who


@compilable
def _keep_off(drive: FloatArray, me: FloatArray, ball: FloatArray, keep: float, command: FloatArray) -> None:
    """Take from a command what would bring the robot nearer to the ball than ``keep`` [m]."""
    dx, dy = me[0] - ball[0], me[1] - ball[1]
    far = max(hypot(dx, dy), 1e-6)
    c, s = cos(me[2]), sin(me[2])
    # The way out in its own frame.
    ux, uy = (c * dx + s * dy) / far, (c * dy - s * dx) / far
    room = far - keep
    slowest = _GENTLY if room < 0.0 else -sqrt(drive[1] * room)
    short = slowest - (command[0] * ux + command[1] * uy)
    if short > 0.0:
        command[0] += short * ux
        command[1] += short * uy


@compilable
def _take(
    field: FieldGeometry,
    drive: FloatArray,
    robots: FloatArray,
    ball: FloatArray,
    role: int,
    me_: int,
    first: int,
    last: int,
    blue: int,
    command: FloatArray,
) -> None:
    me, sign = robots[me_], 1.0 if first == 0 else -1.0
    kick = SHOT
    x, y, _ = shot_at(field, robots, me, sign, blue)
    if role == _PASS:
        mate_x, mate_y, free = passed_to(robots, ball, me_, first, last)
        if free:
            x, y = mate_x, mate_y
            kick = pass_speed(hypot(x - ball[0], y - ball[1]))
    far = hypot(x - ball[0], y - ball[1])
    ux, uy = (x - ball[0]) / far, (y - ball[1]) / far
    dx, dy = me[0] - ball[0], me[1] - ball[1]
    along, aside = dx * ux + dy * uy, dy * ux - dx * uy
    off = wrap_angle(atan2(uy, ux) - me[2])
    # Along the line and beside it, how far from the ball it drives.
    to_along, to_aside, top = -_BEHIND, 0.0, drive[0]
    command[:] = 0.0
    if along < 0.0 and abs(aside) < _STRAIGHT and abs(off) < _AIMED:
        to_along, top = 0.0, _GENTLY
        command[3], command[4] = kick, 1.0
    elif along > -_ASIDE:
        # Not behind it yet: away from it first, then past it.
        to_aside = _ROUND if aside > 0.0 else -_ROUND
        if abs(aside) < _ASIDE:
            to_along = along
    way_x = (to_along - along) * ux - (to_aside - aside) * uy
    way_y = (to_along - along) * uy + (to_aside - aside) * ux
    way = hypot(way_x, way_y)
    speed = min(top, sqrt(1.6 * drive[1] * way), _LOOK * way)
    if way > 0.0:
        c, s = cos(me[2]), sin(me[2])
        command[0] = speed * (c * way_x + s * way_y) / way
        command[1] = speed * (c * way_y - s * way_x) / way
    command[2] = min(max(_LOOK * off, -drive[2]), drive[2])
