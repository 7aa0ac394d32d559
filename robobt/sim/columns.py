"""What the columns of the simulator's arrays mean, and how they are filled from settings."""

from __future__ import annotations

import numpy as np

from robobt.sim.settings import SimSettings
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

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
    row[BALL_R] = BALL_RADIUS
    row[ROBOT_R] = ROBOT_RADIUS
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
