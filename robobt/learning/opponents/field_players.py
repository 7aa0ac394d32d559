"""Simple field players over many arenas: opponents of learners, and scripts to beat."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from math import atan2, cos, hypot, inf, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.sides import FIELD_GEOMETRY, Arenas, Side, side_of
from robobt.learning.opponents.straight import DRIVING_LIMITS, DrivingLimits, drive_of, drive_straight
from robobt.plays.baselines.agreement import MARK_FROM
from robobt.plays.baselines.mark_opponent import MarkOpponent
from robobt.sim.records import COMMAND, Command
from robobt.skills.defence.wall import wall_place
from robobt.world.compiled import compilable, compiled, numbers_of
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import BALL, ROBOT, Ball, Robot


class Role(IntEnum):
    """The role of a field player.

    ``still`` stands still; ``press`` drives at the ball. ``wall`` stands where the skill ``Wall`` does, at
    the edge of its own defence area on the line from ball to goal, several side by side. ``mark`` stands
    where ``MarkOpponent`` does, without preferring its present opponent. ``attack`` and ``pass``: the nearest
    of them fetches the ball and carries it to a shot at the corner farther from the goalkeeper, or turns to
    the team-mate with the freest lane and passes; the others wait, attackers in front of the goal.
    ``redirect`` waits on the ball's line, facing the goal, and kicks the ball when it arrives.
    """

    STILL = 0
    PRESS = 1
    MARK = 2
    WALL = 3
    ATTACK = 4
    PASS = 5
    REDIRECT = 6


PLAYERS = tuple(role.name.lower() for role in Role)
"""The roles as settings name them."""
_GENTLE = 2.5
"""Highest turning rate with the ball [rad/s]."""
_CARRYING_SPEED = 1.2
"""Speed with the ball [m/s]."""
_SHOOTING_RANGE = 1.9
"""Distance from which they shoot [m]."""
_KICK_ANGLE_ERROR = 0.06
"""Largest angle error for a kick [rad]."""
SCRIPTED_SHOT_SPEED = 6.0
"""Speed of shots [m/s]."""
_LEAD = 0.5
"""How far ahead a rolling ball is predicted [s]."""
_ARRIVES = 0.8
"""Speed with which a pass reaches a team-mate [m/s]."""
_KEPT_SPEED_AFTER_SLIDE, _ROLLING_DECELERATION = 0.66, 0.3
"""Share of a kick's speed that remains once the ball rolls, and its deceleration then [m/s^2]."""
_MOUTH_DISTANCE = 0.09
"""Distance from a robot's centre to the ball in its mouth [m]."""
_MARKING_GAP = MarkOpponent.gap
_FREE = 0.35
"""A lane to a team-mate is free if no robot is closer to it than this [m]."""


class FieldPlayers:
    """The robots of ``roles`` in each of ``n`` arenas.

    Args:
        field: dimensions.
        limits: what they can do.
        period: control period [s].
        roles: by the robots' indices, names of :class:`Role`; the others' are left alone.
        blue: number of an arena's robots, the first ones, that attack towards +x.
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
        self._field, self._drive = numbers_of(field), drive_of(limits, period)
        top = limits.max_speed if speed is None else min(speed, limits.max_speed)
        self._most = top, limits.max_turn
        self._roles = np.array([PLAYERS.index(role) if role in PLAYERS else -1 for role in roles])
        self._fetch = np.isin(self._roles, (Role.ATTACK, Role.PASS))
        self._blue = blue
        self.any = bool((self._roles >= 0).any())

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick of these players in n arenas.

        Args:
            robots: every robot's state (n, R, 6).
            balls: the balls' states (n, 4).
            contact: whether a robot's kicker touches the ball (n, R).
            commands: filled with these players' commands (n, R, size(COMMAND)).
        """
        if self.any:
            roles, arenas = (self._roles, self._fetch, self._blue), (robots, balls, contact)
            _decide(self._field, self._drive, self._most, roles, arenas, commands)


