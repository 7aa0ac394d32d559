"""Field players that act like the play ``team_player`` in open play, over many arenas.

One robot goes for the ball, gets it and keeps it. These of the play's options for that robot are implemented:
``KickLoose``, releasing a ball carried too far, ``SettleBall``, carrying the ball (straight at the other
goal, while the play searches for the best place), ``GoToBall`` and ``PickUpBall``. A rolling ball is met
where the team's plan meets it, but not caught as softly as by ``ReceivePass``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from math import hypot, inf, nan
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.challenger_moves import (
    ChallengerMemory,
    TeamState,
    play_the_ball,
    stand_in_wall,
)
from robobt.learning.opponents.sides import Arenas, see_ball, see_robots
from robobt.motion.arrival import meetings
from robobt.motion.ball_watch import Watch, follow
from robobt.motion.dribbling import carrying_limits, dribbling_limits
from robobt.motion.scene import scene_of, trip_of
from robobt.plays.team_player import CARRYING
from robobt.sim.records import COMMAND, Command, size
from robobt.skills.ball.dribble_to import Course
from robobt.skills.ball.kick_loose import Hold
from robobt.skills.ball.settle_ball import SettleBall, Settling
from robobt.skills.tactics.attacker import ATTACKER_CANDIDATE, NOBODY, choose_attacker, may_be_attacked
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings, applied
from robobt.world.ball_model import DEFAULT_BALL, ROLL_DECELERATION, SLIDE_DECELERATION, SWITCH_SHARE
from robobt.world.compiled import compiled, numbers_of, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    BALL,
    MEETING,
    MOVER_SIZE,
    ROBOT,
    ROBOT_SIZE,
    limits_of,
    mover_records,
    robot_records,
)
from robobt.world.state import BallState, Frame, RobotState

CHALLENGE = "challenge"
"""The role of a field player that acts like ``team_player`` in open play.

The team's challenger that can have the ball soonest goes for it, by the same rule as in the plan
(:mod:`robobt.skills.tactics.attacker`), and the others form a wall; all form the wall while the ball is in a
defence area. They do not mark, support, pass or shoot. The play's speed corresponds to a ``player_speed`` of
3 m/s.
"""


class _Plan(Protocol):
    """The team's attacker (its row), and since when [s]."""

    attacker: float
    since: float


_CHALLENGER_MEMORY = record_dtype(ChallengerMemory)
_FRESH = np.array([*astuple(Hold()), *astuple(Settling()), *astuple(Course()), nan, nan, 0.0])
"""A memory of nothing."""

_TEAM, _PLAN, _WATCH = record_dtype(TeamState), record_dtype(_Plan), record_dtype(Watch)
_CANDIDATE_SIZE = size(ATTACKER_CANDIDATE)


class Challengers:
    """The robots of the role :data:`CHALLENGE` in each of ``n`` arenas.

    Args:
        field: dimensions.
        limits: what they can do.
        period: control period [s].
        n: number of arenas.
        roles: by the robots' indices; those with other roles are left alone.
        blue: number of an arena's robots, the first ones, that attack towards +x.
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
        brakes = dribbling_limits(max_acceleration=SettleBall.share * limits.hold_acceleration)
        driving = [limits_of(each) for each in (limits, given, carrying_limits(limits, CARRYING), brakes)]
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
            # The first robot that asks is alone, so it goes for the ball.
            self._begin.append([float(self._who[first:last].argmax()), 0.0])
        self._period = period
        self._ticks = np.zeros(n)
        self._memory = np.empty((n, count, len(_FRESH)))
        self._plans = np.empty((len(self._sides), n, 2))
        self._watch = np.empty((n, 3))
        self.restart(np.arange(n))

    def restart(self, which: NDArray[np.int64]) -> None:
        """Forget earlier observations in the arenas ``which``."""
        self._ticks[which] = 0.0
        self._memory[which] = _FRESH
        self._plans[:, which] = np.reshape(self._begin, (-1, 1, 2))
        self._watch[which] = [-inf, 0.0, 0.0]

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], commands: FloatArray
    ) -> None:
        """Decide one control tick: fill these robots' commands (n, R, size(COMMAND))."""
        times, arenas = self._ticks * self._period, (robots, balls, contact)
        for side, (sign, mates, rows, seen_as) in enumerate(self._sides):
            minds = (self._plans[side], self._watch, self._memory)
            players = (self._who, rows, mates, sign)
            _decide(players, seen_as, self._tactics, times, arenas, minds, commands)
        self._ticks += 1.0


@compiled
def _decide(
    players: tuple[NDArray[np.bool_], NDArray[np.int64], int, float],
    team_: FloatArray,
    tactics: FloatArray,
    times: FloatArray,
    arenas: Arenas,
    minds: tuple[FloatArray, FloatArray, FloatArray],
    commands: FloatArray,
) -> None:
    """Decide for the challengers of one team.

    Args:
        players: which robots are challengers; the robots' indices as the team sees them, its own first; how
            many those are; the sign of x in which it attacks.
        team_: :class:`TeamState`.
        tactics: numbers of its tactics.
        times: now, in each arena [s].
        arenas: states of robots and balls, and who has contact.
        minds: the team's plans, what was seen of the balls, and the robots' memories; changed.
        commands: to be filled.
    """
    (who, rows, mates, sign), (robots_, balls_, contact), (plans, watches, memory) = players, arenas, minds
    robots, balls = robots_.view(ROBOT)[..., 0], balls_.view(BALL)[:, 0]
    team: TeamState = team_.view(_TEAM)[0]
    own, trip, ball = team.own, team.trip, team.scene.ball
    count, candidates = len(rows), np.empty((mates, _CANDIDATE_SIZE))
    seen_, movers = np.empty((count, ROBOT_SIZE)), np.empty((count, MOVER_SIZE))
    seen, every = robot_records(seen_), mover_records(movers)
    has: NDArray[np.bool_] = np.empty(count, dtype=np.bool_)
    for i in range(len(balls)):
        see_ball(balls[i], sign, ball)
        see_robots(robots[i], contact[i], rows, sign, own, ball, seen, every, has)
        disputed = bool(has[mates:].any())
        time, speed = times[i], hypot(ball.vx, ball.vy)
        rolling = follow(
            watches.view(_WATCH)[i, 0], time, speed, SLIDE_DECELERATION, ROLL_DECELERATION, SWITCH_SHARE
        )
        first = -1
        plan: _Plan = plans[i].view(_PLAN)[0]
        if may_be_attacked(ball.x, ball.y, tactics):
            there = np.array([ball.x, ball.y, ball.vx, ball.vy])
            length, width = team.scene.half_length, team.scene.half_width
            met = meetings(
                movers[:mates], there, rolling, SLIDE_DECELERATION, ROLL_DECELERATION, length, width
            )
            for row in range(mates):
                candidate = candidates.view(ATTACKER_CANDIDATE)[row, 0]
                candidate.time = met.view(MEETING)[row, 0].time if who[rows[row]] else inf
                candidate.x, candidate.has_ball = every[row].x, has[row]
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
            team_[:ROBOT_SIZE], trip.number = seen_[row], row
            commands[i, rows[row]] = 0.0
            command: Command = commands[i].view(COMMAND)[rows[row], 0]
            if row == first:
                mind = memory[i, rows[row]].view(_CHALLENGER_MEMORY)[0]
                play_the_ball(team, every, rolling, (has[row], disputed), time, mind, command)
            else:
                stand_in_wall(team, every, place, waiting, command)
                place += 1
