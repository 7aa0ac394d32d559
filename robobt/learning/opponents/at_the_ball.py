"""What the play ``team_player`` does in open play as its team's attacker, compiled: get the ball and keep it.

Of the play's options these are here: ``KickLoose``, letting go of a ball carried too far, ``SettleBall``,
carrying the ball (straight at the other goal, where the play looks for the best place), ``GoToBall`` and
``PickUpBall``. A rolling ball is met where the team's plan meets it, but not caught as softly as
``ReceivePass`` does; nobody shoots or passes.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi, sin

import numpy as np

from robobt.motion.arrival import meetings
from robobt.motion.catch import MOUTH
from robobt.motion.dribbling import dribbling_limits
from robobt.motion.give_way import slowed_in_play
from robobt.motion.pilot import roughly
from robobt.motion.scene import (
    AVOID_ROBOTS,
    BALL_GAP,
    DEPTH,
    FINAL_SPEED,
    HALF_LENGTH,
    HALF_WIDTH,
    HEADING,
    PERIOD,
    TARGET_X,
    TARGET_Y,
)
from robobt.motion.speeds import (
    BRAKING,
    FORWARD,
    REACTION,
    TOP,
    approach_speed,
    command_numbers,
    numbers,
    stop_time,
    turn_rate_numbers,
)
from robobt.motion.way import travel_numbers, waypoint_numbers
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
    return np.array([numbers(dribbling_limits(_CARRYING)), numbers(braking)])


@compiled
def play_the_ball(
    task: FloatArray,
    scene: FloatArray,
    movers: FloatArray,
    mates: int,
    own: FloatArray,
    given: FloatArray,
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
        task: as of :func:`~robobt.motion.scene.task_of`, with the robot's state; changed.
        scene: as of :func:`~robobt.motion.scene.scene_of`.
        movers: as of :func:`~robobt.motion.arrival.movers_of`.
        mates: how many of them, the first, are the robot's team.
        own: what the robot can do, as of :func:`~robobt.motion.speeds.numbers`.
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
    state, speed = task[:TARGET_X], hypot(ball[2], ball[3])
    command[:] = 0.0
    if _kicks_loose(state, has and disputed, time, memory):
        command[0], command[3], command[4] = _FOLLOW, _LOOSE, 1.0
    elif _carried_far(ball, speed, has and not disputed, memory):
        along = cos(state[2]) * ball[2] + sin(state[2]) * ball[3]
        command[3] = max(0.0, along) + FASTER if ball[0] > 0.0 or cos(state[2]) > 0.0 else 0.0
    elif has and _settles(speed, time, memory):
        limits, period = carrying[BRAKE], scene[PERIOD]
        omega = turn_rate_numbers(state, state[2], own, limits, period)
        command[0], command[1], command[2] = command_numbers(
            state, 0.0, 0.0, omega, own, limits, True, period
        )
        command[5] = 1.0
    elif has:
        _carry(task, scene, movers, own, carrying, time, memory, command)
    elif speed >= _ROLLS and _comes(state, ball, speed):
        _meet(task, scene, movers, own, given, ball, speed, rolling, command)
    else:
        _get(task, scene, movers, own, given, ball, speed, memory, command)
    if command[0] != 0.0 or command[1] != 0.0:
        now = np.array((state[0], state[1], state[2], command[0], command[1]))
        command[0], command[1] = slowed_in_play(now, movers[mates:], _BRAKES * own[BRAKING])


@compiled
def _kicks_loose(state: FloatArray, disputed: bool, time: float, memory: FloatArray) -> bool:
    if not disputed:
        return False
    if not 0.0 <= time - memory[HELD_SEEN] < _BROKEN:
        memory[HELD_SINCE] = time
    memory[HELD_SEEN] = time
    return bool(time - memory[HELD_SINCE] >= _PATIENCE * (1.0 if cos(state[2]) > 0.0 else 2.0))


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
    task: FloatArray,
    scene: FloatArray,
    movers: FloatArray,
    own: FloatArray,
    carrying: FloatArray,
    time: float,
    memory: FloatArray,
    command: FloatArray,
) -> None:
    """Do what ``DribbleTo`` does, to before the other goal."""
    state, limits, period = task[:TARGET_X], carrying[DRIBBLE], scene[PERIOD]
    task[TARGET_X], task[TARGET_Y] = scene[HALF_LENGTH] - scene[DEPTH] - _BEFORE_AREA, 0.0
    task[BALL_GAP], task[AVOID_ROBOTS] = -1.0, 1.0
    x, y, there = waypoint_numbers(task, scene, movers, own, True)
    dx, dy = x - state[0], y - state[1]
    way, gap = atan2(dy, dx), hypot(dx, dy)
    if abs(wrap_angle(way - memory[WAY])) > _OTHER_WAY and 0.0 <= time - memory[WAY_SINCE] < _STEADY:
        way = memory[WAY]
    else:
        memory[WAY], memory[WAY_SINCE] = way, time
    vx = vy = 0.0
    if gap > 0.0:
        ux, uy = dx / gap, dy / gap
        there, faster = min(there, limits[TOP]), limits[FORWARD]
        speed = approach_speed(
            gap + there * there / (2.0 * faster),
            ux * state[3] + uy * state[4],
            limits[TOP],
            faster,
            faster,
            period + 2.0 * own[REACTION],
        )
        speed *= max(0.0, cos(wrap_angle(way - state[2]))) ** 2
        vx, vy = ux * speed, uy * speed
    omega = turn_rate_numbers(state, way, own, limits, period)
    command[0], command[1], command[2] = command_numbers(state, vx, vy, omega, own, limits, True, period)
    command[5] = 1.0


@compiled
def _comes(state: FloatArray, ball: FloatArray, speed: float) -> bool:
    ahead = (state[0] - ball[0]) * ball[2] + (state[1] - ball[1]) * ball[3]
    return bool(ahead >= _PASSED * speed)


@compiled
def _meet(
    task: FloatArray,
    scene: FloatArray,
    movers: FloatArray,
    own: FloatArray,
    given: FloatArray,
    ball: FloatArray,
    speed: float,
    rolling: float,
    command: FloatArray,
) -> None:
    """Get onto the way of a ball that comes, facing it: here if the robot is near, else where it is first."""
    ux, uy = ball[2] / speed, ball[3] / speed
    dx, dy = task[0] - ball[0], task[1] - ball[1]
    ahead = dx * ux + dy * uy
    if abs(dx * uy - dy * ux) < _ON_LINE and ahead > MOUTH:
        x, y = ball[0] + ahead * ux, ball[1] + ahead * uy
    else:
        me = np.array([[task[0], task[1], task[3], task[4], given[TOP], given[FORWARD], given[BRAKING]]])
        met = meetings(me, ball, rolling, _SLIDE, _ROLL, scene[HALF_LENGTH], scene[HALF_WIDTH])
        x, y = met[0, 1] + MOUTH * ux, met[0, 2] + MOUTH * uy
    task[TARGET_X], task[TARGET_Y], task[HEADING] = x, y, atan2(-dy, -dx)
    task[FINAL_SPEED], task[BALL_GAP], task[AVOID_ROBOTS] = 0.0, -1.0, 1.0
    other = given[TOP] != own[TOP]
    command[0], command[1], command[2] = travel_numbers(task, scene, movers, own, given, other, False)
    command[5] = 1.0


@compiled
def _get(
    task: FloatArray,
    scene: FloatArray,
    movers: FloatArray,
    own: FloatArray,
    given: FloatArray,
    ball: FloatArray,
    speed: float,
    memory: FloatArray,
    command: FloatArray,
) -> None:
    """Do what ``GoToBall`` and ``PickUpBall`` do."""
    state, period = task[:TARGET_X], scene[PERIOD]
    dx, dy = ball[0] - state[0], ball[1] - state[1]
    bearing, gap = atan2(dy, dx), hypot(dx, dy)
    aside = abs(wrap_angle(bearing - state[2]))
    at_it = memory[AT_IT] > 0.0
    at_it = gap <= (LOST_DISTANCE if at_it else HANDOVER_DISTANCE) and aside <= (
        _FACING_STILL if at_it else _FACING
    )
    memory[AT_IT] = 1.0 if at_it else 0.0
    if at_it:
        closing = _CREEP * cos(min(2.0 * aside, 0.5 * pi))
        omega = turn_rate_numbers(state, bearing, own, own, period)
        vx, vy = ball[2] + closing * cos(bearing), ball[3] + closing * sin(bearing)
        late = own[REACTION] > 0.0
        command[0], command[1], command[2] = command_numbers(state, vx, vy, omega, own, own, late, period)
        command[5] = 1.0
        return
    x, y = ball[0], ball[1]
    if speed >= _RESTS:
        for _ in range(2):
            mx, my = x - state[0], y - state[1]
            way = hypot(mx, my)
            towards = (state[3] * mx + state[4] * my) / way if way > 0.0 else 0.0
            time = stop_time(max(0.0, way - _TOUCHING), towards, given[FORWARD], given[BRAKING], given[TOP])
            rolled = way_in(time, speed, speed, _SLIDE, _ROLL)
            x, y = ball[0] + ball[2] / speed * rolled, ball[1] + ball[3] / speed * rolled
    towards = atan2(y - state[1], x - state[0])
    far = hypot(x - state[0], y - state[1]) >= _TURN_DISTANCE
    task[TARGET_X], task[TARGET_Y] = beside((x, y), towards)
    task[HEADING] = roughly(state[2], bearing, _LOOKING) if far else bearing
    task[FINAL_SPEED], task[BALL_GAP], task[AVOID_ROBOTS] = _ARRIVAL_SPEED, -1.0, 1.0
    other = given[TOP] != own[TOP]
    command[0], command[1], command[2] = travel_numbers(task, scene, movers, own, given, other, False)
