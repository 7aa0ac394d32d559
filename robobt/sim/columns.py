"""What the columns of the simulator's arrays mean, and how they are filled from settings."""

from __future__ import annotations

from math import radians

import numpy as np

from robobt.sim.robot_settings import WheelSettings
from robobt.sim.settings import SimSettings
from robobt.world.ball_model import GRAVITY
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

SOFT = 0.008
"""How far inside a robot's core, where there is one, the ball meets something hard [m]."""

# Columns of a command.
VX, VY, OMEGA, KICK, ON_CONTACT, DRIBBLE, ANGLE = range(7)
COMMAND = 7

# Columns of a ball's height above where it lies, how fast it rises, and its touch-downs since the kick.
Z, RISE, HOPS = range(3)
FLIGHT = 3

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
    BALL_M,
    CORE,
    SOLID,
    HALF_WHEEL,
    SOFTNESS,
    FRONT_FRICTION,
    HULL_FRICTION,
    ROLLER,
    ROLLER_FRICTION,
    GROUND_FRICTION,
    BOUNCE_DRIVEN,
    BOUNCE_IDLE,
    BOUNCE_HULL,
    JAW,
    HALF_OPENING,
    ROUNDING,
    CHIP_ANGLE,
    CHIP_MAX,
    CHIP_YIELD,
    HOP_FIRST,
    HOP_OTHER,
    HOP_UP,
    BOUNCE_WALL,
) = range(41)
ARENA_PARAMETERS = 41

# Columns of the parameters of an arena's robots' wheels; those from LOAD_REST on are four, one a wheel.
(
    MASS,
    INERTIA,
    RIM_MASS,
    MOTOR,
    MU_TANGENT,
    MU_AXIAL,
    INNER,
    OUTER,
    COMMAND_RADIUS,
    GAIN,
    FRAME,
    LOAD_LAG,
    CENTRE,
    GYRO,
) = range(14)
LOAD_REST, LOAD_AHEAD, LOAD_ASIDE, WHEEL_COS, WHEEL_SIN = range(14, 34, 4)
WHEEL_PARAMETERS = 34


def arena_row(settings: SimSettings) -> FloatArray:
    """Return an arena's row of parameters."""
    ball, dribbler, kicker, body = settings.ball, settings.dribbler, settings.kicker, settings.body
    row = np.zeros(ARENA_PARAMETERS)
    row[SLIDE] = ball.slide_deceleration
    # Spin gained per speed lost, so that a ball without spin rolls at switch_share of its speed.
    row[SPIN_GAIN] = ball.switch_share / (1.0 - ball.switch_share)
    row[ROLL] = ball.roll_deceleration
    row[STOP_SPEED] = ball.stop_speed
    row[FACE] = body.face
    row[HALF_MOUTH] = body.mouth_width / 2
    row[SENSOR] = body.sensor_depth
    row[GLUE] = float(dribbler.kind == "glue")
    row[PULL] = dribbler.pull
    row[SIDE] = dribbler.side
    row[REACH] = dribbler.reach
    row[CENTRING] = dribbler.centring
    row[IDLE_HOLD] = dribbler.idle_hold
    row[KICK_MAX] = kicker.max_speed
    row[KICK_DAMPING] = kicker.damping
    row[RECHARGE] = kicker.recharge
    row[CHIP_ANGLE] = radians(kicker.chip_angle or 0.0)
    row[CHIP_MAX] = kicker.max_chip_speed
    row[CHIP_YIELD] = kicker.chip_yield
    row[HOP_FIRST], row[HOP_OTHER], row[HOP_UP] = ball.first_hop, ball.other_hops, ball.rebound
    row[BOUNCE_WALL] = settings.contact.wall_restitution
    row[BALL_R] = BALL_RADIUS
    row[ROBOT_R] = ROBOT_RADIUS
    row[BALL_M] = ball.mass
    if dribbler.kind == "roller":
        row[ROLLER] = dribbler.roller_speed
        row[ROLLER_FRICTION] = dribbler.roller_friction
        row[GROUND_FRICTION] = dribbler.ground_friction
        row[BOUNCE_DRIVEN] = dribbler.roller_restitution
        row[BOUNCE_IDLE] = settings.contact.front_restitution
        row[BOUNCE_HULL] = settings.contact.hull_restitution
    row[HULL_FRICTION] = settings.contact.hull_friction
    row[JAW] = body.face
    if body.jaws is not None:
        row[JAW] = body.jaws.front
        row[HALF_OPENING] = body.jaws.opening / 2
        row[ROUNDING] = body.jaws.rounding
    if settings.shell is not None:
        row[CORE] = settings.shell.core
        row[SOLID] = settings.shell.core - SOFT
        row[HALF_WHEEL] = settings.shell.wheel_width / 2
        row[SOFTNESS] = settings.shell.softness
        row[FRONT_FRICTION] = settings.contact.front_friction
    return row


def wheel_row(wheels: WheelSettings | None) -> FloatArray:
    """Return an arena's row of parameters of its robots' wheels; a mass of 0 means that they have none."""
    row = np.zeros(WHEEL_PARAMETERS)
    if wheels is None:
        return row
    row[MASS] = wheels.mass
    row[INERTIA] = wheels.inertia
    # A cylinder that rolls resists as if half its mass were at the rim.
    row[RIM_MASS] = wheels.wheel_mass / 2
    row[MOTOR] = wheels.torque / wheels.radius
    row[MU_TANGENT] = wheels.tangent_friction
    row[MU_AXIAL] = wheels.axial_friction
    row[INNER], row[OUTER] = wheels.inner_edge, wheels.outer_edge
    row[COMMAND_RADIUS] = wheels.command_radius
    row[GAIN] = wheels.acceleration
    row[FRAME] = wheels.frame
    row[LOAD_LAG] = wheels.load_lag
    row[CENTRE] = wheels.centre
    row[GYRO] = wheels.wheel_mass / 2 * wheels.radius / (wheels.mass * wheels.height)
    angles = np.radians(wheels.angles)
    row[WHEEL_COS : WHEEL_COS + 4] = np.cos(angles)
    row[WHEEL_SIN : WHEEL_SIN + 4] = np.sin(angles)
    x, y = wheels.outer_edge * np.cos(angles), wheels.outer_edge * np.sin(angles)
    # Equal springs under a rigid body: the loads lie on a plane over the wheels' places.
    places = np.array([np.ones(4), x, y])
    plane = np.linalg.solve(places @ places.T, np.eye(3)).T @ places
    weight = wheels.mass * GRAVITY
    row[LOAD_REST : LOAD_REST + 4] = weight * plane[0] + weight * wheels.centre * plane[1]
    row[LOAD_AHEAD : LOAD_AHEAD + 4] = wheels.mass * wheels.height * plane[1]
    row[LOAD_ASIDE : LOAD_ASIDE + 4] = wheels.mass * wheels.height * plane[2]
    return row


def robot_row(limits: RobotLimits) -> FloatArray:
    """Return a robot's row of parameters."""
    row = np.zeros(ROBOT_PARAMETERS)
    row[MAX_SPEED] = limits.max_speed
    row[FORWARD_UP] = limits.acceleration
    row[FORWARD_DOWN] = limits.braking
    row[SIDE_UP] = limits.lateral_acceleration
    row[SIDE_DOWN] = limits.lateral_braking
    row[MAX_TURN] = limits.max_turn
    row[TURN_RATE] = limits.turn_acceleration
    return row
