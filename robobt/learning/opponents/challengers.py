"""Field players that act like the play ``team_player`` in open play, over many arenas.

One robot goes for the ball, gets it and keeps it. These of the play's options for that robot are implemented:
``KickLoose``, releasing a ball carried too far, ``SettleBall``, carrying the ball (straight at the other
goal, while the play searches for the best place), ``GoToBall`` and ``PickUpBall``. A rolling ball is met
where the team's plan meets it, but not caught as softly as by ``ReceivePass``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from math import atan2, hypot, inf, isnan, nan
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.sides import Arenas, see_ball, see_robots
from robobt.motion.arrival import meetings
from robobt.motion.ball_watch import Watch, follow
from robobt.motion.catch import MOUTH
from robobt.motion.dribbling import carrying_limits, dribbling_limits
from robobt.motion.give_way import BRAKES, slowed_in_play
from robobt.motion.path_planner import travel_law, waypoint_law
from robobt.motion.pilot import command_law, turn_law
from robobt.motion.scene import BALL_GAP, scene_of, trip_of
from robobt.plays.team_player import CARRIED, CARRYING, KEEP_WAY
from robobt.sim.records import COMMAND, Command, size
from robobt.skills.ball.dribble_to import Course, carrying_velocity, steady
from robobt.skills.ball.go_to_ball import (
    FACING_BALL,
    HANDOVER_DISTANCE,
    GeometricApproach,
    approach_heading,
    beside,
    is_at_ball,
    meeting_law,
)
from robobt.skills.ball.kick_loose import FOLLOW, LOOSE_KICK_SPEED, Hold, KickLoose, has_lasted
from robobt.skills.ball.let_go import push_speed
from robobt.skills.ball.pick_up_ball import PickUpBall, creeping
from robobt.skills.ball.settle_ball import SettleBall, Settling, is_braked, is_settled
from robobt.skills.base import heading_thereabouts
from robobt.skills.conditions.carried_far import way_carried
from robobt.skills.defence.wall import wall_place
from robobt.skills.tactics.attacker import ATTACKER_CANDIDATE, NOBODY, choose_attacker, may_be_attacked
from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.skills.tactics_settings import DEFAULT_TACTICS, AppliedTactics, TacticsSettings, applied
from robobt.world.ball_model import DEFAULT_BALL, ROLL_DECELERATION, SLIDE_DECELERATION, SWITCH_SHARE
from robobt.world.compiled import compiled, numbers_of, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray, Point, direction
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    BALL,
    MEETING,
    MOVER_SIZE,
    ROBOT,
    ROBOT_SIZE,
    Limits,
    Mover,
    Scene,
    Trip,
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


class _Team(Protocol):
    """A team of every arena, as it sees the field.

    Attributes:
        trip: of the robot that decides.
        scene: what a plan depends on.
        own: what its robots can do.
        given: how they are to be driven.
        dribbles, brakes: how they are driven with the ball, and to come to rest with it.
        tactics: what it weighs.
        field: dimensions.
    """

    trip: Trip
    scene: Scene
    own: Limits
    given: Limits
    dribbles: Limits
    brakes: Limits
    tactics: AppliedTactics
    field: FieldGeometry


class _Plan(Protocol):
    """The team's attacker (its row), and since when [s]."""

    attacker: float
    since: float


class _ChallengerMemory(Protocol):
    """Of one robot.

    Attributes:
        hold: of :class:`~robobt.skills.ball.kick_loose.KickLoose`.
        settling: of :class:`~robobt.skills.ball.settle_ball.SettleBall`.
        course: of :class:`~robobt.skills.ball.dribble_to.DribbleTo`.
        taken_x, taken_y: where it took the ball that it has [m], nan for nowhere.
        at_ball: whether the approach has ended.
    """

    hold: Hold
    settling: Settling
    course: Course
    taken_x: float
    taken_y: float
    at_ball: float


_CHALLENGER_MEMORY = record_dtype(_ChallengerMemory)
_FRESH = np.array([*astuple(Hold()), *astuple(Settling()), *astuple(Course()), nan, nan, 0.0])
"""A memory of nothing."""

