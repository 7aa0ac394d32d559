"""Field players that defend as the play ``team_player`` does, over many arenas: one challenges."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf, pi
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.at_the_ball import FRESH, MEMORY, Attack, play_the_ball, with_the_ball
from robobt.motion.arrival import meetings
from robobt.motion.ball_watch import Watch, follow
from robobt.motion.path_planner import travel_law
from robobt.motion.scene import BALL_GAP, scene_of, trip_of
from robobt.skills.base import heading_thereabouts
from robobt.skills.defence.wall import wall_place
from robobt.skills.tactics.attacker import NOBODY, choose_attacker, may_be_attacked
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings, applied
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.compiled import compiled, numbers_of, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import MOVER_SIZE, ROBOT_SIZE, limits_of, mover_records
from robobt.world.rules import before_mouth
from robobt.world.state import BallState, Frame, RobotState

CHALLENGE = "challenge"
"""The role of a field player that does what ``team_player`` does in open play.

Of a team's challengers the one that has the ball soonest goes for it, by the same law as in the plan
(:mod:`robobt.skills.tactics.attacker`), and the others are a wall; all are one while the ball is in a
defence area. Nobody marks, supports, passes or shoots. The play's own speed is a ``player_speed`` of 3 m/s.
"""


class _Side(Attack, Protocol):
    """A team of every arena, as it sees the field."""

    field: FieldGeometry


class _Plan(Protocol):
    """Which of a team goes for the ball, a row of it, and since when [s]."""

    attacker: float
    since: float


_ON_SIDE, _PLAN, _WATCH = record_dtype(_Side), record_dtype(_Plan), record_dtype(Watch)
_SLIDE, _ROLL = DEFAULT_BALL.slide_deceleration, DEFAULT_BALL.roll_deceleration
_SHARE = DEFAULT_BALL.switch_share


class Challengers:
    """The robots of the role :data:`CHALLENGE` in each of ``n`` arenas.

    Args:
        field: dimensions.
        limits: what they can do.
        period: control period [s].
        n: number of arenas.
        roles: by the robots' indices; those with other roles are left alone.
        blue: how many of an arena's robots, the first, attack towards +x.
        speed: their top speed [m/s]; None for the limits'.
        tactics: of their teams.
    """

    def __init__(
        self,
        field: FieldGeometry,
        limits: RobotLimits,
        period: float,
        n: int,
        roles: Sequence[str],
        blue: int,
        speed: float | None = None,
        tactics: TacticsSettings = DEFAULT_TACTICS,
    ) -> None:
        count = len(roles)
        self._who = np.array([role == CHALLENGE for role in roles])
        self.any = bool(self._who.any())
        top = limits.max_speed if speed is None else min(speed, limits.max_speed)
        given = limits if top == limits.max_speed else limits.model_copy(update={"max_speed": top})
        driving = (limits_of(limits), limits_of(given), with_the_ball(limits))
        self._tactics = applied(tactics, field, DEFAULT_BALL)
        # Each team sees its own robots first, numbered from 0, in open play.
        self._sides: list[tuple[float, int, NDArray[np.int64], FloatArray]] = []
        self._begin: list[list[float]] = []
        for first, last in ((0, blue), (blue, count)):
            if not self._who[first:last].any():
                continue
            own = tuple(RobotState(k, 0.0, 0.0) for k in range(last - first))
            frame = Frame(0.0, field, BallState(0.0, 0.0), own, (), Team.BLUE, period)
            others = [k for k in range(count) if not first <= k < last]
            rows = np.array([*range(first, last), *others], dtype=np.int64)
            parts = (trip_of(own[0], (0.0, 0.0)), scene_of(frame), *driving, self._tactics, numbers_of(field))
            self._sides.append((1.0 if first == 0 else -1.0, last - first, rows, np.concatenate(parts)))
            # Whoever asks first of all is alone, and goes.
            self._begin.append([float(self._who[first:last].argmax()), 0.0])
        self._period = period
        self._ticks = np.zeros(n)
        self._memory = np.empty((n, count, len(FRESH)))
        self._plans = np.empty((len(self._sides), n, 2))
        self._watch = np.empty((n, 3))
        self.restart(np.arange(n))

    def restart(self, which: NDArray[np.int64]) -> None:
        """Forget what was seen in the arenas ``which``."""
        self._ticks[which] = 0.0
        self._memory[which] = FRESH
        self._plans[:, which] = np.reshape(self._begin, (-1, 1, 2))
        self._watch[which] = [-inf, 0.0, 0.0]

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick: fill these robots' commands (n, R, >= 6), given the arenas' state."""
        times, arenas = self._ticks * self._period, (robots, balls, contact)
        for side, (sign, mates, rows, seen_as) in enumerate(self._sides):
            minds = (self._plans[side], self._watch, self._memory)
            who = (self._who, rows, mates, sign)
            _decide(who, seen_as, self._tactics, times, arenas, minds, commands)
        self._ticks += 1.0


