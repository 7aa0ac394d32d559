"""The league's physics over arrays: robot dynamics, ball friction, dribbler, kicker.

pymunk moves the bodies and resolves contacts; what it does not know is written
here once, compiled, for any number of arenas. One control tick of every arena is
one call of :func:`control_tick`.

The ball is modelled as Sumatra does, with the spin as a second velocity: ``spin``
is the velocity at which the ball would roll without sliding. While the two
differ the ball slides, losing speed and gaining spin; once they agree it rolls.
A ball kicked from rest then rolls from ``switch_share`` of its first speed on.
"""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from robobt.sim.chipmunk import call_each_body, call_step
from robobt.world.compiled import compiled

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

# Columns of a command.
VX, VY, OMEGA, KICK, ON_CONTACT, DRIBBLE = range(6)
COMMAND = 6

# Columns of a robot's parameters.
(
    MAX_SPEED,
    FORWARD_UP,
    FORWARD_DOWN,
    SIDE_UP,
    SIDE_DOWN,
    MAX_TURN,
    TURN_RATE,
) = range(7)
ROBOT_PARAMETERS = 7

# Columns of an arena's parameters.
(
    SLIDE,
    SPIN_GAIN,
    ROLL,
    STOP_SPEED,
    FACE,
    HALF_MOUTH,
    SENSOR,
    GLUE,
    PULL,
    SIDE,
    REACH,
    CENTRING,
    IDLE_HOLD,
    KICK_MAX,
    KICK_DAMPING,
    RECHARGE,
    BALL_R,
    ROBOT_R,
) = range(18)
ARENA_PARAMETERS = 18

_OVERLAP = 3e-4
"""How deep a swept ball is put into what it hits, so that the solver sees the contact [m]."""

_TOUCH = 2e-3
"""Gap between ball and robot that still counts as a touch [m]."""

_BACKING = -0.02
"""A robot slower than this along its heading backs away from the ball [m/s]."""

_GLUE_GAP = 2e-4
"""Gap at which a glued ball is carried, so that no contact brakes the robot [m]."""


@compiled
def _drive(row: FloatArray, command: FloatArray, p: FloatArray, dt: float) -> None:
    """Move a robot's velocity towards its command within its limits."""
    c, s = cos(row[2]), sin(row[2])
    wanted_x, wanted_y = command[VX], command[VY]
    speed = hypot(wanted_x, wanted_y)
    if speed > p[MAX_SPEED]:
        wanted_x *= p[MAX_SPEED] / speed
        wanted_y *= p[MAX_SPEED] / speed
    dx = c * wanted_x - s * wanted_y - row[3]
    dy = s * wanted_x + c * wanted_y - row[4]
    step = hypot(dx, dy)
    if step > 0.0:
        ahead = (c * dx + s * dy) / step
        aside = (c * dy - s * dx) / step
        if dx * row[3] + dy * row[4] < 0.0:
            along, across = p[FORWARD_DOWN], p[SIDE_DOWN]
        else:
            along, across = p[FORWARD_UP], p[SIDE_UP]
        # The wheels' limits form an ellipse in the robot's frame.
        most = dt / sqrt((ahead / along) ** 2 + (aside / across) ** 2)
        if step > most:
            dx *= most / step
            dy *= most / step
        row[3] += dx
        row[4] += dy
    turn = min(max(command[OMEGA], -p[MAX_TURN]), p[MAX_TURN]) - row[5]
    most = p[TURN_RATE] * dt
    row[5] += min(max(turn, -most), most)


