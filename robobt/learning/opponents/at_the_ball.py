"""What the play ``team_player`` does in open play as its team's attacker, compiled: get the ball and keep it.

Of the play's options these are here: ``KickLoose``, letting go of a ball carried too far, ``SettleBall``,
carrying the ball (straight at the other goal, where the play looks for the best place), ``GoToBall`` and
``PickUpBall``. A rolling ball is met where the team's plan meets it, but not caught as softly as
``ReceivePass`` does; nobody shoots or passes.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, isnan, nan
from typing import Protocol

import numpy as np

from robobt.motion.arrival import meetings
from robobt.motion.catch import MOUTH
from robobt.motion.dribbling import dribbling_limits
from robobt.motion.give_way import BRAKES, slowed_in_play
from robobt.motion.path_planner import travel_law, waypoint_law
from robobt.motion.pilot import command_law, turn_law
from robobt.plays.team_player import CARRIED, CARRYING, KEEP_WAY
from robobt.skills.ball.dribble_to import Course, carrying_velocity, steady
from robobt.skills.ball.go_to_ball import (
    FACING_BALL,
    HANDOVER_DISTANCE,
    Geometric,
    approach_heading,
    beside,
    is_at_ball,
    meeting_law,
)
from robobt.skills.ball.kick_loose import FOLLOW, SPEED, Hold, KickLoose, has_lasted
from robobt.skills.ball.let_go import push_speed
from robobt.skills.ball.pick_up_ball import PickUpBall, creeping
from robobt.skills.ball.settle_ball import SettleBall, Settling, is_settled
from robobt.skills.conditions.carried_far import way_carried
from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.skills.tactics_settings import AppliedTactics
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.compiled import compiled, record_dtype
from robobt.world.geometry import FloatArray, direction
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    MOVER_SIZE,
    Limits,
    Mover,
    Scene,
    Trip,
    limits_of,
    mover_records,
)


class Attack(Protocol):
    """What an attacker of any arena needs to know: the trip is its own, and changed.

    Attributes:
        trip: with the robot's state.
        scene: what a plan depends on.
        own: what the robot can do.
        given: how it is to be driven.
        dribbles, brakes: how it is driven with the ball, and to come to rest with it.
        tactics: of its team.
    """

    trip: Trip
    scene: Scene
    own: Limits
    given: Limits
    dribbles: Limits
    brakes: Limits
    tactics: AppliedTactics


class Memory(Protocol):
    """Of one attacker.

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


MEMORY = record_dtype(Memory)
FRESH = np.array(
    [
        Hold().since,
        Hold().seen,
        Settling().had,
        Settling().settled,
        Course().way,
        Course().since,
        nan,
        nan,
        0.0,
    ]
)
"""A :class:`Memory` of nothing."""

_PATIENCE, _SLOW, _PAUSE = KickLoose.patience, SettleBall.slow, SettleBall.pause
_CREEP, _ROLLS = PickUpBall.speed or 0.5, ReceivePass.slowest
_ARRIVAL_SPEED = Geometric().arrival_speed
_BEFORE_AREA = 0.2
"""How far before the other defence area it carries the ball [m]."""
_PASSED = -0.05
"""How far beyond the robot a ball has passed it [m]."""
_SLIDE, _ROLL = DEFAULT_BALL.slide_deceleration, DEFAULT_BALL.roll_deceleration


def with_the_ball(limits: RobotLimits) -> FloatArray:
    """Return the limits for carrying it and for braking with it, as one row."""
    braking = dribbling_limits(max_acceleration=SettleBall.share * limits.hold_acceleration)
    return np.concatenate([limits_of(dribbling_limits(CARRYING)), limits_of(braking)])


@compiled
def play_the_ball(
    attack: Attack,
    movers_: FloatArray,
    rolling: float,
    has: bool,
    disputed: bool,
    time: float,
    memory: Memory,
    command: FloatArray,
) -> None:
    """Decide a tick of the robot that goes for the ball.

    Args:
        attack: with the robot and the ball.
        movers_: everybody, the robot's team first, as of :func:`~robobt.world.records.movers`.
        rolling: speed from which on the ball rolls [m/s].
        has: whether the robot has it.
        disputed: whether an opponent has it.
        time: now [s].
        memory: of the robot; changed.
        command: (>= 6,) to be filled.
    """
    scene, own, limits, movers = attack.scene, attack.own, attack.brakes, mover_records(movers_)
    me, ball = attack.trip.me, scene.ball
    speed = hypot(ball.vx, ball.vy)
    command[:] = 0.0
    if has and disputed and has_lasted(memory.hold, time, me.heading, _PATIENCE):
        command[0], command[3], command[4] = FOLLOW, SPEED, 1.0
    elif _carried_far(ball.x, ball.y, has and not disputed, memory) and (
        way_carried(ball, memory.taken_x, memory.taken_y) >= CARRIED
    ):
        command[3] = push_speed(me, ball)
    elif has and not is_settled(memory.settling, time, speed, _SLOW, _PAUSE):
        omega = turn_law(me, me.heading, own, limits, scene.period)
        command[0], command[1], command[2] = command_law(
            me, (0.0, 0.0), omega, own, limits, limits.max_speed, True, scene.period
        )
        command[5] = 1.0
    elif has:
        _carry(attack, movers, time, memory, command)
    elif speed >= _ROLLS and _comes(attack, speed):
        _meet(attack, movers, speed, rolling, command)
    else:
        _get(attack, movers, memory, command)
    if command[0] != 0.0 or command[1] != 0.0:
        velocity, theirs = (command[0], command[1]), movers[int(scene.mates) :]
        command[0], command[1] = slowed_in_play(me, velocity, theirs, BRAKES * own.braking)