_TEAM, _PLAN, _WATCH = record_dtype(_Team), record_dtype(_Plan), record_dtype(Watch)
_CANDIDATE_SIZE = size(ATTACKER_CANDIDATE)
_HOLD_PATIENCE, _SETTLED_SPEED, _SETTLING_PAUSE = KickLoose.patience, SettleBall.slow, SettleBall.pause
_PICK_UP_SPEED, _RECEIVABLE_SPEED = PickUpBall.speed or 0.5, ReceivePass.slowest
_APPROACH_SPEED = GeometricApproach().arrival_speed
_CARRY_AREA_GAP = 0.2
"""How far before the other defence area it carries the ball [m]."""
_PASSED = -0.05
"""How far beyond the robot a ball has passed it [m]."""


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
        team_: :class:`_Team`.
        tactics: numbers of its tactics.
        times: now, in each arena [s].
        arenas: states of robots and balls, and who has contact.
        minds: the team's plans, what was seen of the balls, and the robots' memories; changed.
        commands: to be filled.
    """
    (who, rows, mates, sign), (robots_, balls_, contact), (plans, watches, memory) = players, arenas, minds
    robots, balls = robots_.view(ROBOT)[..., 0], balls_.view(BALL)[:, 0]
    team: _Team = team_.view(_TEAM)[0]
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
                _play_the_ball(team, every, rolling, (has[row], disputed), time, mind, command)
            else:
                _wall(team, every, place, waiting, command)
                place += 1


@compiled
def _wall(team: _Team, movers: Sequence[Mover], place: int, size: int, command: Command) -> None:
    """Drive to a place of the wall by the planned way, facing the ball."""
    trip, ball, tactics = team.trip, team.scene.ball, team.tactics
    x, y = ball.x + tactics.wall_lead * ball.vx, ball.y + tactics.wall_lead * ball.vy
    trip.x, trip.y = wall_place(team.field, x, y, place, size)
    trip.heading = heading_thereabouts(trip.me, (ball.x, ball.y), tactics.facing)
    _travel(team, movers, (0.0, BALL_GAP), True, command)


@compiled
def _play_the_ball(
    team: _Team,
    movers: Sequence[Mover],
    rolling: float,
    held: tuple[bool, bool],
    time: float,
    memory: _ChallengerMemory,
    command: Command,
) -> None:
    """Decide a tick of the robot that goes for the ball.

    Args:
        team: with the robot and the ball.
        movers: everybody, the robot's team first.
        rolling: speed from which on the ball rolls [m/s].
        held: whether the robot has it, and whether an opponent has.
        time: now [s].
        memory: of the robot; changed.
        command: all zero; to be filled.
    """
    me, scene, ball, (has, disputed) = team.trip.me, team.scene, team.scene.ball, held
    speed = hypot(ball.vx, ball.vy)
    if has and disputed and has_lasted(memory.hold, time, me.heading, _HOLD_PATIENCE):
        command.vx, command.kick_speed, command.on_contact = FOLLOW, LOOSE_KICK_SPEED, 1.0
    elif _carried_far(ball.x, ball.y, has and not disputed, memory) and (
        way_carried(ball, memory.taken_x, memory.taken_y) >= CARRIED
    ):
        command.kick_speed = push_speed(me, ball)
    elif has and not is_settled(memory.settling, time, speed, _SETTLED_SPEED, _SETTLING_PAUSE):
        braked = is_braked(speed, team.brakes.braking)
        limits, gentle = (team.brakes, True) if braked else (team.own, team.own.trailing_time > 0.0)
        _handle(team, (0.0, 0.0), me.heading, limits, gentle, command)
    elif has:
        _carry(team, movers, time, memory, command)
    elif speed >= _RECEIVABLE_SPEED and _comes(team, speed):
        _meet(team, movers, speed, rolling, command)
    else:
        _get(team, movers, memory, command)
    if command.vx != 0.0 or command.vy != 0.0:
        velocity, theirs = (command.vx, command.vy), movers[int(scene.mates) :]
        command.vx, command.vy = slowed_in_play(me, velocity, theirs, BRAKES * team.own.braking)


@compiled
def _carried_far(x: float, y: float, alone: bool, memory: _ChallengerMemory) -> bool:
    """Note where the robot took the ball; return whether it has it alone."""
    if not alone:
        memory.taken_x = nan
    elif isnan(memory.taken_x):
        memory.taken_x, memory.taken_y = x, y
    return alone


@compiled
def _carry(
    team: _Team, movers: Sequence[Mover], time: float, memory: _ChallengerMemory, command: Command
) -> None:
    """Act like ``DribbleTo``, with a target in front of the other goal."""
    trip, scene, own, limits = team.trip, team.scene, team.own, team.dribbles
    me = trip.me
    trip.x, trip.y = scene.half_length - scene.area_depth - _CARRY_AREA_GAP, 0.0
    trip.ball_gap, trip.avoids_robots = -1.0, 1.0
    x, y, there = waypoint_law(trip, (trip.x, trip.y), scene, movers, own, True)
    heading = steady(memory.course, time, direction((me.x, me.y), (x, y)), KEEP_WAY)
    pace = limits.max_speed, limits.acceleration, limits.braking
    velocity = carrying_velocity(me, (x, y), there, heading, pace, scene.period + 2.0 * own.trailing_time)
    _handle(team, velocity, heading, limits, True, command)


@compiled
def _comes(team: _Team, speed: float) -> bool:
    me, ball = team.trip.me, team.scene.ball
    ahead = (me.x - ball.x) * ball.vx + (me.y - ball.y) * ball.vy
    return ahead >= _PASSED * speed


@compiled
def _meet(team: _Team, movers: Sequence[Mover], speed: float, rolling: float, command: Command) -> None:
    """Get onto the line of a coming ball, facing it: here if it is near, else where the robot is first."""
    trip, scene, ball, given = team.trip, team.scene, team.scene.ball, team.given
    me = trip.me
    ux, uy = ball.vx / speed, ball.vy / speed
    dx, dy = me.x - ball.x, me.y - ball.y
    ahead = dx * ux + dy * uy
    if abs(dx * uy - dy * ux) < team.tactics.stays_within and ahead > MOUTH:
        x, y = ball.x + ahead * ux, ball.y + ahead * uy
    else:
        one = np.zeros((1, MOVER_SIZE))
        mover = mover_records(one)[0]
        mover.x, mover.y, mover.vx, mover.vy = me.x, me.y, me.vx, me.vy
        mover.max_speed, mover.acceleration, mover.braking = (
            given.max_speed,
            given.acceleration,
            given.braking,
        )
        there = np.array([ball.x, ball.y, ball.vx, ball.vy])
        met = meetings(
            one, there, rolling, SLIDE_DECELERATION, ROLL_DECELERATION, scene.half_length, scene.half_width
        )
        x, y = met[0, 1] + MOUTH * ux, met[0, 2] + MOUTH * uy
    trip.x, trip.y, trip.heading = x, y, atan2(-dy, -dx)
    _travel(team, movers, (0.0, -1.0), False, command)
    command.dribbler = 1.0


@compiled
def _get(team: _Team, movers: Sequence[Mover], memory: _ChallengerMemory, command: Command) -> None:
    """Act like ``GoToBall`` and ``PickUpBall``."""
    trip, own, given = team.trip, team.own, team.given
    me, ball = trip.me, team.scene.ball
    at_ball = is_at_ball(me, ball, memory.at_ball > 0.0, HANDOVER_DISTANCE, FACING_BALL)
    memory.at_ball = 1.0 if at_ball else 0.0
    if at_ball:
        bearing, vx, vy = creeping(me, ball, _PICK_UP_SPEED)
        _handle(team, (vx, vy), bearing, own, own.trailing_time > 0.0, command)
        return
    pace = given.max_speed, given.acceleration, given.braking
    meeting = meeting_law(me, ball, pace, SLIDE_DECELERATION, ROLL_DECELERATION)
    trip.heading, _ = approach_heading(me, ball, meeting)
    trip.x, trip.y = beside(meeting, direction((me.x, me.y), meeting))
    _travel(team, movers, (_APPROACH_SPEED, -1.0), False, command)


@compiled
def _handle(
    team: _Team, velocity: Point, heading: float, limits: Limits, gentle: bool, command: Command
) -> None:
    """Drive with the dribbler on, within ``limits``; the rest is as for ``command_law``."""
    me, own, period = team.trip.me, team.own, team.scene.period
    omega = turn_law(me, heading, own, limits, period)
    command.vx, command.vy, command.omega = command_law(
        me, velocity, omega, own, limits, limits.max_speed, gentle, period
    )
    command.dribbler = 1.0


@compiled
def _travel(
    team: _Team, movers: Sequence[Mover], there: tuple[float, float], spare_mates: bool, command: Command
) -> None:
    """Drive to the trip's target by the planned way.

    ``there`` are the speed allowed at the target [m/s] and the gap to the ball [m], negative where that is no
    obstacle; ``spare_mates`` is as of ``travel_law``.
    """
    trip, own, given = team.trip, team.own, team.given
    (trip.final_speed, trip.ball_gap), trip.avoids_robots = there, 1.0
    other = given.max_speed != own.max_speed
    command.vx, command.vy, command.omega = travel_law(
        trip, team.scene, movers, own, given, other, spare_mates
    )
