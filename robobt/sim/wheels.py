"""How a robot on four omnidirectional wheels follows its command, as grSim's does.

grSim turns a command into four wheel speeds once a frame: it clamps how much speed
and turning rate may change, and takes the commanded direction as it is. A motor of
limited torque brings its wheel to that speed, and the wheel drives the body by
friction with the ground, which depends on how much of the weight rests on it. So a
robot that accelerates, brakes or changes direction faster than the friction allows
slips, turns less than it was told to, and leaves its heading.

A wheel touches the ground with both edges of its rim, of which one slips whenever
the robot turns: which one depends on the force, hence the turning rate of a robot
that drives is up to 3 % more than commanded.

Source of the model: grSim's description of its robot (wheel angles, masses, torque,
friction; its own default robot) and what it does in measured manoeuvres.
"""

from __future__ import annotations

from math import copysign, cos, hypot, sin

from robobt.sim.columns import (
    CENTRE,
    COMMAND_RADIUS,
    FORWARD_UP,
    FRAME,
    GAIN,
    GYRO,
    INERTIA,
    INNER,
    LOAD_AHEAD,
    LOAD_ASIDE,
    LOAD_LAG,
    LOAD_REST,
    MASS,
    MAX_SPEED,
    MAX_TURN,
    MOTOR,
    MU_AXIAL,
    MU_TANGENT,
    OMEGA,
    OUTER,
    RIM_MASS,
    TURN_RATE,
    VX,
    VY,
    WHEEL_COS,
    WHEEL_SIN,
)
from robobt.world.compiled import compiled_lean
from robobt.world.geometry import FloatArray

# Columns of a robot's state: speeds of the rims, where they are to go, what comes after
# the next frame, the acceleration that the loads follow, time to the next frame, impulses,
# whether the dribbler holds the ball, and where in the robot's frame.
_RIM, _TARGET, _NEXT, _LEAN, _CLOCK, _IMPULSE, HELD, AHEAD, ASIDE = 0, 4, 8, 12, 14, 15, 27, 28, 29
WHEEL_STATE = 30

_SWEEPS = 8
"""Passes over the contacts; the impulses of the last step are where they start."""


@compiled_lean
def _plan(row: FloatArray, command: FloatArray, p: FloatArray, w: FloatArray, state: FloatArray) -> None:
    """Turn the command into the wheel speeds after the next, from how fast the robot is now."""
    vx, vy, turn = command[VX], command[VY], command[OMEGA]
    speed = hypot(vx, vy)
    if speed > p[MAX_SPEED]:
        vx *= p[MAX_SPEED] / speed
        vy *= p[MAX_SPEED] / speed
        speed = p[MAX_SPEED]
    turn = min(max(turn, -p[MAX_TURN]), p[MAX_TURN])
    now = hypot(row[3], row[4])
    # The speeds come into force a frame late: the change is that of two frames.
    most = min(w[GAIN], p[FORWARD_UP]) * 2.0 * w[FRAME]
    if abs(speed - now) > most:
        reach = now + copysign(most, speed - now)
        if speed > 0.0:
            vx *= reach / speed
            vy *= reach / speed
        else:
            c, s = cos(row[2]), sin(row[2])
            vx = (c * row[3] + s * row[4]) * reach / now
            vy = (c * row[4] - s * row[3]) * reach / now
    most = p[TURN_RATE] * 2.0 * w[FRAME]
    turn = row[5] + min(max(turn - row[5], -most), most)
    for i in range(4):
        state[_NEXT + i] = w[COMMAND_RADIUS] * turn - vx * w[WHEEL_SIN + i] + vy * w[WHEEL_COS + i]


