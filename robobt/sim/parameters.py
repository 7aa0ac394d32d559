"""The parameters of arenas, as records from settings."""

from __future__ import annotations

from math import radians

import numpy as np

from robobt.sim.bodies import SOFT
from robobt.sim.records import PARAMETERS, WHEELS, RecordArray, filled
from robobt.sim.robot_settings import WheelSettings
from robobt.sim.settings import SimSettings
from robobt.world.ball_model import GRAVITY
from robobt.world.compiled import numbers_of
from robobt.world.geometry import FloatArray


def arena_parameters(settings: SimSettings) -> RecordArray:
    """Return an arena's :class:`~robobt.sim.records.Parameters`."""
    dribbler, jaws, shell = settings.dribbler, settings.body.jaws, settings.shell
    share, parts = settings.ball.switch_share, ("ball", "body", "dribbler", "kicker", "contact")
    return filled(
        PARAMETERS,
        None,
        **{part: tuple(numbers_of(getattr(settings, part))) for part in parts},
        # So that a ball without spin rolls at switch_share of its speed.
        spin_gain=share / (1.0 - share),
        half_mouth=settings.body.mouth_width / 2,
        glue=dribbler.kind == "glue",
        roller=dribbler.roller_speed if dribbler.kind == "roller" else 0.0,
        kicker_angle=radians(settings.kicker.chip_angle or 0.0),
        front=settings.body.face if jaws is None else jaws.front,
        half_opening=0.0 if jaws is None else jaws.opening / 2,
        rounding=0.0 if jaws is None else jaws.rounding,
        core=0.0 if shell is None else shell.core,
        solid=0.0 if shell is None else shell.core - SOFT,
        half_wheel=0.0 if shell is None else shell.wheel_width / 2,
        softness=0.0 if shell is None else shell.softness,
    )


def rolling_speeds(wheels: WheelSettings, robots: FloatArray) -> FloatArray:
    """Return how fast the wheels of robots turn that roll without slipping, (..., 4) [m/s].

    Args:
        wheels: of the robots.
        robots: (..., 6) x, y, heading, vx, vy, omega [m, rad, m/s, rad/s].
    """
    heading, vx, vy, turn = (robots[..., i, None] for i in range(2, 6))
    angles = np.radians(wheels.angles)
    ahead = np.cos(heading) * vx + np.sin(heading) * vy
    aside = np.cos(heading) * vy - np.sin(heading) * vx
    arm = (wheels.inner_edge + wheels.outer_edge) / 2
    speeds: FloatArray = arm * turn - ahead * np.sin(angles) + aside * np.cos(angles)
    return speeds


def wheel_parameters(wheels: WheelSettings | None) -> RecordArray:
    """Return an arena's :class:`~robobt.sim.records.Wheels`."""
    if wheels is None:
        return np.zeros((), WHEELS)
    angles = np.radians(wheels.angles)
    cos, sin = np.cos(angles), np.sin(angles)
    x, y = wheels.outer_edge * cos, wheels.outer_edge * sin
    # Equal springs under a rigid body: the loads lie on a plane over the wheels' places.
    places = np.array([np.ones(4), x, y])
    rest, ahead, aside = np.linalg.solve(places @ places.T, np.eye(3)).T @ places
    weight = wheels.mass * GRAVITY
    loads = weight * rest + weight * wheels.centre * ahead
    moved = wheels.mass * wheels.height
    moved_ahead, moved_aside = moved * wheels.grip_ahead, moved * wheels.grip_aside
    # A turning wheel's resistance moves load too, and that the grip feels whole.
    turned = wheels.wheel_mass / 2 * wheels.radius
    return filled(
        WHEELS,
        wheels,
        # A cylinder that rolls resists as if half its mass were at the rim.
        rim_mass=wheels.wheel_mass / 2,
        motor=wheels.torque / wheels.radius,
        gyro_ahead=turned / moved_ahead,
        gyro_aside=turned / moved_aside,
        motor_ahead=(1.0 - wheels.grip_ahead) * wheels.radius / moved_ahead,
        motor_aside=(1.0 - wheels.grip_aside) * wheels.radius / moved_aside,
        each=list(zip(cos, sin, loads, moved_ahead * ahead, moved_aside * aside, strict=True)),
    )
