"""What one challenger does in a tick: it plays the ball, or drives to its place in the wall."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, isnan, nan
from typing import Protocol

import numpy as np

from robobt.motion.arrival import meetings
from robobt.motion.catch import MOUTH
from robobt.motion.give_way import BRAKES, slowed_in_play
from robobt.motion.path_planner import travel_law, waypoint_law
from robobt.motion.pilot import command_law, turn_law
from robobt.motion.scene import BALL_GAP
from robobt.plays.team_player import CARRIED, KEEP_WAY
from robobt.sim.records import Command
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
from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.skills.tactics_settings import AppliedTactics
from robobt.world.ball_model import ROLL_DECELERATION, SLIDE_DECELERATION
from robobt.world.compiled import compiled
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point, direction
from robobt.world.records import MOVER_SIZE, Limits, Mover, Scene, Trip, mover_records

_PICK_UP_SPEED, _RECEIVABLE_SPEED = PickUpBall.speed or 0.5, ReceivePass.slowest
_HOLD_PATIENCE, _SETTLED_SPEED, _SETTLING_PAUSE = KickLoose.patience, SettleBall.slow, SettleBall.pause
_APPROACH_SPEED = GeometricApproach().arrival_speed
_CARRY_AREA_GAP = 0.2
"""How far before the other defence area it carries the ball [m]."""
_PASSED = -0.05
"""How far beyond the robot a ball has passed it [m]."""


class TeamState(Protocol):
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


class ChallengerMemory(Protocol):
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


@compiled
def stand_in_wall(team: TeamState, movers: Sequence[Mover], place: int, size: int, command: Command) -> None:
    """Drive to a place of the wall by the planned way, facing the ball."""
    trip, ball, tactics = team.trip, team.scene.ball, team.tactics
    x, y = ball.x + tactics.wall_lead * ball.vx, ball.y + tactics.wall_lead * ball.vy
    trip.x, trip.y = wall_place(team.field, x, y, place, size)
    trip.heading = heading_thereabouts(trip.me, (ball.x, ball.y), tactics.facing)
    _travel(team, movers, (0.0, BALL_GAP), True, command)


@compiled
def play_the_ball(
    team: TeamState,
    movers: Sequence[Mover],
    rolling: float,
    held: tuple[bool, bool],
    time: float,
    memory: ChallengerMemory,
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
def _carried_far(x: float, y: float, alone: bool, memory: ChallengerMemory) -> bool:
    """Note where the robot took the ball; return whether it has it alone."""
    if not alone:
        memory.taken_x = nan
    elif isnan(memory.taken_x):
        memory.taken_x, memory.taken_y = x, y
    return alone


@compiled
def _carry(
    team: TeamState, movers: Sequence[Mover], time: float, memory: ChallengerMemory, command: Command
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
def _comes(team: TeamState, speed: float) -> bool:
    me, ball = team.trip.me, team.scene.ball
    ahead = (me.x - ball.x) * ball.vx + (me.y - ball.y) * ball.vy
    return ahead >= _PASSED * speed


@compiled
def _meet(team: TeamState, movers: Sequence[Mover], speed: float, rolling: float, command: Command) -> None:
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
def _get(team: TeamState, movers: Sequence[Mover], memory: ChallengerMemory, command: Command) -> None:
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
    team: TeamState, velocity: Point, heading: float, limits: Limits, gentle: bool, command: Command
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
    team: TeamState,
    movers: Sequence[Mover],
    there: tuple[float, float],
    spare_mates: bool,
    command: Command,
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
