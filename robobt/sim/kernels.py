"""One control tick of the league's physics, in any number of arenas.

Bodies are moved and contacts resolved by pymunk or, in many arenas, by the equivalent over arrays
(:mod:`robobt.sim.contacts.solver`). Everything else is written once, compiled: how robots drive
(:mod:`robobt.world.driving`), how the ball rolls (:mod:`robobt.sim.motion`) and flies
(:mod:`robobt.sim.flight`), dribbler and kicker (:mod:`robobt.sim.mouth`), and contacts within a step
(:mod:`robobt.sim.sweep`).
"""

from __future__ import annotations

from math import cos, hypot, sin

from robobt.sim.arrays import ArenaArrays
from robobt.sim.chance import drawn_factor
from robobt.sim.chipmunk import (
    FUNCTIONS,
    HANDLE,
    Calls,
    call_each_body,
    call_step,
    load_bodies,
    store_bodies,
)
from robobt.sim.contacts.solver import ContactArrays, Solving, begin_contacts, end_contacts, solve
from robobt.sim.contacts.touching import Shapes
from robobt.sim.flight import fly, pass_over
from robobt.sim.hinge import take_hold, tie
from robobt.sim.motion import friction
from robobt.sim.mouth import carry, hold, in_mouth, keeps, kick, let_in
from robobt.sim.records import (
    ARENA,
    BIAS,
    BODY,
    COMMAND,
    CONTACT,
    CONTACT_MEMORY,
    EDGE,
    FLIGHT,
    FRONT,
    HALFWAY,
    KEPT,
    MASSES,
    MOVING,
    PART,
    SOLVER,
    TOUCH,
    WALL,
    WHEEL_DRIVE,
    Arena,
    Body,
    Command,
    Records,
    Solver,
)
from robobt.sim.reports import note_touch, report
from robobt.sim.roller import roll
from robobt.sim.shell import drag, meet
from robobt.sim.sweep import in_a_wall, sweep
from robobt.sim.wheels import drive_wheels
from robobt.world.compiled import compiled_inline, compiled_lean, compiled_merged
from robobt.world.driving import drive, follow
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS, RECEIVED_HEIGHT, ROBOT_HEIGHT

_CONTACT_OVERLAP = 3e-4
"""Depth to which a swept ball is put into the object it hits, so that the solver sees the contact [m]."""

_BACKING = -0.02
"""A robot slower than this along its heading backs away from the ball [m/s]."""

_HIGH_BALL_PLACE = 1e4
"""Coordinate outside the arena where its space keeps balls that fly high [m]."""


@compiled_lean
def control_tick(arrays_: ArenaArrays, old_: FloatArray, new_: FloatArray, sub_steps: int, dt: float) -> None:
    """Advance every arena by one control period of ``sub_steps`` physics steps.

    Args:
        arrays_: of the arenas.
        old_: (n, R, size(COMMAND)) commands before each robot's sub-step ``switch``, which is how
            a command's delay works; a fired kick is set to 0 in place.
        new_: (n, R, size(COMMAND)) commands from that sub-step on.
        sub_steps: physics steps in this call.
        dt: length of each [s].
    """
    arrays = ArenaArrays(*arrays_)
    states, flights = arrays.states.view(ARENA)[..., 0], arrays.flight.view(FLIGHT)[..., 0]
    kept, drives = arrays.kept.view(KEPT)[..., 0], arrays.drives.view(WHEEL_DRIVE)[..., 0]
    bodies, touch = arrays.bodies.view(BODY)[..., 0], arrays.touch.view(TOUCH)
    history, fronts = arrays.history.view(BODY)[..., 0], arrays.fronts.view(FRONT)[..., 0]
    old, new = old_.view(COMMAND)[..., 0], new_.view(COMMAND)[..., 0]
    known = ContactArrays(*arrays.contacts)
    masses, bias = known.masses.view(MASSES)[..., 0], known.bias.view(BIAS)[..., 0]
    memory, contacts = known.memory.view(CONTACT_MEMORY)[..., 0], known.contacts.view(CONTACT)[..., 0]
    walls, edges = known.walls.view(WALL)[..., 0], known.edges.view(EDGE)[..., 0]
    parts, moving = known.parts.view(PART)[..., 0], known.moving.view(MOVING)[..., 0]
    halfway = known.halfway.view(HALFWAY)[..., 0]
    shapes = Shapes(walls, edges, parts, known.solver.view(SOLVER)[0, 0])
    calls = Calls(*arrays.calls)
    functions, handles = calls.functions.view(FUNCTIONS)[0, 0], calls.handles.view(HANDLE)[..., 0]
    robots, by_pymunk, together = arrays.contact.shape[1], len(handles) > 0, len(halfway)
    arrays.kicked[:] = False
    for first in range(0, len(states), together):
        last = min(first + together, len(states))
        for step in range(sub_steps + 1):
            if step > 0 and not by_pymunk:
                solve(shapes.solver, contacts, moving, halfway[: last - first])
            for a in range(first, last):
                state, half = states[a], halfway[a - first]
                own: Records[Body] = bodies[a, : robots + 1]
                arena = Arena(
                    bodies=own,
                    robots=own[:robots],
                    body=own[robots],
                    ball=state.ball,
                    air=flights[a],
                    touch=touch[a],
                    parameters=state.parameters,
                    wheels=state.wheels,
                    state=state,
                    kept=kept[a],
                    drives=drives[a],
                    kicked=arrays.kicked[a],
                    fronts=fronts,
                    walls=walls,
                )
                solving = Solving(masses[a], bias[a], memory[a], contacts[a - first], moving[a - first])
                if step > 0:
                    if not by_pymunk:
                        end_contacts(own, solving, half.contacts)
                    _take_ball(arena, half.high == 1, half.x, half.y)
                    if len(history) > 0:
                        _note(history[step - 1, a], arena)
                if step == sub_steps:
                    continue
                _act(arena, old[a], new[a], step, dt)
                high = _move_ball(arena, shapes.solver, dt)
                half.high = high
                half.x, half.y = _put_ball(arena, high)
                if by_pymunk:
                    store_bodies(calls.places[a], own)
                    call_step(functions.step, handles[a].space, dt)
                    load_bodies(calls.places[a], own)
                else:
                    half.contacts = begin_contacts(own, shapes, solving, dt)
        for a in range(first, last):
            if halfway[a - first].high == 1 and by_pymunk:
                # Its body is still elsewhere.
                calls.cursors[a, 0] = 0
                call_each_body(functions.each, handles[a].space, functions.write, handles[a].batch)
    report(arrays.states, arrays.bodies, arrays.flight, arrays.contact, arrays.robots, arrays.balls)


