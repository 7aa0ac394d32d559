"""Scripted robots at a restart: one of the team with the ball takes it, all others keep their distance."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, sin, sqrt
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.challengers import CHALLENGE
from robobt.learning.opponents.field_players import (
    PLAYERS,
    SCRIPTED_SHOT_SPEED,
    nearest_to,
    pass_speed,
    passed_to,
    shot_at,
)
from robobt.learning.opponents.sides import FIELD_GEOMETRY, Side, side_of
from robobt.learning.opponents.straight import stopping_speed, turning
from robobt.sim.records import COMMAND, Command
from robobt.world.compiled import compilable, compiled, numbers_of, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


class RestartState(Protocol):
    """An arena's restarts.

    Attributes:
        team: the team of the restart: 1 blue, -1 yellow, 0 in play.
        spot_x, spot_y: place of the ball [m].
        taker: robot that took the last restart and may not touch the ball, -1 for none.
        left: ticks left to take the restart.
        pause: ticks for which an opponent too near does not count as a new fault.
        last_team: team of the last restart, 0 before the first.
    """

    team: float
    spot_x: float
    spot_y: float
    taker: float
    left: float
    pause: float
    last_team: float


RESTART = record_dtype(RestartState)

_OTHERS_BALL_DISTANCE = STOP_DISTANCE + ROBOT_RADIUS + 0.1
"""Distance from the centre to a ball that others take [m]."""
_UNTOUCHED_BALL_DISTANCE = ROBOT_RADIUS + BALL_RADIUS + 0.1
"""Distance from the centre to a ball that the robot must not touch [m]."""
_RUN_UP_BEHIND, _RUN_UP_ASIDE = 0.25, 0.3
"""Run-up distance of a taker, and its distance beside the ball on the way there [m]."""
_LINE_TOLERANCE, _AIM_TOLERANCE = 0.03, 0.06
"""Largest errors from the line through ball and target for the run-up [m, rad]."""
_RUN_UP_SPEED = 0.5
"""Speed of the run-up [m/s]."""
_HURRY = 6.0
"""Speed per metre of remaining distance [1/s]."""


class RestartPlayers:
    """The scripted robots of ``roles`` while a restart is due, or while its kicker may not touch the ball.

    The field player nearest to its team's ball takes the restart, if it is scripted: it drives behind the
    ball and kicks it to a team-mate or at the goal. The others keep their distance from the ball and
    otherwise act as in play.

    Args:
        field: dimensions.
        limits: what they can do.
        roles: roles by the robots' indices; learners and robots moved by plays are left alone.
        blue: number of an arena's robots, the first ones, that attack towards +x.
        speed: the field players' top speed [m/s].
    """

    def __init__(
        self, field: FieldGeometry, limits: RobotLimits, roles: Sequence[str], blue: int, speed: float
    ) -> None:
        self._field = numbers_of(field)
        braking = min(limits.braking, limits.lateral_braking)
        self._drive = min(speed, limits.max_speed), limits.max_turn, braking
        scripted = np.array([role in {*PLAYERS, CHALLENGE, "goalkeeper"} for role in roles])
        still, keeps, passes = np.array(roles) == [["still"], ["goalkeeper"], ["pass"]]
        self._roles = (scripted & ~still, ~(still | keeps), passes)
        self._blue = blue

    def decide(
        self, restarts: FloatArray, robots: FloatArray, balls: FloatArray, commands: FloatArray
    ) -> None:
        """Change these robots' commands (n, R, size(COMMAND)) for one tick.

        Args:
            restarts: (n, size(RESTART)) of :class:`RestartState`.
            robots: (n, R, 6) states.
            balls: (n, 4) states.
            commands: what they would do in play.
        """
        arenas = (restarts, robots, balls)
        _decide(self._field, self._drive, self._roles, self._blue, arenas, commands)


@compiled
def _decide(
    field_: FloatArray,
    drive: tuple[float, float, float],
    roles: tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]],
    blue: int,
    arenas: tuple[FloatArray, FloatArray, FloatArray],
    commands: FloatArray,
) -> None:
    field: FieldGeometry = field_.view(FIELD_GEOMETRY)[0]
    (scripted, able, passes), (restarts_, robots_, balls_) = roles, arenas
    restarts, robots = restarts_.view(RESTART)[:, 0], robots_.view(ROBOT)[..., 0]
    balls, orders = balls_.view(BALL)[:, 0], commands.view(COMMAND)[..., 0]
    for i in range(len(balls)):
        restart: RestartState = restarts[i]
        team, barred = restart.team, int(restart.taker)
        if team == 0.0 and barred < 0:
            continue
        all_, ball = robots[i], balls[i]
        first, last, sign = side_of(0 if team > 0.0 else blue, blue, len(scripted))
        side = Side(all_, ball, first, last, sign)
        taker = nearest_to(side, 0.0, able) if team != 0.0 else -1
        for r in range(len(scripted)):
            if not scripted[r] or (team == 0.0 and r != barred):
                continue
            command: Command = orders[i, r]
            if r == taker:
                commands[i, r] = 0.0
                _take(field, side, r, passes[r], drive, command)
            else:
                _keep_off(
                    all_[r],
                    ball,
                    _UNTOUCHED_BALL_DISTANCE if team == 0.0 else _OTHERS_BALL_DISTANCE,
                    drive,
                    command,
                )


@compilable
def _keep_off(
    me: Robot, ball: Ball, keep: float, drive: tuple[float, float, float], command: Command
) -> None:
    """Limit a command so that the robot does not come nearer to the ball than ``keep`` [m]."""
    _, _, braking = drive
    dx, dy = me.x - ball.x, me.y - ball.y
    far = max(hypot(dx, dy), 1e-6)
    c, s = cos(me.heading), sin(me.heading)
    # The way out in the robot's frame.
    ux, uy = (c * dx + s * dy) / far, (c * dy - s * dx) / far
    room = far - keep
    slowest = _RUN_UP_SPEED if room < 0.0 else -sqrt(braking * room)
    short = slowest - (command.vx * ux + command.vy * uy)
    if short > 0.0:
        command.vx += short * ux
        command.vy += short * uy


@compilable
def _take(
    field: FieldGeometry,
    side: Side,
    me_: int,
    passes: bool,
    drive: tuple[float, float, float],
    command: Command,
) -> None:
    me, ball, kick, (top, turn, braking) = side.robots[me_], side.ball, SCRIPTED_SHOT_SPEED, drive
    target, _ = shot_at(field, side, me)
    if passes:
        mate, free = passed_to(side, me_)
        if free:
            target, kick = mate, pass_speed(ball, mate)
    far = hypot(target[0] - ball.x, target[1] - ball.y)
    ux, uy = (target[0] - ball.x) / far, (target[1] - ball.y) / far
    dx, dy = me.x - ball.x, me.y - ball.y
    along, aside = dx * ux + dy * uy, dy * ux - dx * uy
    off = wrap_angle(atan2(uy, ux) - me.heading)
    # The robot's distances from the ball, along the line and beside it.
    to_along, to_aside = -_RUN_UP_BEHIND, 0.0
    if along < 0.0 and abs(aside) < _LINE_TOLERANCE and abs(off) < _AIM_TOLERANCE:
        to_along, top = 0.0, _RUN_UP_SPEED
        command.kick_speed, command.on_contact = kick, 1.0
    elif along > -_UNTOUCHED_BALL_DISTANCE:
        # If it is not behind the ball yet, it drives away from the ball first, then past it.
        to_aside = _RUN_UP_ASIDE if aside > 0.0 else -_RUN_UP_ASIDE
        if abs(aside) < _UNTOUCHED_BALL_DISTANCE:
            to_along = along
    way_x = (to_along - along) * ux - (to_aside - aside) * uy
    way_y = (to_along - along) * uy + (to_aside - aside) * ux
    # The velocity is rounded differently than in drive_straight; policies were trained with it.
    way = hypot(way_x, way_y)
    speed = min(top, stopping_speed(way, braking), _HURRY * way)
    if way > 0.0:
        c, s = cos(me.heading), sin(me.heading)
        command.vx = speed * (c * way_x + s * way_y) / way
        command.vy = speed * (c * way_y - s * way_x) / way
    command.omega = turning(off, turn)