@compiled
def _decide(
    field_: FloatArray,
    drive_: FloatArray,
    most: tuple[float, float],
    roles_: tuple[NDArray[np.int64], NDArray[np.bool_], int],
    arenas: Arenas,
    commands: FloatArray,
) -> None:
    field: FieldGeometry = field_.view(FIELD_GEOMETRY)[0]
    drive: DrivingLimits = drive_.view(DRIVING_LIMITS)[0]
    (roles, fetch, blue), (robots_, balls_, contact) = roles_, arenas
    robots, balls, orders = (
        robots_.view(ROBOT)[..., 0],
        balls_.view(BALL)[:, 0],
        commands.view(COMMAND)[..., 0],
    )
    for i in range(len(balls)):
        all_, ball = robots[i], balls[i]
        for r in range(len(roles)):
            if roles[r] < 0:
                continue
            first, last, sign = side_of(r, blue, len(roles))
            side = Side(all_, ball, first, last, sign)
            me, role, (top, turn), kick = all_[r], roles[r], most, 0.0
            target, facing = (me.x, me.y), (ball.x, ball.y)
            if role == Role.PRESS:
                target = (ball.x, ball.y)
            elif role == Role.MARK:
                target = _marked(side, contact[i], roles, r, field.length / 2)
            elif role == Role.WALL:
                target = _walled(field, side, roles, r)
            elif role == Role.REDIRECT:
                x, y = _coming(me, ball)
                # The robot's mouth should be there, not its centre.
                target = x - _MOUTH_DISTANCE * cos(me.heading), y - _MOUTH_DISTANCE * sin(me.heading)
                facing, _ = shot_at(field, side, me)
                kick = SCRIPTED_SHOT_SPEED
            elif role in (Role.ATTACK, Role.PASS):
                if contact[i, r]:
                    turn = _GENTLE
                    if role == Role.PASS:
                        facing, near = passed_to(side, r)
                    else:
                        facing, near = shot_at(field, side, me)
                        if not near:
                            target, top = facing, _CARRYING_SPEED
                    off = wrap_angle(atan2(facing[1] - me.y, facing[0] - me.x) - me.heading)
                    if near and abs(off) < _KICK_ANGLE_ERROR:
                        kick = SCRIPTED_SHOT_SPEED if role == Role.ATTACK else pass_speed(ball, facing)
                elif nearest_to(side, _LEAD, fetch) == r:
                    target = _coming(me, ball)
                elif role == Role.ATTACK:
                    x = sign * (field.length / 2 - field.defense_depth - 0.6)
                    target = (x, -1.2 if ball.y > 0.0 else 1.2)
            commands[i, r] = 0.0
            command: Command = orders[i, r]
            command.vx, command.vy, command.omega = drive_straight(me, target, facing, top, turn, drive)
            command.kick_speed, command.dribbler = kick, 1.0


@compilable
def pass_speed(ball: Ball, target: Point) -> float:
    """Return the kick speed of a pass to a place [m/s]."""
    way = hypot(target[0] - ball.x, target[1] - ball.y)
    return sqrt(_ARRIVES * _ARRIVES + 2.0 * _ROLLING_DECELERATION * way) / _KEPT_SPEED_AFTER_SLIDE


@compiled
def nearest_to(side: Side, lead: float, able: NDArray[np.bool_]) -> int:
    """Return the team's ``able`` robot (R,) nearest to the ball in ``lead`` seconds, or -1."""
    best, who = inf, -1
    # A robot that the ball has passed should not run after it.
    x, y = side.ball.x + lead * side.ball.vx, side.ball.y + lead * side.ball.vy
    for r in range(side.first, side.last):
        far = hypot(side.robots[r].x - x, side.robots[r].y - y)
        if able[r] and far < best:
            best, who = far, r
    return who


@compilable
def _coming(me: Robot, ball: Ball) -> Point:
    """Return where to get the ball: on its line if it comes."""
    fast = hypot(ball.vx, ball.vy)
    along = 0.0
    if fast > 0.3:
        along = max(((me.x - ball.x) * ball.vx + (me.y - ball.y) * ball.vy) / fast, _LEAD * fast)
    return ball.x + along * ball.vx / max(fast, 0.3), ball.y + along * ball.vy / max(fast, 0.3)