@compiled
def _decide(
    team: tuple[NDArray[np.bool_], NDArray[np.int64], int, float],
    side_: FloatArray,
    tactics: FloatArray,
    times: FloatArray,
    arenas: tuple[FloatArray, FloatArray, NDArray[np.bool_]],
    minds: tuple[FloatArray, FloatArray, FloatArray],
    commands: FloatArray,
) -> None:
    """Decide for the challengers of one team.

    Args:
        team: which robots are challengers; the robots' indices as the team sees them, its own first; how many
            those are; the sign of x in which it attacks.
        side_: :class:`_Side` of the team.
        tactics: numbers of its tactics.
        times: now, in each arena [s].
        arenas: states of robots and balls, and who has contact.
        minds: the team's plans, what was seen of the balls, and the robots' memories; changed.
        commands: to be filled.
    """
    (who, rows, mates, sign), (robots, balls, contact), (plans, watches, memory) = team, arenas, minds
    side: _Side = side_.view(_ON_SIDE)[0]
    own, trip, ball = side.own, side.trip, side.scene.ball
    count, candidates = len(rows), np.empty((mates, 3))
    seen, movers, has = np.empty((count, 6)), np.empty((count, MOVER_SIZE)), np.empty(count, dtype=np.bool_)
    every = mover_records(movers)
    for i in range(len(balls)):
        ball.x, ball.y, ball.vx, ball.vy = (
            sign * balls[i, 0],
            sign * balls[i, 1],
            sign * balls[i, 2],
            sign * balls[i, 3],
        )
        disputed = False
        for row in range(count):
            robot = robots[i, rows[row]]
            seen[row] = sign * robot
            seen[row, 2] = robot[2] if sign > 0.0 else wrap_angle(robot[2] + pi)
            seen[row, 5] = robot[5]
            mover = every[row]
            mover.x, mover.y, mover.vx, mover.vy = seen[row, 0], seen[row, 1], seen[row, 3], seen[row, 4]
            mover.max_speed, mover.acceleration, mover.braking = own.max_speed, own.acceleration, own.braking
            mover.number = row
            dx, dy = ball.x - mover.x, ball.y - mover.y
            has[row] = contact[i, rows[row]] or before_mouth(dx, dy, seen[row, 2])
            disputed = disputed or (row >= mates and has[row])
        time, speed = times[i], hypot(ball.vx, ball.vy)
        rolling = follow(watches.view(_WATCH)[i, 0], time, speed, _SLIDE, _ROLL, _SHARE)
        first = -1
        plan: _Plan = plans[i].view(_PLAN)[0]
        if may_be_attacked(ball.x, ball.y, tactics):
            there = np.array([ball.x, ball.y, ball.vx, ball.vy])
            length, width = side.scene.half_length, side.scene.half_width
            met = meetings(movers[:mates], there, rolling, _SLIDE, _ROLL, length, width)
            for row in range(mates):
                candidates[row, 0] = met[row, 0] if who[rows[row]] else inf
                candidates[row, 1], candidates[row, 2] = every[row].x, has[row]
            before, since = int(plan.attacker), time - plan.since
            first = choose_attacker(candidates, ball.x, speed, NOBODY, before, since, False, tactics)
        if first != plan.attacker:
            plan.attacker, plan.since = first, time
        waiting = place = 0
        for row in range(mates):
            waiting += who[rows[row]] and row != first
        for row in range(mates):
            if not who[rows[row]]:
                continue
            side_[:ROBOT_SIZE], trip.number = seen[row], row
            command = commands[i, rows[row]]
            if row == first:
                mind = memory[i, rows[row]].view(MEMORY)[0]
                play_the_ball(side, movers, rolling, has[row], disputed, time, mind, command)
            else:
                _wall(side, movers, place, waiting, command)
                place += 1


@compiled
def _wall(side: _Side, movers: FloatArray, place: int, size: int, command: FloatArray) -> None:
    """Drive to a place of the wall by the planned way, facing the ball."""
    trip, ball, tactics = side.trip, side.scene.ball, side.tactics
    x, y = ball.x + tactics.wall_lead * ball.vx, ball.y + tactics.wall_lead * ball.vy
    trip.x, trip.y = wall_place(side.field, x, y, place, size)
    trip.heading = heading_thereabouts(trip.me, (ball.x, ball.y), tactics.facing)
    trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, BALL_GAP, 1.0
    command[:] = 0.0
    other = side.given.max_speed != side.own.max_speed
    command[0], command[1], command[2] = travel_law(
        trip, side.scene, mover_records(movers), side.own, side.given, other, True
    )