@compiled
def _friction(velocity: FloatArray, spin: FloatArray, p: FloatArray, dt: float, move: FloatArray) -> None:
    """Let a free ball slide and roll for ``dt``; ``move`` receives its mean velocity."""
    start_x, start_y = velocity[0], velocity[1]
    left = dt
    moved_x = moved_y = 0.0
    slip_x, slip_y = velocity[0] - spin[0], velocity[1] - spin[1]
    slip = hypot(slip_x, slip_y)
    if slip > 1e-9:
        slip_x /= slip
        slip_y /= slip
        sliding = min(slip / (p[SLIDE] * (1.0 + p[SPIN_GAIN])), dt)
        loss = p[SLIDE] * sliding
        moved_x = (start_x - 0.5 * loss * slip_x) * sliding
        moved_y = (start_y - 0.5 * loss * slip_y) * sliding
        velocity[0] -= loss * slip_x
        velocity[1] -= loss * slip_y
        spin[0] += p[SPIN_GAIN] * loss * slip_x
        spin[1] += p[SPIN_GAIN] * loss * slip_y
        left = dt - sliding
    if left > 0.0:
        speed = hypot(velocity[0], velocity[1])
        if speed > 0.0:
            rolling = min(left, speed / p[ROLL])
            mean = (speed - 0.5 * p[ROLL] * rolling) * rolling / speed
            moved_x += velocity[0] * mean
            moved_y += velocity[1] * mean
            keep = (speed - p[ROLL] * rolling) / speed
            velocity[0] *= keep
            velocity[1] *= keep
        spin[0] = velocity[0]
        spin[1] = velocity[1]
        if hypot(velocity[0], velocity[1]) < p[STOP_SPEED]:
            velocity[0] = velocity[1] = spin[0] = spin[1] = 0.0
    move[0] = moved_x / dt
    move[1] = moved_y / dt


@compiled
def _enters(
    start: float, step: float, low: float, high: float, t_in: float, t_out: float
) -> tuple[float, float]:
    """Clip the time interval in which start + t * step lies in [low, high]."""
    if step == 0.0:
        if start < low or start > high:
            return 2.0, -1.0
        return t_in, t_out
    first, second = (low - start) / step, (high - start) / step
    if first > second:
        first, second = second, first
    return max(t_in, first), min(t_out, second)


@compiled
def _meets_disc(px: float, py: float, dx: float, dy: float, reach: float) -> tuple[float, float]:
    """When p + t * d enters and leaves the disc of radius ``reach`` around the origin; (2, -1) if never."""
    a = dx * dx + dy * dy
    b = px * dx + py * dy
    root = b * b - a * (px * px + py * py - reach * reach)
    if a <= 0.0 or root <= 0.0:
        return 2.0, -1.0
    root = sqrt(root)
    return (-b - root) / a, (-b + root) / a


@compiled
def _meets_box(x: float, y: float, dx: float, dy: float, box: FloatArray, radius: float) -> float:
    """When in (0, 1) a moving disc first meets a box, 1 if not: the box grown by a rounded rim."""
    first = 1.0
    t_in, t_out = _enters(x, dx, box[0] - radius, box[2] + radius, -1.0, 2.0)
    t_in, t_out = _enters(y, dy, box[1] - radius, box[3] + radius, t_in, t_out)
    if not (t_in <= t_out and t_in < 1.0 and t_out > 0.0):
        return first
    for wide, high in ((radius, 0.0), (0.0, radius)):
        t_in, t_out = _enters(x, dx, box[0] - wide, box[2] + wide, -1.0, 2.0)
        t_in, t_out = _enters(y, dy, box[1] - high, box[3] + high, t_in, t_out)
        if 0.0 < t_in <= t_out and t_in < first:
            first = t_in
    for corner_x in (box[0], box[2]):
        for corner_y in (box[1], box[3]):
            t_in, t_out = _meets_disc(x - corner_x, y - corner_y, dx, dy, radius)
            if 0.0 < t_in <= t_out and t_in < first:
                first = t_in
    return first


@compiled
def _meets_robot(x: float, y: float, dx: float, dy: float, p: FloatArray) -> float:
    """When in (0, 1) the moving ball first meets a robot, in the robot's frame, 1 if not."""
    radius, round_, face = p[BALL_R], p[ROBOT_R], p[FACE]
    half = sqrt(round_ * round_ - face * face)
    first = 1.0
    if dx < 0.0 and x > face + radius:
        t = (x - face - radius) / -dx
        if t < first and abs(y + t * dy) <= half:
            first = t
    t_in, t_out = _meets_disc(x, y, dx, dy, round_ + radius)
    # The disc counts only where it is not cut off.
    if 0.0 < t_in <= t_out and t_in < first and x + t_in * dx <= face * (round_ + radius) / round_:
        first = t_in
    for corner in (half, -half):
        t_in, t_out = _meets_disc(x - face, y - corner, dx, dy, radius)
        if 0.0 < t_in <= t_out and t_in < first:
            first = t_in
    return first


