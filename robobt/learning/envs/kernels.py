"""One tick of the environments over all arenas, compiled.

What an observation holds is defined in :mod:`robobt.world.features`, what an
action means in :mod:`robobt.models.actions`: the functions here are the same
formulas, fused with the rewards, and tests hold them to those definitions.
"""

from __future__ import annotations

from math import atan2, cos, exp, hypot, isfinite, pi, sin, sqrt

from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.sim.kernels import DRIBBLE, KICK, OMEGA, VX, VY
from robobt.world.compiled import compiled

# Columns of an arena's counters.
TICKS, HELD, KICK_TICK, PRESSED = range(4)
COUNTERS = 4

# Columns of an arena's sums.
REWARD, WAY, LAST_X, LAST_Y = range(4)
SUMS = 4

# Go-To-Ball's rule and reward.
(G_RULE, G_DISTANCE, G_ANGLE, G_HOLD, G_SPEED, G_LIMIT) = range(6)
(G_W_CONTACT, G_W_DISTANCE, G_W_ORIENTATION, G_W_TIME) = range(6, 10)
G_PARAMETERS = 10
DISTANCE_RULE, FACING_RULE, INFRARED_RULE, HELD_RULE = range(4)

# Shoot's field, ends and reward.
(S_LINE, S_POST, S_HALF_WIDTH, S_AREA_X, S_AREA_Y, S_LIMIT, S_LOST) = range(7)
(S_W_FACE, S_INSIDE, S_W_KICK, S_FIRED, S_W_WAITING, S_W_GOAL, S_W_TIME) = range(7, 14)
S_PARAMETERS = 14

ROBOT_BACK_LIMIT = -0.2
"""A robot farther back than this ends a Shoot episode [m]. Source: the authors' code."""

_BELL = 1.0 / sqrt(2.0 * pi)


@compiled
def _wrap(angle: float) -> float:
    wrapped = angle % (2.0 * pi)
    return wrapped - 2.0 * pi if wrapped > pi else wrapped


@compiled
def drive_commands(
    actions: FloatArray, max_speed: float, max_turn: float, dribbler: float, commands: FloatArray
) -> bool:
    """Fill (n, 1, 6) commands from (n, 3) actions; False where one is not finite."""
    for a in range(actions.shape[0]):
        vx = min(max(actions[a, 0], -1.0), 1.0)
        vy = min(max(actions[a, 1], -1.0), 1.0)
        omega = min(max(actions[a, 2], -1.0), 1.0)
        if not isfinite(actions[a, 0] + actions[a, 1] + actions[a, 2]):
            return False
        norm = max(hypot(vx, vy), 1.0)
        command = commands[a, 0]
        command[:] = 0.0
        command[VX] = max_speed * vx / norm
        command[VY] = max_speed * vy / norm
        command[OMEGA] = max_turn * omega
        command[DRIBBLE] = dribbler
    return True


@compiled
def kick_commands(
    actions: FloatArray,
    max_turn: float,
    kick_speed: float,
    dribbler: float,
    factors: FloatArray,
    commands: FloatArray,
) -> bool:
    """Fill (n, 1, 6) commands from (n, 2) actions; False where one is not finite.

    ``factors`` (n,) multiply the speed of kicks.
    """
    for a in range(actions.shape[0]):
        if not isfinite(actions[a, 0] + actions[a, 1]):
            return False
        command = commands[a, 0]
        command[:] = 0.0
        command[OMEGA] = max_turn * min(max(actions[a, 0], -1.0), 1.0)
        if actions[a, 1] > 0.0:
            command[KICK] = kick_speed * factors[a]
        command[DRIBBLE] = dribbler
    return True


@compiled
def observe_go_to_ball(robots: FloatArray, balls: FloatArray, observation: FloatArray) -> None:
    """:func:`robobt.world.features.go_to_ball_observation` of (n, 1, 6) and (n, 4) into (n, 6)."""
    for a in range(balls.shape[0]):
        r, b, o = robots[a, 0], balls[a], observation[a]
        c, s = cos(r[2]), sin(r[2])
        dx, dy = b[0] - r[0], b[1] - r[1]
        gap = hypot(dx, dy)
        if gap > 0.0:
            o[0] = (c * dy - s * dx) / gap
            o[1] = (c * dx + s * dy) / gap
        else:
            o[0] = 0.0
            o[1] = 1.0
        o[2] = gap
        o[3] = c * r[3] + s * r[4]
        o[4] = c * r[4] - s * r[3]
        o[5] = r[5]


@compiled
def observe_shoot(
    robots: FloatArray, balls: FloatArray, line: float, post: float, observation: FloatArray
) -> None:
    """:func:`robobt.world.features.shoot_observation` of (n, 1, 6) and (n, 4) into (n, 10)."""
    for a in range(balls.shape[0]):
        r, b, o = robots[a, 0], balls[a], observation[a]
        c, s = cos(r[2]), sin(r[2])
        dx, dy = b[0] - r[0], b[1] - r[1]
        to_upper = atan2(post - r[1], line - r[0]) - r[2]
        to_lower = atan2(-post - r[1], line - r[0]) - r[2]
        o[0] = c * dx + s * dy
        o[1] = c * dy - s * dx
        o[2] = c * b[2] + s * b[3]
        o[3] = c * b[3] - s * b[2]
        o[4] = r[5]
        o[5] = hypot(line - r[0], r[1])
        o[6] = sin(to_upper)
        o[7] = cos(to_upper)
        o[8] = sin(to_lower)
        o[9] = cos(to_lower)


