"""How a robot on four omnidirectional wheels follows its command, as grSim's does.

grSim turns the last command of a frame into four wheel speeds when the frame ends: it
clamps how much speed and turning rate may change, and takes the commanded direction as
it is. A motor of limited torque brings its wheel to that speed, and the wheel drives
the body by friction with the ground, which depends on how much of the weight rests on
it. So a robot that accelerates, brakes or changes direction faster than the friction
allows slips, turns less than commanded, and leaves its heading.

Acceleration moves load from wheel to wheel, but bounds of the friction feel only a share
of it (``grip_ahead``, ``grip_aside``): ODE takes them from the loads that the wheels
would have in this step without friction. There the motors speed their wheels up freely,
and lean on the body as they do.

A wheel touches the ground with both edges of its rim, of which one slips whenever
the robot turns: which one depends on the force, hence the turning rate of a robot
that drives is up to 3 % more than commanded.

Source of the model: grSim's description of its robot (wheel angles, masses, friction; its
own default robot) and what it does in measured manoeuvres. The shares follow from ODE's
equations: c / (c + s r), with the softness c = 0.6 /kg of grSim's contacts in a step of
1/300 s, and the sum s r = 1.7 /kg (ahead) or 2.9 /kg (aside) of the squared arms of its
eight contacts over the robot's moment of inertia. Only the motors' torque is fitted, to
557 pieces of 0.2 s of the real grSim under a policy's commands: 0.17 N m, where grSim
writes 0.2.
"""

from __future__ import annotations

from math import copysign, cos, hypot, sin

from robobt.sim.records import Body, Followed, WheelDrive, Wheels
from robobt.world.compiled import compiled_lean, compiled_merged
from robobt.world.driving import reached
from robobt.world.records import Limits

_WHEEL_COUNT = 4

_INNER, _OUTER = _EDGES = (0, 1)
"""The two edges of a rim."""

_WHEEL_SWEEPS = 8
"""Passes over the contacts; the impulses of the last step are where they start."""


@compiled_merged
def _plan(followed: Followed, limits: Limits, w: Wheels, drive: WheelDrive) -> None:
    """Turn the velocity to follow into the next frame's wheel speeds, from how this one began."""
    rims = drive.rims
    vx, vy, turn = reached(followed, limits)
    speed = hypot(vx, vy)
    if speed > limits.max_speed:
        vx *= limits.max_speed / speed
        vy *= limits.max_speed / speed
        speed = limits.max_speed
    turn = min(max(turn, -limits.max_turn), limits.max_turn)
    now = hypot(drive.vx, drive.vy)
    # The speeds come into force a frame late: the change is that of two frames.
    most = min(w.acceleration, limits.acceleration) * 2.0 * w.frame
    if abs(speed - now) > most:
        reach = now + copysign(most, speed - now)
        if speed > 0.0:
            vx *= reach / speed
            vy *= reach / speed
        else:
            c, s = cos(drive.heading), sin(drive.heading)
            vx = (c * drive.vx + s * drive.vy) * reach / now
            vy = (c * drive.vy - s * drive.vx) * reach / now
    most = limits.turn_acceleration * 2.0 * w.frame
    turn = drive.omega + min(max(turn - drive.omega, -most), most)
    for i in range(_WHEEL_COUNT):
        rims[i].next = w.command_radius * turn - vx * w.each[i].sin + vy * w.each[i].cos


@compiled_lean
def drive_wheels(
    robot: Body, followed: Followed, limits: Limits, w: Wheels, drive: WheelDrive, dt: float
) -> bool:
    """Let the wheels turn for ``dt`` and change the robot's velocity accordingly.

    Args:
        robot: its body, changed.
        followed: the velocity that it follows.
        limits: what it can do.
        w: the parameters of its wheels.
        drive: what is kept of its wheels between calls, changed.
        dt: time step [s].

    Returns:
        whether a frame of grSim began.
    """
    rims = drive.rims
    begins = bool(drive.clock <= 1e-9)
    if begins:
        drive.clock += w.frame
        for i in range(_WHEEL_COUNT):
            rims[i].target = rims[i].next
        drive.vx, drive.vy, drive.heading, drive.omega = robot.vx, robot.vy, robot.heading, robot.omega
    drive.clock -= dt
    c, s = cos(robot.heading), sin(robot.heading)
    ahead = c * robot.vx + s * robot.vy
    aside = c * robot.vy - s * robot.vx
    turn = robot.omega
    # From the centre of the robot to its centre of mass, about which it turns.
    aside += turn * w.centre
    start_ahead, start_aside = ahead, aside
    ahead, aside, turn = _push(ahead, aside, turn, w, drive, dt)
    motor, rim = w.motor * dt, 1.0 / w.rim_mass
    for i in range(_WHEEL_COUNT):
        wheel = rims[i]
        force = wheel.along[_INNER] + wheel.along[_OUTER]
        needed = (wheel.target - wheel.speed) * w.rim_mass + force
        if abs(needed) > motor:
            wheel.speed += (copysign(motor, needed) - force) * rim
        else:
            wheel.speed = wheel.target
    share = min(dt / w.load_lag, 1.0)
    drive.lean_ahead += share * ((ahead - start_ahead) / dt - drive.lean_ahead)
    drive.lean_aside += share * ((aside - start_aside) / dt - drive.lean_aside)
    aside -= turn * w.centre
    robot.vx = c * ahead - s * aside
    robot.vy = s * ahead + c * aside
    robot.omega = turn
    if drive.clock <= 1e-9:
        # grSim heeds commands until a frame ends, and compares them with how the robot was at its beginning.
        _plan(followed, limits, w, drive)
    return begins


