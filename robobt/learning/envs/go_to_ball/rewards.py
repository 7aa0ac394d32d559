"""The reward of Go-To-Ball: its weights and terms.

For a new term, add its weight to :class:`GoToBallReward`, its name to :class:`GoToBallTerms` and the term to
:func:`reward`.
"""

from __future__ import annotations

from math import exp, hypot, pi, sqrt
from typing import Protocol

from robobt.config.validation import Settings
from robobt.learning.envs.settings import weight
from robobt.learning.envs.task import FloatArray
from robobt.world.compiled import compilable
from robobt.world.geometry import wrap_angle
from robobt.world.records import Ball, Robot

_CROWDED_GAP = 0.2
"""Gap from which another robot no longer counts as near [m]."""
_BELL = 1.0 / sqrt(2.0 * pi)


class GoToBallReward(Settings):
    """Weights of the reward's terms."""

    contact: float = weight(100.0, "Eq. 7: once, on reaching the ball")
    distance: float = weight(1.0, "times 5/sqrt(2 pi) exp(-d^2/2) - 2, Eq. 8")
    orientation: float = weight(1.0, "times 1/sqrt(2 pi) exp(-2 |theta|/pi^2), Eq. 9")
    closing: float = weight(0.0, "times the closing speed to its target, relative to the ball [m/s]")
    time: float = weight(0.0, "subtracted in every tick")
    touched: float = weight(0.0, "subtracted when another robot is touched")
    near: float = weight(0.0, "subtracted near another robot, falling linearly with the gap to 0 at 0.2 m")


class GoToBallTerms(Protocol):
    """Sum of each term since the episode's start, by the name of its weight."""

    distance: float
    orientation: float
    closing: float
    time: float
    near: float
    touched: float
    contact: float


@compilable
def reward(
    weights: GoToBallReward,
    robot: Robot,
    ball: Ball,
    action: FloatArray,  # noqa: ARG001 - for terms to come
    reached: bool,
    place: tuple[float, float, float],
    gap: float,
    touched: bool,
    terms: GoToBallTerms,
) -> float:
    """Compute the reward of a step.

    Args:
        weights: weights of the terms.
        robot: the robot after the step.
        ball: the ball after the step.
        action: (3,) action of the step, in [-1, 1].
        reached: whether the robot has reached the ball.
        place: target of the robot [m] (the ball, or behind it in order to shoot) and final heading [rad].
        gap: distance from hull to hull of the nearest other robot [m], infinite without one.
        touched: whether the robot has touched another one.
        terms: sums of the episode, which are updated.
    """
    x, y, facing = place
    dx, dy = x - robot.x, y - robot.y
    distance = hypot(dx, dy)
    angle = abs(wrap_angle(facing - robot.heading))
    near_it = weights.distance * (5.0 * _BELL * exp(-0.5 * distance * distance) - 2.0)  # Eq. 8
    towards_it = weights.orientation * _BELL * exp(-2.0 * angle / (pi * pi))  # Eq. 9
    terms.distance += near_it
    terms.orientation += towards_it
    total = near_it + towards_it
    if distance > 0.0:
        # Relative to the ball: a robot that pushes the ball along comes no closer.
        closing = dx * (robot.vx - ball.vx) + dy * (robot.vy - ball.vy)
        closing = weights.closing * closing / distance
        terms.closing += closing
        total += closing
    crowded = weights.near * max(1.0 - gap / _CROWDED_GAP, 0.0)
    terms.time -= weights.time
    terms.near -= crowded
    total -= weights.time + crowded
    if touched:
        terms.touched -= weights.touched
        total -= weights.touched
    if reached:
        terms.contact += weights.contact
        total += weights.contact  # Eq. 7
    return total
