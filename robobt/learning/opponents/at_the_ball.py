"""What the play ``team_player`` does in open play as its team's attacker, compiled: get the ball and keep it.

Of the play's options these are here: ``KickLoose``, letting go of a ball carried too far, ``SettleBall``,
carrying the ball (straight at the other goal, where the play looks for the best place), ``GoToBall`` and
``PickUpBall``. A rolling ball is met where the team's plan meets it, but not caught as softly as
``ReceivePass`` does; nobody shoots or passes.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, inf, pi, sin

import numpy as np

from robobt.motion.arrival import meetings
from robobt.motion.catch import MOUTH
from robobt.motion.dribbling import dribbling_limits
from robobt.motion.give_way import slowed_in_play
from robobt.motion.path_planner import travel_law, waypoint_law
from robobt.motion.pilot import approach_speed, command_law, roughly, stop_time, turn_law
from robobt.skills.ball.go_to_ball import HANDOVER_DISTANCE, beside
from robobt.skills.ball.kick_loose import KickLoose
from robobt.skills.ball.let_go import FASTER
from robobt.skills.ball.pick_up_ball import LOST_DISTANCE, PickUpBall
from robobt.skills.ball.settle_ball import SettleBall
from robobt.skills.conditions.carried_far import LETTING_GO
from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.world.ball_model import DEFAULT_BALL, way_in
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    LIMITS,
    MOVER_SIZE,
    Limits,
    Mover,
    Robot,
    Scene,
    Trip,
    limits_of,
    mover_records,
)
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

HELD_SINCE, HELD_SEEN, TAKEN_X, TAKEN_Y, HAD, SETTLED, WAY, WAY_SINCE, AT_IT = range(9)
"""A memory has since when and when last an opponent held the ball too [s]; where it was taken, nan for
nowhere [m]; when the robot had it last [s], and whether it was slow since; which way the robot carries it
[rad] and since when [s]; whether the approach has ended."""
MEMORY = 9
FRESH = np.array([-inf, -inf, np.nan, np.nan, -10.0, 0.0, 0.0, -inf, 0.0])
"""Nothing has been seen."""

DRIBBLE, BRAKE = range(2)

_PATIENCE, _SLOW, _PAUSE = KickLoose.patience, SettleBall.slow, SettleBall.pause
_CREEP, _ROLLS = PickUpBall.speed or 0.5, ReceivePass.slowest
_BROKEN, _LOOSE, _FOLLOW = 0.1, 2.0, 0.3
"""A hold broken off for so long begins anew [s]; speed of a ball kicked loose, and after it [m/s]."""
_CARRIED = 0.9
"""It lets go of a ball carried so far [m]."""
_CARRYING, _STEADY, _OTHER_WAY, _BEFORE_AREA = 1.5, 0.25, 0.6, 0.2
"""How fast it carries the ball [m/s], keeps to a way for [s] where one differs by [rad], and to where [m]."""
_FACING, _FACING_STILL, _LOOKING = pi / 6.0, pi / 3.0, pi / 18.0
_TURN_DISTANCE, _ARRIVAL_SPEED = 1.0, 0.5
_TOUCHING, _RESTS = ROBOT_RADIUS + BALL_RADIUS, 0.05
_ON_LINE, _PASSED = 0.5, -0.05
"""So near to a rolling ball's line it waits there, so far beyond the ball that has passed [m]."""
_BRAKES = 0.7
_SLIDE, _ROLL = DEFAULT_BALL.slide_deceleration, DEFAULT_BALL.roll_deceleration


def with_the_ball(limits: RobotLimits) -> FloatArray:
    """Return the limits for carrying it and for braking with it, (2, 9)."""
    braking = dribbling_limits(max_acceleration=SettleBall.share * limits.hold_acceleration)
    return np.array([limits_of(dribbling_limits(_CARRYING)), limits_of(braking)])