@compiled_inline
def _act(arena: Arena, old: Records[Command], new: Records[Command], step: int, dt: float) -> None:
    """Let the robots drive, kick and dribble for one step."""
    ball, low = arena.ball, arena.air.z < RECEIVED_HEIGHT
    ball.carrier = ball.kicker = -1
    ball.held = ball.shared = 0
    ball.pull_x = ball.pull_y = 0.0
    for i in range(len(arena.robots)):
        robot, kept = arena.robots[i], arena.kept[i]
        command = new[i] if step >= kept.switch else old[i]
        follow(kept.followed, command, kept.limits, dt)
        arena.fronts[i].driven = 0.0
        begins = False
        if arena.wheels.mass > 0.0:
            begins = drive_wheels(robot, kept.followed, kept.limits, arena.wheels, arena.drives[i], dt)
        else:
            drive(robot, kept.followed, kept.limits, dt)
        if kept.charging > 0.0:
            kept.charging -= dt
        if kept.cooldown > 0.0:
            kept.cooldown -= dt
        elif not (low and _kicks(arena, i, command, dt)):
            if command.on_contact == 0.0 and arena.parameters.roller == 0.0:
                command.kick_speed = 0.0
            if low and ball.kicker < 0:
                _dribble(arena, i, command, begins, dt)


@compiled_inline
def _kicks(arena: Arena, i: int, command: Command, dt: float) -> bool:
    """Let a robot kick a low ball if it is commanded to and has it; return whether it did."""
    ball, robot, p = arena.ball, arena.robots[i], arena.parameters
    if command.kick_speed <= 0.0 or arena.kept[i].charging > 0.0:
        return False
    if command.on_contact > 0.0 and p.glue == 0.0 and p.roller == 0.0:
        let_in(arena.body, ball, robot, p, dt)
    if not in_mouth(arena.body, robot, p, p.body.sensor_depth):
        return False
    kept, speed = arena.kept[i], command.kick_speed
    if p.kicker.speed_spread > 0.0:
        speed *= drawn_factor(arena.state, p.kicker.speed_spread)
    kick(arena.body, ball, arena.air, robot, kept.limits, speed, command.kick_angle, p)
    command.kick_speed = 0.0
    arena.kicked[i] = True
    kept.cooldown, kept.charging = p.kicker.recharge, p.kicker.charge
    arena.drives[i].hinge.held = 0.0
    ball.kicker, ball.carrier = i, -1
    arena.touch.robot = i
    ball.held = 0
    ball.pull_x = ball.pull_y = 0.0
    return True


@compiled_inline
def _dribble(arena: Arena, i: int, command: Command, begins: bool, dt: float) -> None:
    """Let a robot's dribbler hold a low ball for one step; ``begins`` tells whether a frame of grSim does."""
    body, ball, robot, p = arena.body, arena.ball, arena.robots[i], arena.parameters
    driven = command.dribbler > 0.0
    if p.core > 0.0:
        hinge = arena.drives[i].hinge
        if begins:
            if not (driven and keeps(body, robot, p, hinge.held > 0.0)):
                hinge.held = 0.0
            elif hinge.held == 0.0:
                take_hold(body, robot, hinge)
        if hinge.held > 0.0:
            ball.held = 1
            if ball.carrier >= 0:
                ball.shared = 1
            ball.carrier = i
    elif p.roller > 0.0:
        arena.fronts[i].driven = command.dribbler
    elif driven:
        if in_mouth(body, robot, p, p.dribbler.reach):
            ball.held = 1
            if p.glue > 0.0:
                ball.carrier = i
            else:
                hold(body, ball, robot, p, -1.0, dt)
    elif (
        p.dribbler.idle_hold > 0.0
        and cos(robot.heading) * robot.vx + sin(robot.heading) * robot.vy > _BACKING
        and in_mouth(body, robot, p, p.dribbler.reach)
    ):
        ball.held = 1
        hold(body, ball, robot, p, p.dribbler.idle_hold, dt)