@compiled
def _go_on(robot: FloatArray, counters: IntArray, sums: FloatArray) -> None:
    """Count a tick and the way driven in it."""
    counters[TICKS] += 1
    sums[WAY] += hypot(robot[0] - sums[LAST_X], robot[1] - sums[LAST_Y])
    sums[LAST_X] = robot[0]
    sums[LAST_Y] = robot[1]


@compiled
def judge_go_to_ball(
    robots: FloatArray,
    balls: FloatArray,
    contact: BoolArray,
    commands: FloatArray,
    p: FloatArray,
    counters: IntArray,
    sums: FloatArray,
    reward: FloatArray,
    terminated: BoolArray,
    truncated: BoolArray,
    success: BoolArray,
) -> bool:
    """Rewards and ends of Go-To-Ball after a tick; whether any episode ended.

    Args:
        robots, balls, contact: the arenas' true state.
        commands: what the robots were told to do in this tick.
        p: (G_PARAMETERS,).
        counters: (n, COUNTERS), sums: (n, SUMS), kept from tick to tick.
        reward, terminated, truncated, success: (n,) out.
    """
    ended = False
    for a in range(balls.shape[0]):
        r, b = robots[a, 0], balls[a]
        _go_on(r, counters[a], sums[a])
        dx, dy = b[0] - r[0], b[1] - r[1]
        gap = hypot(dx, dy)
        off = abs(_wrap(atan2(dy, dx) - r[2]))
        if contact[a, 0] and commands[a, 0, DRIBBLE] > 0.0:
            counters[a, HELD] += 1
        else:
            counters[a, HELD] = 0
        if p[G_RULE] == DISTANCE_RULE:
            reached = gap <= p[G_DISTANCE]
        elif p[G_RULE] == FACING_RULE:
            reached = gap <= p[G_DISTANCE] and off <= p[G_ANGLE]
        elif p[G_RULE] == INFRARED_RULE:
            reached = contact[a, 0]
        else:
            reached = counters[a, HELD] >= p[G_HOLD]
        reached = reached and hypot(r[3], r[4]) <= p[G_SPEED]
        value = p[G_W_DISTANCE] * (5.0 * _BELL * exp(-0.5 * gap * gap) - 2.0)
        value += p[G_W_ORIENTATION] * _BELL * exp(-2.0 * off / (pi * pi))
        value -= p[G_W_TIME]
        if reached:
            value += p[G_W_CONTACT]
        reward[a] = value
        sums[a, REWARD] += value
        terminated[a] = success[a] = reached
        truncated[a] = not reached and counters[a, TICKS] >= p[G_LIMIT]
        ended = ended or reached or truncated[a]
    return ended


@compiled
def judge_shoot(
    robots: FloatArray,
    balls: FloatArray,
    kicked: BoolArray,
    actions: FloatArray,
    p: FloatArray,
    counters: IntArray,
    sums: FloatArray,
    reward: FloatArray,
    terminated: BoolArray,
    truncated: BoolArray,
    success: BoolArray,
) -> bool:
    """Rewards and ends of Shoot after a tick; whether any episode ended. Arguments as above."""
    ended = False
    for a in range(balls.shape[0]):
        r, b = robots[a, 0], balls[a]
        _go_on(r, counters[a], sums[a])
        fired = kicked[a, 0]
        if fired and counters[a, KICK_TICK] < 0:
            counters[a, KICK_TICK] = counters[a, TICKS]
        counts = fired if p[S_FIRED] > 0.0 else actions[a, 1] > 0.0
        first = counts and counters[a, PRESSED] == 0
        if counts:
            counters[a, PRESSED] = 1
        goal = b[0] > p[S_LINE] and abs(b[1]) < p[S_POST]
        out = b[0] > p[S_LINE] or b[0] < 0.0 or abs(b[1]) > p[S_HALF_WIDTH]
        out = out or r[0] < ROBOT_BACK_LIMIT or abs(r[1]) > p[S_HALF_WIDTH]
        out = out or (r[0] > p[S_AREA_X] and abs(r[1]) < p[S_AREA_Y])
        if counters[a, KICK_TICK] < 0 and hypot(b[0] - r[0], b[1] - r[1]) > p[S_LOST]:
            out = True
        if goal:
            value = p[S_W_GOAL]
        elif out:
            value = 0.0
        else:
            upper = atan2(p[S_POST] - r[1], p[S_LINE] - r[0])
            lower = atan2(-p[S_POST] - r[1], p[S_LINE] - r[0])
            alpha = _wrap(upper - lower)
            beta = max(abs(_wrap(upper - r[2])), abs(_wrap(lower - r[2])))
            facing = alpha >= beta
            value = p[S_W_FACE] * (alpha - beta) * hypot(b[2], b[3]) - p[S_W_TIME]
            if facing:
                value -= p[S_W_FACE] * (1.0 - p[S_INSIDE]) * (alpha - beta) * hypot(b[2], b[3])
                if first:
                    value += p[S_W_KICK]
            if not facing or counters[a, PRESSED] == 0:
                value -= p[S_W_WAITING]
        reward[a] = value
        sums[a, REWARD] += value
        terminated[a] = goal or out
        success[a] = goal
        truncated[a] = not terminated[a] and counters[a, TICKS] >= p[S_LIMIT]
        ended = ended or terminated[a] or truncated[a]
    return ended
