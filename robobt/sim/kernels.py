"""One control tick of the league's physics, over arrays and any number of arenas.

What moves the bodies and resolves contacts is pymunk, or in many arenas what does the same over arrays
(:mod:`robobt.sim.contacts.solver`); what neither knows is written once,
compiled: how robots and ball move (:mod:`robobt.sim.motion`), a ball in the air
(:mod:`robobt.sim.flight`), dribbler and kicker (:mod:`robobt.sim.mouth`), and contacts
within a step (:mod:`robobt.sim.sweep`).

numba keeps compiled code by the file of the function that is called: after an edit in
one of those modules, this one has to be touched for it to be compiled anew.
"""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from robobt.sim.chipmunk import call_each_body, call_step, load_bodies, store_bodies
from robobt.sim.columns import (
    ANGLE,
    BALL_R,
    CORE,
    DRIBBLE,
    GLUE,
    IDLE_HOLD,
    KICK,
    MASS,
    ON_CONTACT,
    REACH,
    RECHARGE,
    RISE,
    ROLLER,
    SENSOR,
    Z,
)
from robobt.sim.contacts.solver import collide
from robobt.sim.contacts.touching import CLEAR_X, CLEAR_Y, CONTACT
from robobt.sim.flight import fly, pass_over
from robobt.sim.hinge import take_hold, tie
from robobt.sim.motion import drive, friction
from robobt.sim.mouth import carry, hold, in_mouth, keeps, kick, let_in
from robobt.sim.reports import BoolArray, IntArray, note_touch, report
from robobt.sim.roller import CONTACTS, SCRATCH, roll
from robobt.sim.shell import drag, meet
from robobt.sim.sweep import in_a_wall, sweep
from robobt.sim.wheels import HELD, drive_wheels
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray
from robobt.world.state import RECEIVED_HEIGHT, ROBOT_HEIGHT

_OVERLAP = 3e-4
"""How deep a swept ball is put into what it hits, so that the solver sees the contact [m]."""

_BACKING = -0.02
"""A robot slower than this along its heading backs away from the ball [m/s]."""

_ELSEWHERE = 1e4
"""Coordinate of the place, clear of the arena, where its space has the balls that fly high [m]."""


Scratch = tuple[FloatArray, FloatArray, FloatArray, FloatArray, NDArray[np.int64], FloatArray]


def scratch(robots: int, pairs: int) -> Scratch:
    """Return what :func:`control_tick` works with, for arenas of so many robots and pairs that may touch."""
    return (
        np.zeros((6, 3)),
        np.zeros(robots),
        np.zeros((robots, CONTACTS, SCRATCH)),
        np.zeros((pairs, CONTACT)),
        np.zeros((pairs, 3), dtype=np.int64),
        np.zeros((robots + 2, 8)),
    )


