"""Bounds of observation entries, for Gymnasium's spaces."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, inf, sqrt

import numpy as np
from gymnasium.spaces import Box

from robobt.config.errors import unknown_name
from robobt.learning.envs.perception import CUT_OFF
from robobt.learning.envs.settings import TaskSettings
from robobt.models.actions import ActionScaling
from robobt.world.observation import ObservationSpec
from robobt.world.state import ROBOT_RADIUS

BUMP = 0.5
"""Speed that a collision may add for an instant [m/s]."""


def bounded(spec: ObservationSpec, ranges: Mapping[str, float]) -> Box[np.float32]:
    """Return the space of the vectors of ``spec``; ``ranges`` has the largest values of its quantities.

    Raises:
        ValueError: an entry's range names none of them.
    """
    for one in spec.entries:
        if isinstance(one.range, str) and one.range not in ranges:
            hint = unknown_name(one.range, ranges)
            raise ValueError(f"the entry {one.name!r} has no known range, {one.range!r}; {hint}")
    high = [ranges[one.range] if isinstance(one.range, str) else one.range for one in spec.entries]
    low = [-most if one.signed else 0.0 for one, most in zip(spec.entries, high, strict=True)]
    return Box(np.array(low, dtype=np.float32), np.array(high, dtype=np.float32), dtype=np.float32)


def scale_of(spec: ObservationSpec, action: ActionScaling) -> tuple[float, ...]:
    """Return the typical magnitude of each entry of ``spec`` for a robot with this ``action``.

    Raises:
        ValueError: a magnitude is not above 0, such as the top speed of an action that does not drive.
    """
    sizes = [one.scale for one in spec.entries]
    found = tuple([getattr(action, size) if isinstance(size, str) else size for size in sizes])
    for one, scale in zip(spec.entries, found, strict=True):
        if not 0.0 < scale < inf:
            raise ValueError(f"the scale of the entry {one.name!r} must be above 0, not {scale!r}")
    return found


def ranges_of(settings: TaskSettings) -> dict[str, float]:
    """Return the largest values of the quantities that most observations name as ranges."""
    noise, limits, own = settings.noise, settings.simulator.limits, settings.robot_limits
    fastest = own.max_speed * max(settings.randomisation.top_speed)
    driven = max(fastest, limits.max_speed) + BUMP
    turned = max(own.max_turn, limits.max_turn) + driven / ROBOT_RADIUS
    # A moving, turning robot can add at most this speed to a kicked ball.
    kicked = settings.simulator.kicker.max_speed + driven + turned * ROBOT_RADIUS + BUMP
    far = farthest(settings)
    return {
        "far": far,
        "goal": far + settings.field.goal_width,
        "speed": seen_speed(settings, driven, noise.robot_position),
        "turn": seen_turn(settings, turned),
        "ball_speed": seen_speed(settings, max(kicked, settings.ball_speed), noise.ball_position),
    }


def farthest(settings: TaskSettings) -> float:
    """Return the diagonal inside the walls plus the most that noise may add [m]."""
    field, noise = settings.field, settings.noise
    inside = hypot(field.length + 2 * field.goal_line_margin, field.width + 2 * field.margin)
    return inside + CUT_OFF * sqrt(2.0) * (noise.robot_position + noise.ball_position)


def seen_speed(settings: TaskSettings, speed: float, position: float) -> float:
    """Return the largest observed speed of a body this fast with position noise ``position`` [m/s]."""
    if settings.velocities == "finite_difference":
        return speed + 2.0 * CUT_OFF * sqrt(2.0) * position / settings.period
    return speed + CUT_OFF * sqrt(2.0) * settings.noise.velocity


def seen_turn(settings: TaskSettings, turn: float) -> float:
    """Return the largest observed turning rate of a robot that turns this fast [rad/s]."""
    if settings.velocities == "finite_difference":
        return turn + 2.0 * CUT_OFF * settings.noise.heading / settings.period
    return turn + CUT_OFF * settings.noise.turn_rate