@compiled
def _carried_far(x: float, y: float, alone: bool, memory: Memory) -> bool:
    """Note where the robot took the ball; return whether it has it alone."""
    if not alone:
        memory.taken_x = nan
    elif isnan(memory.taken_x):
        memory.taken_x, memory.taken_y = x, y
    return alone


@compiled
def _carry(attack: Attack, movers: Sequence[Mover], time: float, memory: Memory, command: FloatArray) -> None:
    """Do what ``DribbleTo`` does, to before the other goal."""
    trip, scene, own, limits = attack.trip, attack.scene, attack.own, attack.dribbles
    me, period = trip.me, scene.period
    trip.x, trip.y = scene.half_length - scene.area_depth - _BEFORE_AREA, 0.0
    trip.ball_gap, trip.avoids_robots = -1.0, 1.0
    x, y, there = waypoint_law(trip, (trip.x, trip.y), scene, movers, own, True)
    heading = steady(memory.course, time, direction((me.x, me.y), (x, y)), KEEP_WAY)
    pace = limits.max_speed, limits.acceleration
    velocity = carrying_velocity(me, (x, y), there, heading, pace, period + 2.0 * own.reaction)
    omega = turn_law(me, heading, own, limits, period)
    command[0], command[1], command[2] = command_law(
        me, velocity, omega, own, limits, limits.max_speed, True, period
    )
    command[5] = 1.0


@compiled
def _comes(attack: Attack, speed: float) -> bool:
    me, ball = attack.trip.me, attack.scene.ball
    ahead = (me.x - ball.x) * ball.vx + (me.y - ball.y) * ball.vy
    return ahead >= _PASSED * speed


@compiled
def _meet(attack: Attack, movers: Sequence[Mover], speed: float, rolling: float, command: FloatArray) -> None:
    """Get onto the way of a ball that comes, facing it: here if the robot is near, else where it is first."""
    trip, scene, ball, given = attack.trip, attack.scene, attack.scene.ball, attack.given
    me = trip.me
    ux, uy = ball.vx / speed, ball.vy / speed
    dx, dy = me.x - ball.x, me.y - ball.y
    ahead = dx * ux + dy * uy
    if abs(dx * uy - dy * ux) < attack.tactics.stays_within and ahead > MOUTH:
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
        met = meetings(one, there, rolling, _SLIDE, _ROLL, scene.half_length, scene.half_width)
        x, y = met[0, 1] + MOUTH * ux, met[0, 2] + MOUTH * uy
    trip.x, trip.y, trip.heading = x, y, atan2(-dy, -dx)
    _travel(attack, movers, 0.0, command)
    command[5] = 1.0


@compiled
def _get(attack: Attack, movers: Sequence[Mover], memory: Memory, command: FloatArray) -> None:
    """Do what ``GoToBall`` and ``PickUpBall`` do."""
    trip, scene, own, given = attack.trip, attack.scene, attack.own, attack.given
    me, ball, period = trip.me, scene.ball, scene.period
    at_ball = is_at_ball(me, ball, memory.at_ball > 0.0, HANDOVER_DISTANCE, FACING_BALL)
    memory.at_ball = 1.0 if at_ball else 0.0
    if at_ball:
        bearing, vx, vy = creeping(me, ball, _CREEP)
        omega = turn_law(me, bearing, own, own, period)
        command[0], command[1], command[2] = command_law(
            me, (vx, vy), omega, own, own, own.max_speed, own.reaction > 0.0, period
        )
        command[5] = 1.0
        return
    pace = given.max_speed, given.acceleration, given.braking
    meeting = meeting_law(me, ball, pace, _SLIDE, _ROLL)
    trip.heading, _ = approach_heading(me, ball, meeting)
    trip.x, trip.y = beside(meeting, direction((me.x, me.y), meeting))
    _travel(attack, movers, _ARRIVAL_SPEED, command)


@compiled
def _travel(attack: Attack, movers: Sequence[Mover], final_speed: float, command: FloatArray) -> None:
    """Drive to the trip's target by the planned way, which the ball does not block."""
    trip, own, given = attack.trip, attack.own, attack.given
    trip.final_speed, trip.ball_gap, trip.avoids_robots = final_speed, -1.0, 1.0
    other = given.max_speed != own.max_speed
    command[0], command[1], command[2] = travel_law(trip, attack.scene, movers, own, given, other, False)