@compiled_lean
def control_tick(
    small: FloatArray,
    driven: FloatArray,
    contacts: FloatArray,
    meetings: FloatArray,
    who: NDArray[np.int64],
    speeds: FloatArray,
    calls: NDArray[np.uint64],
    handles: NDArray[np.uint64],
    bodies: NDArray[np.uint64],
    cursors: NDArray[np.int32],
    solver: FloatArray,
    materials: FloatArray,
    edges: FloatArray,
    parts: FloatArray,
    inverse: FloatArray,
    bias: FloatArray,
    memory: FloatArray,
    clock: IntArray,
    rows: FloatArray,
    walls: FloatArray,
    arena_parameters: FloatArray,
    robot_parameters: FloatArray,
    wheel_parameters: FloatArray,
    wheels: FloatArray,
    old: FloatArray,
    new: FloatArray,
    switch: IntArray,
    sub_steps: int,
    dt: float,
    ball_velocity: FloatArray,
    ball_spin: FloatArray,
    ball_twist: FloatArray,
    flight: FloatArray,
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
        small: of :func:`scratch`.
        driven: likewise.
        contacts: likewise.
        meetings: likewise.
        who: likewise.
        speeds: likewise.
        calls: of the :class:`~robobt.sim.chipmunk.BodyBuffer`.
        handles: of the same, none if no pymunk is to be called.
        bodies: of the same.
        cursors: of the same.
        solver: numbers of the :class:`~robobt.sim.contacts.solver.Contacts`, which take pymunk's place then.
        materials: walls of the same.
        edges: of the same.
        parts: of the same.
        inverse: of the same.
        bias: of the same.
        memory: of the same.
        clock: of the same.
        rows: of robots and balls, an arena's one after the other.
        walls: (W, 4) boxes x0, y0, x1, y1 relative to an arena's centre [m].
        arena_parameters: (N, ARENA_PARAMETERS).
        robot_parameters: (N, R, ROBOT_PARAMETERS).
        wheel_parameters: (N, WHEEL_PARAMETERS), a mass of 0 for robots without wheels.
        wheels: (N, R, WHEEL_STATE), kept between calls.
        old: (N, R, COMMAND) commands before each arena's sub-step ``switch``, which is how
            a command delay works; a fired kick is set to 0 in place.
        new: (N, R, COMMAND) commands from that sub-step on.
        switch: (N,) sub-step from which ``new`` is in force.
        sub_steps: physics steps in this call.
        dt: length of each [s].
        ball_velocity: (N, 2), kept between calls [m/s].
        ball_spin: (N, 2), kept between calls [m/s].
        ball_twist: (N, 1) turning about the vertical, kept between calls [rad/s].
        flight: (N, FLIGHT) of the balls, kept between calls [m, m/s, touch-downs].
        cooldown: (N, R) time until a kicker is ready again [s].
        contact: (N, R) out: ball in the mouth.
        touch: (N,) last robot to touch the ball, -1 before the first.
        kicked: (N, R) out: kicks fired in this call.
        robots_out: (N, R, 6) out: states relative to the arena.
        balls_out: (N, 4) out: likewise.
        history: (sub_steps or 0, N, R + 1, 6) out: rows after every sub-step; a ball's has its
            height and the rate of that where a robot's has the heading and its rate.
    """
    arenas, robots = contact.shape
    width, stride = robots + 1, len(rows) // arenas
    # ``aloft`` is where a ball is that passes over everything, for the time of a step.
    move, pull, met, hit, target, aloft = small[0], small[1], small[2], small[3], small[4], small[5]
    by_pymunk = handles.shape[0] > 0
    kicked[:] = False
    for a in range(arenas):
        first = a * stride
        p = arena_parameters[a]
        ball = rows[first + robots]
        velocity, spin, twist, air = ball_velocity[a], ball_spin[a], ball_twist[a], flight[a]
        high = False
        for step in range(sub_steps):
            low = air[Z] < RECEIVED_HEIGHT
            high = False
            commands = new[a] if step >= switch[a] else old[a]
            glued = -1
            held = fired = shared = False
            pull[0] = pull[1] = 0.0
            for i in range(robots):
                driven[i] = 0.0
                command = commands[i]
                robot = rows[first + i]
                begins = False
                if wheel_parameters[a, MASS] > 0.0:
                    begins = drive_wheels(
                        robot, command, robot_parameters[a, i], wheel_parameters[a], wheels[a, i], dt
                    )
                else:
                    drive(robot, command, robot_parameters[a, i], dt)
                if cooldown[a, i] > 0.0:
                    cooldown[a, i] -= dt
                    continue
                if command[KICK] > 0.0:
                    if low and command[ON_CONTACT] > 0.0 and p[GLUE] == 0.0 and p[ROLLER] == 0.0:
                        let_in(ball, velocity, robot, p, dt)
                    if low and in_mouth(ball, robot, p, p[SENSOR]):
                        kick(velocity, spin, air, robot, command[KICK], command[ANGLE], p)
                        command[KICK] = 0.0
                        kicked[a, i] = fired = True
                        touch[a] = i
                        cooldown[a, i] = p[RECHARGE]
                        wheels[a, i, HELD] = 0.0
                        glued = -1
                        held = False
                        pull[0] = pull[1] = 0.0
                        continue
                    if command[ON_CONTACT] == 0.0 and p[ROLLER] == 0.0:
                        command[KICK] = 0.0
                if fired or not low:
                    continue
                if p[CORE] > 0.0:
                    if begins:
                        holds = command[DRIBBLE] > 0.0 and keeps(ball, robot, p, wheels[a, i, HELD] > 0.0)
                        if not holds:
                            wheels[a, i, HELD] = 0.0
                        elif wheels[a, i, HELD] == 0.0:
                            take_hold(ball, robot, wheels[a, i])
                    if wheels[a, i, HELD] > 0.0:
                        held = True
                        shared |= glued >= 0
                        glued = i
                elif p[ROLLER] > 0.0:
                    driven[i] = command[DRIBBLE]
                elif command[DRIBBLE] > 0.0:
                    if in_mouth(ball, robot, p, p[REACH]):
                        held = True
                        if p[GLUE] > 0.0:
                            glued = i
                        else:
                            hold(ball, velocity, robot, p, -1.0, dt, pull)
                elif (
                    p[IDLE_HOLD] > 0.0
                    and cos(robot[2]) * robot[3] + sin(robot[2]) * robot[4] > _BACKING
                    and in_mouth(ball, robot, p, p[REACH])
                ):
                    held = True
                    hold(ball, velocity, robot, p, p[IDLE_HOLD], dt, pull)
            if shared and glued >= 0:
                tie(rows, first, glued, wheels[a], wheel_parameters[a], dt)
            if glued >= 0:
                carry(ball, rows[first + glued], p, dt, move)
                x = ball[0] + move[0] * dt
                y = ball[1] + move[1] * dt
                if in_a_wall(x, y, walls, p[BALL_R]):
                    # Glue knows no contacts and would carry the ball through; force gives way.
                    hold(ball, velocity, rows[first + glued], p, -1.0, dt, pull)
                    glued = -1
            if glued >= 0:
                if p[CORE] > 0.0:
                    drag(ball, velocity, move, rows[first + glued], p, wheel_parameters[a], dt)
                velocity[0] = spin[0] = move[0]
                velocity[1] = spin[1] = move[1]
                air[:] = 0.0
            elif air[Z] > 0.0 or air[RISE] > 0.0:
                velocity[0] += pull[0] * dt
                velocity[1] += pull[1] * dt
                high = fly(air, velocity, spin, rows, first, robots, walls, p, dt, move)
            elif held:
                velocity[0] += pull[0] * dt
                velocity[1] += pull[1] * dt
                move[0] = spin[0] = velocity[0]
                move[1] = spin[1] = velocity[1]
            elif p[ROLLER] > 0.0 and roll(ball, velocity, spin, twist, rows, first, driven, contacts, p, dt):
                move[0], move[1] = velocity[0], velocity[1]
            else:
                friction(velocity, spin, p, dt, move)
            if glued < 0 and p[CORE] > 0.0 and not high:
                before_x, before_y = velocity[0], velocity[1]
                for i in range(robots):
                    meet(ball, velocity, spin, twist, rows[first + i], p, wheel_parameters[a], dt, hit)
                if velocity[0] != before_x or velocity[1] != before_y:
                    # Pushed, it moves as it leaves the contact: what friction took is made up for.
                    move[0], move[1] = velocity[0], velocity[1]
            if high:
                pass_over(ball, velocity, walls, move, p, dt)
                aloft[0], aloft[1] = ball[0], ball[1]
                ball[0], ball[1] = _ELSEWHERE, _ELSEWHERE
                move[0] = move[1] = 0.0
            elif glued < 0 and hypot(move[0], move[1]) * dt > 0.05 * p[BALL_R]:
                share = sweep(rows, first, robots, walls, move, p, dt, met, solver[CLEAR_X], solver[CLEAR_Y])
                if share < 1.0:
                    # From then on it goes with what it met, which may move away from it.
                    x, y = move[0] - met[0], move[1] - met[1]
                    back = max(1.0 - share - _OVERLAP / (hypot(x, y) * dt), 0.0)
                    ball[0] -= x * dt * back
                    ball[1] -= y * dt * back
            ball[3] = target[0] = move[0]
            ball[4] = target[1] = move[1]
            if by_pymunk:
                store_bodies(bodies[a], rows[first : first + width])
                call_step(calls[0], handles[a, 0], dt)
                load_bodies(bodies[a], rows[first : first + width])
            else:
                clock[a] += 1
                collide(
                    rows[first : first + width],
                    walls,
                    solver,
                    materials,
                    edges,
                    parts,
                    inverse[a],
                    bias[a],
                    memory[a],
                    clock[a],
                    meetings,
                    who,
                    speeds,
                    dt,
                )
            if high:
                ball[0], ball[1] = aloft[0], aloft[1]
                ball[3], ball[4] = velocity[0], velocity[1]
            else:
                # What contacts did to the mean velocity, they did to the velocity.
                velocity[0] += ball[3] - target[0]
                velocity[1] += ball[4] - target[1]
                if air[Z] < ROBOT_HEIGHT:
                    note_touch(rows, first, robots, p, touch, a)
            if history.shape[0] > 0:
                for i in range(width):
                    for k in range(6):
                        history[step, a, i, k] = rows[first + i, k]
                history[step, a, robots, 3] = velocity[0]
                history[step, a, robots, 4] = velocity[1]
                history[step, a, robots, 2] = air[Z]
                history[step, a, robots, 5] = air[RISE]
        if high and by_pymunk:
            # Its body is still elsewhere.
            cursors[a, 0] = 0
            call_each_body(calls[1], handles[a, 0], calls[2], handles[a, 1])
    report(rows, arena_parameters, ball_velocity, flight, contact, robots_out, balls_out)
