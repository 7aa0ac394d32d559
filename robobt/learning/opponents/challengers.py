"""Field players that defend as the play ``team_player`` does, over many arenas: one challenges."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, inf, pi

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.at_the_ball import FRESH, MEMORY, play_the_ball, with_the_ball
from robobt.motion.arrival import meetings
from robobt.motion.ball_watch import rolling_after
from robobt.motion.path_planner import travel_law
from robobt.motion.pilot import roughly
from robobt.motion.scene import BALL_GAP, scene_of, trip_of
from robobt.skills.defence.wall import GAP, wall_place
from robobt.skills.tactics.attacker import NOBODY, choose_attacker, may_be_attacked
from robobt.skills.tactics.settings import DEFAULT_TACTICS, TACTICS, AppliedTactics, TacticsSettings, applied
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.compiled import compiled
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    LIMITS,
    MOVER_SIZE,
    ROBOT_SIZE,
    SCENE,
    TRIP,
    Limits,
    Mover,
    Scene,
    Trip,
    limits_of,
    mover_records,
)
from robobt.world.rules import before_mouth
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState

CHALLENGE = "challenge"
"""The role of a field player that does what ``team_player`` does in open play.

Of a team's challengers the one that has the ball soonest goes for it, by the same law as in the plan
(:mod:`robobt.skills.tactics.attacker`), and the others are a wall; all are one while the ball is in a
defence area. Nobody marks, supports, passes or shoots. The play's own speed is a ``player_speed`` of 3 m/s.
"""

_ATTACKER, _SINCE = range(2)
_SLIDE, _ROLL, _SHARE = (
    DEFAULT_BALL.slide_deceleration,
    DEFAULT_BALL.roll_deceleration,
    DEFAULT_BALL.switch_share,
)


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
        self._own, self._given = limits_of(limits), limits_of(given)
        self._carrying = with_the_ball(limits)
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
            self._sides.append((1.0 if first == 0 else -1.0, last - first, rows, scene_of(frame)))
            # Whoever asks first of all is alone, and goes.
            self._begin.append([float(self._who[first:last].argmax()), 0.0])
        self._trip = trip_of(RobotState(0, 0.0, 0.0), (0.0, 0.0))
        self._period = period
        self._ticks = np.zeros(n)
        self._memory = np.empty((n, count, MEMORY))
        self._plans = np.empty((n, len(self._sides), 2))
        self._watch = np.empty((n, 3))
        self.restart(np.arange(n))

    def restart(self, which: NDArray[np.int64]) -> None:
        """Forget what was seen in the arenas ``which``."""
        self._ticks[which] = 0.0
        self._memory[which] = FRESH
        self._plans[which] = np.reshape(self._begin, (-1, 2))
        self._watch[which] = [-inf, 0.0, 0.0]

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick: fill these robots' commands (n, R, >= 6), given the arenas' state."""
        times = self._ticks * self._period
        for side, (sign, mates, rows, scene) in enumerate(self._sides):
            _decide(
                self._who,
                rows,
                mates,
                sign,
                scene,
                self._trip,
                self._own,
                self._given,
                self._carrying,
                times,
                robots,
                balls,
                contact,
                self._plans[:, side],
                self._watch,
                self._memory,
                commands,
                self._tactics,
            )
        self._ticks += 1.0