@compiled
def _marked(
    side: Side, contact: NDArray[np.bool_], roles: NDArray[np.int64], me: int, goal_x: float
) -> Point:
    """Return where a marker stands: beside the opponent assigned to it, towards the ball.

    Opponents in the marker's half, except the one with the ball, are assigned to the nearest free marker,
    starting with the nearest to the marker's goal; a marker without an opponent stays where it is. Its goal
    is at ``-goal_x`` times the sign.
    """
    robots, ball, first, last, sign = side
    holder, near = -1, inf
    for r in range(len(robots)):
        far = hypot(robots[r].x - ball.x, robots[r].y - ball.y)
        if contact[r] and far < near:
            holder, near = r, far
    taken: NDArray[np.bool_] = np.zeros(len(robots), dtype=np.bool_)
    while True:
        best, threat = inf, -1
        for r in range(len(robots)):
            far = hypot(sign * robots[r].x + goal_x, robots[r].y)
            there = not first <= r < last and not taken[r] and r != holder
            if there and sign * robots[r].x < MARK_FROM and far < best:
                best, threat = far, r
        best, marker = inf, -1
        for r in range(first, last):
            if threat >= 0 and roles[r] == Role.MARK and not taken[r]:
                far = hypot(robots[r].x - robots[threat].x, robots[r].y - robots[threat].y)
                if far < best:
                    best, marker = far, r
        if marker < 0:
            return robots[me].x, robots[me].y
        if marker == me:
            dx, dy = ball.x - robots[threat].x, ball.y - robots[threat].y
            share = _MARKING_GAP / max(_MARKING_GAP, hypot(dx, dy))
            return robots[threat].x + share * dx, robots[threat].y + share * dy
        taken[threat] = taken[marker] = True


@compiled
def _walled(field: FieldGeometry, side: Side, roles: NDArray[np.int64], me: int) -> Point:
    """Return where a robot of the wall stands, round its own goal."""
    size = rank = 0
    for r in range(side.first, side.last):
        if roles[r] == Role.WALL:
            rank += r < me
            size += 1
    x, y = wall_place(field, side.sign * side.ball.x, side.sign * side.ball.y, rank, size)
    return side.sign * x, side.sign * y


@compiled
def shot_at(field: FieldGeometry, side: Side, me: Robot) -> tuple[Point, bool]:
    """Return the corner farther from the opponent nearest to the goal, and whether the attacker is near."""
    goal_x, post = side.sign * field.length / 2, field.goal_width / 2
    best, y = inf, 0.0
    for r in range(len(side.robots)):
        far = hypot(side.robots[r].x - goal_x, side.robots[r].y)
        if not side.first <= r < side.last and far < best:
            best, y = far, side.robots[r].y
    corner = -0.7 * post if y > 0.0 else 0.7 * post
    return (goal_x, corner), hypot(goal_x - me.x, me.y) < _SHOOTING_RANGE


@compiled
def passed_to(side: Side, me: int) -> tuple[Point, bool]:
    """Return the team-mate with the freest lane from the ball, and whether that lane is free."""
    robots, ball, first, last, _ = side
    best, who = -1.0, -1
    for mate in range(first, last):
        if mate == me:
            continue
        dx, dy = robots[mate].x - ball.x, robots[mate].y - ball.y
        far = max(hypot(dx, dy), 1e-6)
        free = inf
        for r in range(len(robots)):
            if first <= r < last:
                continue
            ox, oy = robots[r].x - ball.x, robots[r].y - ball.y
            along = min(max((ox * dx + oy * dy) / far, 0.0), far)
            free = min(free, hypot(ox - along * dx / far, oy - along * dy / far))
        if free > best:
            best, who = free, mate
    if who < 0:
        return (ball.x, ball.y), False
    return (robots[who].x, robots[who].y), best > _FREE