@compiled_lean
def _push(
    ahead: float, aside: float, turn: float, w: Wheels, drive: WheelDrive, dt: float
) -> tuple[float, float, float]:
    """Return a robot's velocity, in its own frame, after its wheels have pushed it for ``dt``."""
    rims, centre = drive.rims, w.centre
    body, spin, rim = 1.0 / w.mass, 1.0 / w.inertia, 1.0 / w.rim_mass
    motor = w.motor * dt
    # A spinning wheel resists being turned about the vertical, and leans on the ground instead.
    lean_ahead, lean_aside = drive.lean_ahead, drive.lean_aside
    for i in range(_WHEEL_COUNT):
        lean_ahead -= w.gyro_ahead * turn * rims[i].speed * w.each[i].cos
        lean_aside -= w.gyro_aside * turn * rims[i].speed * w.each[i].sin
        # A motor that speeds its wheel up leans on the body.
        free = min(max((rims[i].target - rims[i].speed) * w.rim_mass, -motor), motor) / dt
        lean_ahead -= w.motor_ahead * free * w.each[i].sin
        lean_aside += w.motor_aside * free * w.each[i].cos
    # Impulses of the last step, within what the loads allow now.
    for i in range(_WHEEL_COUNT):
        it, wheel = w.each[i], rims[i]
        load = max(it.load_rest - it.load_ahead * lean_ahead - it.load_aside * lean_aside, 0.0) * dt
        grip, drag = 0.5 * w.tangent_friction * load, w.axial_friction * load
        for k in _EDGES:
            wheel.along[k] = min(max(wheel.along[k], -grip), grip)
        wheel.across = min(max(wheel.across, -drag), drag)
        push = wheel.along[_INNER] + wheel.along[_OUTER]
        across = wheel.across
        ahead += (-push * it.sin + across * it.cos) * body
        aside += (push * it.cos + across * it.sin) * body
        turn += (wheel.along[_INNER] * w.inner_edge + wheel.along[_OUTER] * w.outer_edge) * spin
        turn -= centre * (push * it.cos + across * it.sin) * spin
    for _ in range(_WHEEL_SWEEPS):
        for i in range(_WHEEL_COUNT):
            it, wheel = w.each[i], rims[i]
            load = max(it.load_rest - it.load_ahead * lean_ahead - it.load_aside * lean_aside, 0.0) * dt
            grip, drag = 0.5 * w.tangent_friction * load, w.axial_friction * load
            tx, ty = -it.sin, it.cos
            # The motor gives what its wheel needs to have the speed wanted, within its torque.
            inner, outer = wheel.along[_INNER], wheel.along[_OUTER]
            needed = (wheel.target - wheel.speed) * w.rim_mass + inner + outer
            speed, free = wheel.target, 0.0
            if abs(needed) > motor:
                speed = wheel.speed + (copysign(motor, needed) - inner - outer) * rim
                free = rim
            for k in _EDGES:
                arm = (w.inner_edge if k == _INNER else w.outer_edge) - centre * ty
                slip = speed - (tx * ahead + ty * aside + arm * turn)
                old = wheel.along[k]
                impulse = old + slip / (body + arm * arm * spin + free)
                impulse = min(max(impulse, -grip), grip)
                wheel.along[k] = impulse
                change = impulse - old
                ahead += change * tx * body
                aside += change * ty * body
                turn += change * arm * spin
                speed -= change * free
            arm = centre * tx
            slip = -(ty * ahead - tx * aside + arm * turn)
            old = wheel.across
            impulse = min(max(old + slip / (body + arm * arm * spin), -drag), drag)
            wheel.across = impulse
            ahead += (impulse - old) * ty * body
            aside -= (impulse - old) * tx * body
            turn += (impulse - old) * arm * spin
    return ahead, aside, turn