@compiled
def _decide(
    who: NDArray[np.bool_],
    rows: NDArray[np.int64],
    mates: int,
    sign: float,
    scene_: FloatArray,
    trip_: FloatArray,
    own_: FloatArray,
    given_: FloatArray,
    carrying: FloatArray,
    times: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    contact: NDArray[np.bool_],
    plans: FloatArray,
    watches: FloatArray,
    memory: FloatArray,
    commands: FloatArray,
    numbers: FloatArray,
) -> None:
    scene: Scene = scene_.view(SCENE)[0]
    trip: Trip = trip_.view(TRIP)[0]
    own: Limits = own_.view(LIMITS)[0]
    given: Limits = given_.view(LIMITS)[0]
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    count, candidates = len(rows), np.empty((mates, 3))
    seen, movers, has = np.empty((count, 6)), np.empty((count, MOVER_SIZE)), np.empty(count, dtype=np.bool_)
    every = mover_records(movers)
    for i in range(len(balls)):
        ball = sign * balls[i]
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
            dx, dy = ball[0] - seen[row, 0], ball[1] - seen[row, 1]
            has[row] = contact[i, rows[row]] or before_mouth(dx, dy, seen[row, 2])
            disputed = disputed or (row >= mates and has[row])
        scene.ball.x, scene.ball.y, scene.ball.vx, scene.ball.vy = ball[0], ball[1], ball[2], ball[3]
        rolling = _rolling(times[i], ball, watches[i])
        first = _who_goes(who, rows, candidates, movers, has, ball, rolling, times[i], plans[i], numbers)
        waiting = place = 0
        for row in range(mates):
            waiting += who[rows[row]] and row != first
        for row in range(mates):
            if not who[rows[row]]:
                continue
            trip_[:ROBOT_SIZE], trip.number = seen[row], row
            command = commands[i, rows[row]]
            if row == first:
                play_the_ball(
                    trip,
                    scene,
                    movers,
                    own,
                    given,
                    carrying,
                    ball,
                    rolling,
                    has[row],
                    disputed,
                    times[i],
                    memory[i, rows[row]],
                    command,
                )
            else:
                _wall(trip, scene, mover_records(movers), own, given, ball, place, waiting, command, tactics)
                place += 1


@compiled
def _rolling(time: float, ball: FloatArray, watch: FloatArray) -> float:
    """Follow the ball's speed; return that from which on it rolls [m/s]."""
    speed = hypot(ball[2], ball[3])
    if time > watch[0]:
        watch[2] = rolling_after(time - watch[0], watch[1], watch[2], speed, _SLIDE, _ROLL, _SHARE)
        watch[0], watch[1] = time, speed
    return min(float(watch[2]), speed)


@compiled
def _who_goes(
    who: NDArray[np.bool_],
    rows: NDArray[np.int64],
    candidates: FloatArray,
    movers: FloatArray,
    has: NDArray[np.bool_],
    ball: FloatArray,
    rolling: float,
    time: float,
    plan: FloatArray,
    numbers: FloatArray,
) -> int:
    """Return the row of who goes for the ball, -1 for nobody, as the plan of the play's team has it."""
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    before, best, mates = int(plan[_ATTACKER]), NOBODY, len(candidates)
    if may_be_attacked(ball[0], ball[1], numbers):
        met = meetings(movers[:mates], ball, rolling, _SLIDE, _ROLL, tactics.half_length, tactics.half_width)
        for row in range(mates):
            candidates[row, 0] = met[row, 0] if who[rows[row]] else inf
            candidates[row, 1], candidates[row, 2] = movers[row, 0], has[row]
        speed, since = hypot(ball[2], ball[3]), time - plan[_SINCE]
        best = choose_attacker(candidates, ball[0], speed, NOBODY, before, since, False, numbers)
    if best != before:
        plan[_ATTACKER], plan[_SINCE] = best, time
    return best


@compiled
def _wall(
    trip: Trip,
    scene: Scene,
    movers: Sequence[Mover],
    own: Limits,
    given: Limits,
    ball: FloatArray,
    place: int,
    size: int,
    command: FloatArray,
    tactics: AppliedTactics,
) -> None:
    """Drive to a place of the wall by the planned way, facing the ball."""
    depth = scene.area_depth + GAP
    half = min(scene.area_width / 2 + GAP, scene.half_width)
    x, y = ball[0] + tactics.wall_lead * ball[2], ball[1] + tactics.wall_lead * ball[3]
    trip.x, trip.y = wall_place(-scene.half_length, depth, half, x, y, place, size)
    dx, dy = ball[0] - trip.me.x, ball[1] - trip.me.y
    slack = tactics.facing + atan2(ROBOT_RADIUS, hypot(dx, dy))
    trip.heading = roughly(trip.me.heading, atan2(dy, dx), slack)
    trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, BALL_GAP, 1.0
    command[:] = 0.0
    other = given.max_speed != own.max_speed
    command[0], command[1], command[2] = travel_law(trip, scene, movers, own, given, other, True)