@compiled
def play_the_ball(
    trip: Trip,
    scene: Scene,
    movers_: FloatArray,
    own: Limits,
    given: Limits,
    carrying: FloatArray,
    ball: FloatArray,
    rolling: float,
    has: bool,
    disputed: bool,
    time: float,
    memory: FloatArray,
    command: FloatArray,
) -> None:
    """Decide a tick of the robot that goes for the ball.

    Args:
        trip: with the robot's state; changed.
        scene: what a plan depends on.
        movers_: everybody, the robot's team first, as of :func:`~robobt.world.records.movers`.
        own: what the robot can do.
        given: how it is to be driven.
        carrying: of :func:`with_the_ball`.
        ball: x, y, vx, vy as its team sees it.
        rolling: speed from which on it rolls [m/s].
        has: whether the robot has the ball.
        disputed: whether an opponent has it.
        time: now [s].
        memory: ``MEMORY`` of the robot; changed.
        command: (>= 6,) to be filled.
    """
    me, movers, speed = trip.me, mover_records(movers_), hypot(ball[2], ball[3])
    command[:] = 0.0
    if _kicks_loose(me, has and disputed, time, memory):
        command[0], command[3], command[4] = _FOLLOW, _LOOSE, 1.0
    elif _carried_far(ball, speed, has and not disputed, memory):
        along = cos(me.heading) * ball[2] + sin(me.heading) * ball[3]
        command[3] = max(0.0, along) + FASTER if ball[0] > 0.0 or cos(me.heading) > 0.0 else 0.0
    elif has and _settles(speed, time, memory):
        limits, period = carrying.view(LIMITS)[BRAKE, 0], scene.period
        omega = turn_law(me, me.heading, own, limits, period)
        command[0], command[1], command[2] = command_law(
            me, (0.0, 0.0), omega, own, limits, limits.max_speed, True, period
        )
        command[5] = 1.0
    elif has:
        _carry(trip, scene, movers, own, carrying, time, memory, command)
    elif speed >= _ROLLS and _comes(me, ball, speed):
        _meet(trip, scene, movers, own, given, ball, speed, rolling, command)
    else:
        _get(trip, scene, movers, own, given, ball, speed, memory, command)
    if command[0] != 0.0 or command[1] != 0.0:
        velocity, theirs = (command[0], command[1]), movers[int(scene.mates) :]
        command[0], command[1] = slowed_in_play(me, velocity, theirs, _BRAKES * own.braking)


@compiled
def _kicks_loose(me: Robot, disputed: bool, time: float, memory: FloatArray) -> bool:
    if not disputed:
        return False
    if not 0.0 <= time - memory[HELD_SEEN] < _BROKEN:
        memory[HELD_SINCE] = time
    memory[HELD_SEEN] = time
    return bool(time - memory[HELD_SINCE] >= _PATIENCE * (1.0 if cos(me.heading) > 0.0 else 2.0))


@compiled
def _carried_far(ball: FloatArray, speed: float, alone: bool, memory: FloatArray) -> bool:
    if not alone:
        memory[TAKEN_X] = np.nan
        return False
    if np.isnan(memory[TAKEN_X]):
        memory[TAKEN_X], memory[TAKEN_Y] = ball[0], ball[1]
    way = hypot(ball[0] - memory[TAKEN_X], ball[1] - memory[TAKEN_Y])
    return bool(way + LETTING_GO * speed >= _CARRIED)


@compiled
def _settles(speed: float, time: float, memory: FloatArray) -> bool:
    """Return whether the ball that the robot has is still too fast to be turned with."""
    settled = bool(memory[SETTLED] > 0.0 and time - memory[HAD] <= _PAUSE) or speed < _SLOW
    memory[HAD], memory[SETTLED] = time, 1.0 if settled else 0.0
    return not settled


@compiled
def _carry(
    trip: Trip,
    scene: Scene,
    movers: Sequence[Mover],
    own: Limits,
    carrying: FloatArray,
    time: float,
    memory: FloatArray,
    command: FloatArray,
) -> None:
    """Do what ``DribbleTo`` does, to before the other goal."""
    me, limits, period = trip.me, carrying.view(LIMITS)[DRIBBLE, 0], scene.period
    trip.x, trip.y = scene.half_length - scene.area_depth - _BEFORE_AREA, 0.0
    trip.ball_gap, trip.avoids_robots = -1.0, 1.0
    x, y, there = waypoint_law(trip, (trip.x, trip.y), scene, movers, own, True)
    dx, dy = x - me.x, y - me.y
    way, gap = atan2(dy, dx), hypot(dx, dy)
    if abs(wrap_angle(way - memory[WAY])) > _OTHER_WAY and 0.0 <= time - memory[WAY_SINCE] < _STEADY:
        way = memory[WAY]
    else:
        memory[WAY], memory[WAY_SINCE] = way, time
    vx = vy = 0.0
    if gap > 0.0:
        ux, uy = dx / gap, dy / gap
        there, faster = min(there, limits.max_speed), limits.acceleration
        speed = approach_speed(
            gap + there * there / (2.0 * faster),
            ux * me.vx + uy * me.vy,
            limits.max_speed,
            faster,
            faster,
            period + 2.0 * own.reaction,
        )
        speed *= max(0.0, cos(wrap_angle(way - me.heading))) ** 2
        vx, vy = ux * speed, uy * speed
    omega = turn_law(me, way, own, limits, period)
    command[0], command[1], command[2] = command_law(
        me, (vx, vy), omega, own, limits, limits.max_speed, True, period
    )
    command[5] = 1.0