@compiled
def _sweep(
    rows: FloatArray,
    first: int,
    robots: int,
    walls: FloatArray,
    origin: FloatArray,
    move: FloatArray,
    p: FloatArray,
    dt: float,
) -> float:
    """Share of the step after which a fast ball first meets a robot or a wall, 1 without one.

    At 6.5 m/s and 5 ms the ball moves 33 mm a step, more than its radius and
    than the goal's walls are thick: a solver that looks only at where the ball
    ends up would let it through.
    """
    ball = rows[first + robots]
    radius = p[BALL_R]
    share = 1.0
    for i in range(robots):
        row = rows[first + i]
        px, py = ball[0] - row[0], ball[1] - row[1]
        dx, dy = (move[0] - row[3]) * dt, (move[1] - row[4]) * dt
        reach = p[ROBOT_R] + radius + hypot(dx, dy)
        if px * px + py * py > reach * reach or px * dx + py * dy >= 0.0:
            continue
        c, s = cos(row[2]), sin(row[2])
        share = min(
            share, _meets_robot(c * px + s * py, c * py - s * px, c * dx + s * dy, c * dy - s * dx, p)
        )
    x, y = ball[0] - origin[0], ball[1] - origin[1]
    dx, dy = move[0] * dt, move[1] * dt
    for k in range(walls.shape[0]):
        share = min(share, _meets_box(x, y, dx, dy, walls[k], radius))
    return share


@compiled
def _hold(
    ball: FloatArray,
    velocity: FloatArray,
    robot: FloatArray,
    p: FloatArray,
    most: float,
    dt: float,
    pull: FloatArray,
) -> None:
    """Add the limited acceleration with which a dribbler draws the ball to its place."""
    c, s = cos(robot[2]), sin(robot[2])
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    ahead = c * px + s * py
    aside = c * py - s * px
    place = p[FACE] + p[BALL_R]
    # Velocity of the robot's point under the ball, in the robot's frame.
    along = c * robot[3] + s * robot[4] - robot[5] * aside
    across = c * robot[4] - s * robot[3] + robot[5] * ahead
    ball_along = c * velocity[0] + s * velocity[1]
    ball_across = c * velocity[1] - s * velocity[0]
    # A ball carried on a circle needs the centripetal part on top.
    want_along = (along + (place - ahead) / p[CENTRING] - ball_along) / dt
    want_along -= robot[5] * robot[5] * ahead
    want_across = (across - aside / p[CENTRING] - ball_across) / dt
    limit_pull, limit_side = p[PULL], p[SIDE]
    if most >= 0.0:
        limit_pull = limit_side = most
    want_along = min(max(want_along, -limit_pull), 0.0)
    want_across = min(max(want_across, -limit_side), limit_side)
    pull[0] += c * want_along - s * want_across
    pull[1] += s * want_along + c * want_across


@compiled
def _in_mouth(ball: FloatArray, robot: FloatArray, p: FloatArray, depth: float) -> bool:
    """Whether the ball lies ahead of the flat front, within the mouth and ``depth`` of it."""
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    reach = p[FACE] + p[BALL_R] + depth
    if px * px + py * py > reach * reach + p[HALF_MOUTH] * p[HALF_MOUTH]:
        return False
    c, s = cos(robot[2]), sin(robot[2])
    ahead = c * px + s * py
    aside = c * py - s * px
    return bool(0.0 < ahead <= reach and abs(aside) <= p[HALF_MOUTH])


@compiled
def _kick(velocity: FloatArray, spin: FloatArray, robot: FloatArray, speed: float, p: FloatArray) -> None:
    """Send the ball along the heading; its sideways velocity stays, its spin is lost."""
    c, s = cos(robot[2]), sin(robot[2])
    forward = c * velocity[0] + s * velocity[1]
    sideways = c * velocity[1] - s * velocity[0]
    forward = speed - p[KICK_DAMPING] * forward
    fast = hypot(forward, sideways)
    if fast > p[KICK_MAX]:
        forward *= p[KICK_MAX] / fast
        sideways *= p[KICK_MAX] / fast
    velocity[0] = c * forward - s * sideways
    velocity[1] = s * forward + c * sideways
    spin[0] = spin[1] = 0.0


@compiled
def _carry(ball: FloatArray, robot: FloatArray, p: FloatArray, dt: float, move: FloatArray) -> None:
    """The velocity that keeps the ball where it sits in the mouth while the robot moves."""
    c, s = cos(robot[2]), sin(robot[2])
    px, py = ball[0] - robot[0], ball[1] - robot[1]
    ahead = p[FACE] + p[BALL_R] + _GLUE_GAP
    aside = c * py - s * px
    turned = robot[2] + robot[5] * dt
    c, s = cos(turned), sin(turned)
    x = robot[0] + robot[3] * dt + c * ahead - s * aside
    y = robot[1] + robot[4] * dt + s * ahead + c * aside
    move[0] = (x - ball[0]) / dt
    move[1] = (y - ball[1]) / dt


