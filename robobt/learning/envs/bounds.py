"""What the entries of observations and actions can be at most: Gymnasium's spaces."""

from __future__ import annotations

from math import hypot, sqrt

import numpy as np
from gymnasium.spaces import Box

from robobt.learning.envs.go_to_ball import GoToBallTask
from robobt.learning.envs.perception import CUT_OFF
from robobt.learning.envs.settings import GoToBallSettings, ShootSettings, TaskSettings
from robobt.learning.envs.shoot import ShootTask
from robobt.world.state import ROBOT_RADIUS

_BUMP = 0.5
"""What a collision may add to a speed for an instant [m/s]."""


def action_space(task: GoToBallTask | ShootTask) -> Box[np.float32]:
    """[-1, 1] for every entry, float32."""
    return Box(-1.0, 1.0, (task.action_size,), np.float32)


def observation_space(task: GoToBallTask | ShootTask) -> Box[np.float32]:
    """Bounds that follow from walls, limits, kicker and noise, float32."""
    if isinstance(task, GoToBallTask):
        high = _go_to_ball(task.settings)
        low = [-value for value in high]
        low[2] = 0.0
    else:
        high = _shoot(task.settings)
        low = [-value for value in high]
        low[5] = 0.0
    return Box(np.array(low, dtype=np.float32), np.array(high, dtype=np.float32), dtype=np.float32)


def _go_to_ball(settings: GoToBallSettings) -> list[float]:
    limits, starts = settings.robot_limits, settings.starts
    speed = max(min(limits.max_speed, settings.action.max_speed), starts.robot_speed[1]) + _BUMP
    speed += max(0.0, starts.ball_speed[1])
    turn = max(
        min(limits.max_turn, settings.action.max_turn), abs(starts.robot_turn[0]), abs(starts.robot_turn[1])
    )
    # Sliding along a wall turns a robot, at most until it rolls along it.
    turn += speed / ROBOT_RADIUS
    seen = _seen_speed(settings, speed, settings.noise.robot_position)
    return [1.0, 1.0, _farthest(settings), seen, seen, _seen_turn(settings, turn)]


def _shoot(settings: ShootSettings) -> list[float]:
    starts = settings.starts
    farthest = _farthest(settings)
    most_turn = max(settings.action.max_turn, abs(starts.robot_turn[0]), abs(starts.robot_turn[1]))
    speed = settings.simulator.kicker.max_speed + most_turn * ROBOT_RADIUS * 2.0 + _BUMP
    seen = _seen_speed(settings, speed, settings.noise.ball_position)
    turn = _seen_turn(settings, most_turn + _BUMP / ROBOT_RADIUS)
    return [farthest, farthest, seen, seen, turn, farthest, 1.0, 1.0, 1.0, 1.0]


def _farthest(settings: TaskSettings) -> float:
    """The inside of the walls from corner to corner, and what noise may add [m]."""
    field, noise = settings.field, settings.noise
    inside = hypot(field.length + 2 * field.margin, field.width + 2 * field.margin)
    return inside + CUT_OFF * sqrt(2.0) * (noise.robot_position + noise.ball_position)


def _seen_speed(settings: TaskSettings, speed: float, position: float) -> float:
    if settings.velocities == "finite_difference":
        return speed + 2.0 * CUT_OFF * sqrt(2.0) * position / settings.period
    return speed + CUT_OFF * sqrt(2.0) * settings.noise.velocity


def _seen_turn(settings: TaskSettings, turn: float) -> float:
    if settings.velocities == "finite_difference":
        return turn + 2.0 * CUT_OFF * settings.noise.heading / settings.period
    return turn + CUT_OFF * settings.noise.turn_rate