@compiled
def _comes(me: Robot, ball: FloatArray, speed: float) -> bool:
    ahead = (me.x - ball[0]) * ball[2] + (me.y - ball[1]) * ball[3]
    return bool(ahead >= _PASSED * speed)


@compiled
def _meet(
    trip: Trip,
    scene: Scene,
    movers: Sequence[Mover],
    own: Limits,
    given: Limits,
    ball: FloatArray,
    speed: float,
    rolling: float,
    command: FloatArray,
) -> None:
    """Get onto the way of a ball that comes, facing it: here if the robot is near, else where it is first."""
    ux, uy = ball[2] / speed, ball[3] / speed
    dx, dy = trip.me.x - ball[0], trip.me.y - ball[1]
    ahead = dx * ux + dy * uy
    if abs(dx * uy - dy * ux) < _ON_LINE and ahead > MOUTH:
        x, y = ball[0] + ahead * ux, ball[1] + ahead * uy
    else:
        me, one = trip.me, np.zeros((1, MOVER_SIZE))
        one[0, :4] = me.x, me.y, me.vx, me.vy
        one[0, 4:7] = given.max_speed, given.acceleration, given.braking
        met = meetings(one, ball, rolling, _SLIDE, _ROLL, scene.half_length, scene.half_width)
        x, y = met[0, 1] + MOUTH * ux, met[0, 2] + MOUTH * uy
    trip.x, trip.y, trip.heading = x, y, atan2(-dy, -dx)
    trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, -1.0, 1.0
    other = given.max_speed != own.max_speed
    command[0], command[1], command[2] = travel_law(trip, scene, movers, own, given, other, False)
    command[5] = 1.0


@compiled
def _get(
    trip: Trip,
    scene: Scene,
    movers: Sequence[Mover],
    own: Limits,
    given: Limits,
    ball: FloatArray,
    speed: float,
    memory: FloatArray,
    command: FloatArray,
) -> None:
    """Do what ``GoToBall`` and ``PickUpBall`` do."""
    me, period = trip.me, scene.period
    dx, dy = ball[0] - me.x, ball[1] - me.y
    bearing, gap = atan2(dy, dx), hypot(dx, dy)
    aside = abs(wrap_angle(bearing - me.heading))
    at_it = memory[AT_IT] > 0.0
    at_it = gap <= (LOST_DISTANCE if at_it else HANDOVER_DISTANCE) and aside <= (
        _FACING_STILL if at_it else _FACING
    )
    memory[AT_IT] = 1.0 if at_it else 0.0
    if at_it:
        closing = _CREEP * cos(min(2.0 * aside, 0.5 * pi))
        omega = turn_law(me, bearing, own, own, period)
        vx, vy = ball[2] + closing * cos(bearing), ball[3] + closing * sin(bearing)
        late = own.reaction > 0.0
        command[0], command[1], command[2] = command_law(
            me, (vx, vy), omega, own, own, own.max_speed, late, period
        )
        command[5] = 1.0
        return
    x, y = ball[0], ball[1]
    if speed >= _RESTS:
        for _ in range(2):
            mx, my = x - me.x, y - me.y
            way = hypot(mx, my)
            towards = (me.vx * mx + me.vy * my) / way if way > 0.0 else 0.0
            time = stop_time(
                max(0.0, way - _TOUCHING), towards, given.acceleration, given.braking, given.max_speed
            )
            rolled = way_in(time, speed, speed, _SLIDE, _ROLL)
            x, y = ball[0] + ball[2] / speed * rolled, ball[1] + ball[3] / speed * rolled
    towards = atan2(y - me.y, x - me.x)
    far = hypot(x - me.x, y - me.y) >= _TURN_DISTANCE
    trip.x, trip.y = beside((x, y), towards)
    trip.heading = roughly(me.heading, bearing, _LOOKING) if far else bearing
    trip.final_speed, trip.ball_gap, trip.avoids_robots = _ARRIVAL_SPEED, -1.0, 1.0
    other = given.max_speed != own.max_speed
    command[0], command[1], command[2] = travel_law(trip, scene, movers, own, given, other, False)