@compiled_inline
def _move_ball(arena: Arena, solver: Solver, dt: float) -> bool:
    """Find how the ball moves in one step; return whether it passes over everything, and move it then."""
    body, ball, air, p, w = arena.body, arena.ball, arena.air, arena.parameters, arena.wheels
    high = False
    if ball.carrier >= 0:
        _carry(arena, dt)
    if ball.carrier >= 0:
        if p.core > 0.0:
            drag(body, ball, arena.robots[ball.carrier], p, w, dt)
        ball.vx = ball.spin_x = ball.move_x
        ball.vy = ball.spin_y = ball.move_y
        air.z = air.vz = air.hops = 0.0
    elif air.z > 0.0 or air.vz > 0.0:
        ball.vx += ball.pull_x * dt
        ball.vy += ball.pull_y * dt
        high = fly(arena, dt)
    elif ball.held > 0:
        ball.vx += ball.pull_x * dt
        ball.vy += ball.pull_y * dt
        ball.move_x = ball.spin_x = ball.vx
        ball.move_y = ball.spin_y = ball.vy
    elif p.roller > 0.0 and roll(arena, dt):
        ball.move_x, ball.move_y = ball.vx, ball.vy
    else:
        friction(ball, p, dt)
    if ball.carrier < 0 and p.core > 0.0 and not high:
        before_x, before_y = ball.vx, ball.vy
        for i in range(len(arena.robots)):
            meet(body, ball, arena.robots[i], p, w, dt)
        if ball.vx != before_x or ball.vy != before_y:
            # A pushed ball keeps its speed from the contact: the loss by friction is compensated.
            ball.move_x, ball.move_y = ball.vx, ball.vy
    if high:
        pass_over(arena, dt)
    elif ball.carrier < 0 and hypot(ball.move_x, ball.move_y) * dt > 0.05 * BALL_RADIUS:
        share, met_x, met_y = sweep(arena, solver, dt)
        if share < 1.0:
            # From then on it moves with the object it met, which may move away from it.
            x, y = ball.move_x - met_x, ball.move_y - met_y
            back = max(1.0 - share - _CONTACT_OVERLAP / (hypot(x, y) * dt), 0.0)
            body.x -= x * dt * back
            body.y -= y * dt * back
    return high


@compiled_inline
def _carry(arena: Arena, dt: float) -> None:
    """Move the ball with the robot that carries it, unless that takes it into a wall."""
    body, ball, p = arena.body, arena.ball, arena.parameters
    if ball.shared > 0:
        tie(arena.robots, arena.drives, ball.carrier, arena.wheels, dt)
    robot = arena.robots[ball.carrier]
    carry(body, ball, robot, p, dt)
    if in_a_wall(body.x + ball.move_x * dt, body.y + ball.move_y * dt, arena.walls):
        # A glued ball has no contacts and would be carried through; a pulled ball gives way.
        hold(body, ball, robot, p, -1.0, dt)
        ball.carrier = -1


@compiled_merged
def _put_ball(arena: Arena, high: bool) -> tuple[float, float]:
    """Put the ball's body where it has contacts, for the length of a step; return where it is."""
    body, ball = arena.body, arena.ball
    x, y = body.x, body.y
    if high:
        body.x, body.y = _HIGH_BALL_PLACE, _HIGH_BALL_PLACE
        ball.move_x = ball.move_y = 0.0
    body.vx, body.vy = ball.move_x, ball.move_y
    return x, y


@compiled_merged
def _take_ball(arena: Arena, high: bool, x: float, y: float) -> None:
    """Apply the contacts of a step to the ball; a high ball continues from (x, y)."""
    body, ball = arena.body, arena.ball
    if high:
        body.x, body.y, body.vx, body.vy = x, y, ball.vx, ball.vy
        return
    # What contacts did to the mean velocity, they did to the velocity.
    ball.vx += body.vx - ball.move_x
    ball.vy += body.vy - ball.move_y
    if arena.air.z < ROBOT_HEIGHT:
        note_touch(arena)


@compiled_merged
def _note(history: Records[Body], arena: Arena) -> None:
    """Record an arena's bodies after a step, with the ball's true state instead of the contacts' one."""
    for i in range(len(arena.bodies)):
        body, seen = arena.bodies[i], history[i]
        seen.x, seen.y, seen.heading = body.x, body.y, body.heading
        seen.vx, seen.vy, seen.omega = body.vx, body.vy, body.omega
    seen = history[len(arena.robots)]
    seen.vx, seen.vy = arena.ball.vx, arena.ball.vy
    seen.heading, seen.omega = arena.air.z, arena.air.vz