@compiled
def _in_a_wall(x: float, y: float, walls: FloatArray, radius: float) -> bool:
    """Whether a disc reaches into one of the boxes."""
    for k in range(walls.shape[0]):
        beside = max(walls[k, 0] - x, x - walls[k, 2], 0.0)
        above = max(walls[k, 1] - y, y - walls[k, 3], 0.0)
        if beside * beside + above * above < radius * radius:
            return True
    return False


@compiled
def _note_touch(rows: FloatArray, first: int, robots: int, p: FloatArray, touch: IntArray, a: int) -> None:
    """Remember who touches the ball; of several, one that did not touch it before."""
    ball = rows[first + robots]
    found = -1
    for i in range(robots):
        row = rows[first + i]
        px, py = ball[0] - row[0], ball[1] - row[1]
        reach = p[ROBOT_R] + p[BALL_R] + _TOUCH
        if px * px + py * py > reach * reach:
            continue
        if cos(row[2]) * px + sin(row[2]) * py > p[FACE] + p[BALL_R] + _TOUCH:
            continue
        if found < 0 or found == touch[a]:
            found = i
    if found >= 0:
        touch[a] = found


@compiled
def _report(row: FloatArray, origin: FloatArray, out: FloatArray) -> None:
    """A robot's row relative to its arena, heading in (-pi, pi]."""
    out[0] = row[0] - origin[0]
    out[1] = row[1] - origin[1]
    heading = row[2] % (2.0 * pi)
    out[2] = heading - 2.0 * pi if heading > pi else heading
    out[3] = row[3]
    out[4] = row[4]
    out[5] = row[5]


@compiled
def report(
    rows: FloatArray,
    origins: FloatArray,
    arena_parameters: FloatArray,
    ball_velocity: FloatArray,
    contact: BoolArray,
    robots_out: FloatArray,
    balls_out: FloatArray,
) -> None:
    """Fill the outputs of :func:`control_tick` from the rows."""
    arenas, robots = contact.shape
    for a in range(arenas):
        first = a * (robots + 1)
        ball = rows[first + robots]
        for i in range(robots):
            row = rows[first + i]
            p = arena_parameters[a]
            contact[a, i] = _in_mouth(ball, row, p, p[SENSOR])
            _report(row, origins[a], robots_out[a, i])
        balls_out[a, 0] = ball[0] - origins[a, 0]
        balls_out[a, 1] = ball[1] - origins[a, 1]
        balls_out[a, 2] = ball_velocity[a, 0]
        balls_out[a, 3] = ball_velocity[a, 1]