@compiled_lean
def drive_wheels(
    row: FloatArray, command: FloatArray, p: FloatArray, w: FloatArray, state: FloatArray, dt: float
) -> bool:
    """Let the wheels turn for ``dt`` and change the robot's velocity accordingly; say whether a frame began.

    Args:
        row: of the robot.
        command: its command.
        p: its parameters.
        w: the parameters of its wheels.
        state: of its wheels, (WHEEL_STATE,), kept between calls.
        dt: time step [s].

    Returns:
        whether a frame of grSim began.
    """
    begins = bool(state[_CLOCK] <= 1e-9)
    if begins:
        state[_CLOCK] += w[FRAME]
        for i in range(4):
            state[_TARGET + i] = state[_NEXT + i]
        _plan(row, command, p, w, state)
    state[_CLOCK] -= dt
    c, s = cos(row[2]), sin(row[2])
    ahead = c * row[3] + s * row[4]
    aside = c * row[4] - s * row[3]
    turn = row[5]
    # From the centre of the robot to its centre of mass, about which it turns.
    centre = w[CENTRE]
    aside += turn * centre
    start_ahead, start_aside = ahead, aside
    body, spin, rim = 1.0 / w[MASS], 1.0 / w[INERTIA], 1.0 / w[RIM_MASS]
    motor = w[MOTOR] * dt
    # A spinning wheel resists being turned about the vertical, and leans on the ground instead.
    lean_ahead, lean_aside = state[_LEAN], state[_LEAN + 1]
    for i in range(4):
        lean_ahead -= w[GYRO] * turn * state[_RIM + i] * w[WHEEL_COS + i]
        lean_aside -= w[GYRO] * turn * state[_RIM + i] * w[WHEEL_SIN + i]
    # Impulses of the last step, within what the loads allow now.
    for i in range(4):
        load = w[LOAD_REST + i] - w[LOAD_AHEAD + i] * lean_ahead - w[LOAD_ASIDE + i] * lean_aside
        load = max(load, 0.0) * dt
        grip, drag = 0.5 * w[MU_TANGENT] * load, w[MU_AXIAL] * load
        for k in range(2):
            state[_IMPULSE + 3 * i + k] = min(max(state[_IMPULSE + 3 * i + k], -grip), grip)
        state[_IMPULSE + 3 * i + 2] = min(max(state[_IMPULSE + 3 * i + 2], -drag), drag)
        push = state[_IMPULSE + 3 * i] + state[_IMPULSE + 3 * i + 1]
        across = state[_IMPULSE + 3 * i + 2]
        ahead += (-push * w[WHEEL_SIN + i] + across * w[WHEEL_COS + i]) * body
        aside += (push * w[WHEEL_COS + i] + across * w[WHEEL_SIN + i]) * body
        turn += (state[_IMPULSE + 3 * i] * w[INNER] + state[_IMPULSE + 3 * i + 1] * w[OUTER]) * spin
        turn -= centre * (push * w[WHEEL_COS + i] + across * w[WHEEL_SIN + i]) * spin
    for _ in range(_SWEEPS):
        for i in range(4):
            load = w[LOAD_REST + i] - w[LOAD_AHEAD + i] * lean_ahead - w[LOAD_ASIDE + i] * lean_aside
            load = max(load, 0.0) * dt
            grip, drag = 0.5 * w[MU_TANGENT] * load, w[MU_AXIAL] * load
            tx, ty = -w[WHEEL_SIN + i], w[WHEEL_COS + i]
            inner, outer = state[_IMPULSE + 3 * i], state[_IMPULSE + 3 * i + 1]
            # The motor gives what its wheel needs to have the speed wanted, within its torque.
            needed = (state[_TARGET + i] - state[_RIM + i]) * w[RIM_MASS] + inner + outer
            speed, free = state[_TARGET + i], 0.0
            if abs(needed) > motor:
                speed = state[_RIM + i] + (copysign(motor, needed) - inner - outer) * rim
                free = rim
            for k in range(2):
                arm = (w[INNER] if k == 0 else w[OUTER]) - centre * ty
                slip = speed - (tx * ahead + ty * aside + arm * turn)
                old = state[_IMPULSE + 3 * i + k]
                impulse = old + slip / (body + arm * arm * spin + free)
                impulse = min(max(impulse, -grip), grip)
                state[_IMPULSE + 3 * i + k] = impulse
                change = impulse - old
                ahead += change * tx * body
                aside += change * ty * body
                turn += change * arm * spin
                speed -= change * free
            arm = centre * tx
            slip = -(ty * ahead - tx * aside + arm * turn)
            old = state[_IMPULSE + 3 * i + 2]
            impulse = min(max(old + slip / (body + arm * arm * spin), -drag), drag)
            state[_IMPULSE + 3 * i + 2] = impulse
            ahead += (impulse - old) * ty * body
            aside -= (impulse - old) * tx * body
            turn += (impulse - old) * arm * spin
    for i in range(4):
        force = state[_IMPULSE + 3 * i] + state[_IMPULSE + 3 * i + 1]
        needed = (state[_TARGET + i] - state[_RIM + i]) * w[RIM_MASS] + force
        if abs(needed) > motor:
            state[_RIM + i] += (copysign(motor, needed) - force) * rim
        else:
            state[_RIM + i] = state[_TARGET + i]
    share = min(dt / w[LOAD_LAG], 1.0)
    state[_LEAN] += share * ((ahead - start_ahead) / dt - state[_LEAN])
    state[_LEAN + 1] += share * ((aside - start_aside) / dt - state[_LEAN + 1])
    aside -= turn * centre
    row[3] = c * ahead - s * aside
    row[4] = s * ahead + c * aside
    row[5] = turn
    return begins