@compiled
def control_tick(
    handles: NDArray[np.uint64],
    cursor: NDArray[np.int32],
    rows: FloatArray,
    origins: FloatArray,
    walls: FloatArray,
    arena_parameters: FloatArray,
    robot_parameters: FloatArray,
    old: FloatArray,
    new: FloatArray,
    switch: IntArray,
    sub_steps: int,
    dt: float,
    ball_velocity: FloatArray,
    ball_spin: FloatArray,
    cooldown: FloatArray,
    contact: BoolArray,
    touch: IntArray,
    kicked: BoolArray,
    robots_out: FloatArray,
    balls_out: FloatArray,
    history: FloatArray,
) -> None:
    """Advance every arena by one control period of ``sub_steps`` physics steps.

    Args:
        handles, cursor, rows: of the :class:`~robobt.sim.chipmunk.BodyBuffer`.
        origins: (N, 2) centre of each arena in the space [m].
        walls: (W, 4) boxes x0, y0, x1, y1 relative to an arena's centre [m].
        arena_parameters: (N, ARENA_PARAMETERS); robot_parameters: (N, R, ROBOT_PARAMETERS).
        old, new: (N, R, COMMAND) commands before and after each arena's sub-step
            ``switch``, (N,) (how a command delay works); a fired kick is set to 0 in place.
        ball_velocity, ball_spin: (N, 2), kept between calls [m/s].
        cooldown: (N, R) time until a kicker is ready again [s].
        contact: (N, R) out: ball in the mouth. touch: (N,) last robot to touch, -1 none.
        kicked: (N, R) out: kicks fired in this call.
        robots_out: (N, R, 6), balls_out: (N, 4) out: states relative to the arena.
        history: (sub_steps or 0, N, R + 1, 6) out: rows after every sub-step.
    """
    arenas, robots = contact.shape
    width = robots + 1
    move = np.zeros(2)
    pull = np.zeros(2)
    target = np.zeros((arenas, 2))
    kicked[:] = False
    for step in range(sub_steps):
        for a in range(arenas):
            first = a * width
            p = arena_parameters[a]
            ball = rows[first + robots]
            velocity = ball_velocity[a]
            spin = ball_spin[a]
            commands = new[a] if step >= switch[a] else old[a]
            glued = -1
            held = fired = False
            pull[0] = pull[1] = 0.0
            for i in range(robots):
                command = commands[i]
                robot = rows[first + i]
                _drive(robot, command, robot_parameters[a, i], dt)
                if cooldown[a, i] > 0.0:
                    cooldown[a, i] -= dt
                    continue
                if command[KICK] > 0.0:
                    if _in_mouth(ball, robot, p, p[SENSOR]):
                        _kick(velocity, spin, robot, command[KICK], p)
                        command[KICK] = 0.0
                        kicked[a, i] = fired = True
                        touch[a] = i
                        cooldown[a, i] = p[RECHARGE]
                        glued = -1
                        held = False
                        pull[0] = pull[1] = 0.0
                        continue
                    if command[ON_CONTACT] == 0.0:
                        command[KICK] = 0.0
                if fired:
                    continue
                if command[DRIBBLE] > 0.0:
                    if _in_mouth(ball, robot, p, p[REACH]):
                        held = True
                        if p[GLUE] > 0.0:
                            glued = i
                        else:
                            _hold(ball, velocity, robot, p, -1.0, dt, pull)
                elif (
                    p[IDLE_HOLD] > 0.0
                    and cos(robot[2]) * robot[3] + sin(robot[2]) * robot[4] > _BACKING
                    and _in_mouth(ball, robot, p, p[REACH])
                ):
                    held = True
                    _hold(ball, velocity, robot, p, p[IDLE_HOLD], dt, pull)
            if glued >= 0:
                _carry(ball, rows[first + glued], p, dt, move)
                x = ball[0] + move[0] * dt - origins[a, 0]
                y = ball[1] + move[1] * dt - origins[a, 1]
                if _in_a_wall(x, y, walls, p[BALL_R]):
                    # Glue knows no contacts and would carry the ball through; force gives way.
                    _hold(ball, velocity, rows[first + glued], p, -1.0, dt, pull)
                    glued = -1
            if glued >= 0:
                velocity[0] = spin[0] = move[0]
                velocity[1] = spin[1] = move[1]
            elif held:
                velocity[0] += pull[0] * dt
                velocity[1] += pull[1] * dt
                move[0] = spin[0] = velocity[0]
                move[1] = spin[1] = velocity[1]
            else:
                _friction(velocity, spin, p, dt, move)
            if glued < 0 and hypot(move[0], move[1]) * dt > 0.05 * p[BALL_R]:
                share = _sweep(rows, first, robots, walls, origins[a], move, p, dt)
                if share < 1.0:
                    length = hypot(move[0], move[1]) * dt
                    back = max(1.0 - share - _OVERLAP / length, 0.0)
                    ball[0] -= move[0] * dt * back
                    ball[1] -= move[1] * dt * back
            ball[3] = target[a, 0] = move[0]
            ball[4] = target[a, 1] = move[1]
        cursor[0] = 0
        call_each_body(handles[1], handles[4], handles[3], handles[5])
        call_step(handles[0], handles[4], dt)
        cursor[0] = 0
        call_each_body(handles[1], handles[4], handles[2], handles[5])
        for a in range(arenas):
            first = a * width
            p = arena_parameters[a]
            ball = rows[first + robots]
            # What contacts did to the mean velocity, they did to the velocity.
            ball_velocity[a, 0] += ball[3] - target[a, 0]
            ball_velocity[a, 1] += ball[4] - target[a, 1]
            _note_touch(rows, first, robots, p, touch, a)
            if history.shape[0] > 0:
                for i in range(width):
                    for k in range(6):
                        history[step, a, i, k] = rows[first + i, k]
                history[step, a, robots, 3] = ball_velocity[a, 0]
                history[step, a, robots, 4] = ball_velocity[a, 1]
    report(rows, origins, arena_parameters, ball_velocity, contact, robots_out, balls_out)
