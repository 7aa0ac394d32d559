"""One robot under many delays at once: how it would move, and how well that fits what is seen.

Compiled, because each sight of a robot is compared with a hundred predictions. The robot drives as
:mod:`robobt.world.driving` says.
"""

from __future__ import annotations

from math import sqrt
from typing import Protocol

from robobt.world.compiled import compiled_lean, record_dtype
from robobt.world.driving import LocalVelocity, drive, follow
from robobt.world.geometry import FloatArray
from robobt.world.records import LIMITS, Limits, Robot

_STEP = 0.0085
"""Longest step of the motion model: half of the time between two pictures at 60 Hz, and a little more [s]."""

_ROUNDING = 1e-9
"""Times closer than this are equal [s]."""

NOISE, HEADING_NOISE = 0.0015, 0.011
"""Standard deviation of detections: a little more than in ER-Force's Realistic [m, rad]."""

_START_SPEED, _START_TURN = 2.0, 5.0
"""Standard deviations of the velocity of a robot that has just been seen for the first time [m/s, rad/s]."""


class Uncertainty(Protocol):
    """Covariance of a position and its velocity: the variances ``pp`` and ``vv``, and ``pv``."""

    pp: float
    pv: float
    vv: float


class Hypothesis(Protocol):
    """A robot as it would be with one delay, and how likely that delay is.

    Attributes:
        robot: its pose and velocity in field coordinates.
        followed: what its controller follows.
        delay: from sending a command to its effect [s].
        misfit, turn_misfit: running means of the squared errors of place and heading, in variances.
        evidence: logarithm of the likelihood of what was seen, up to a constant.
        belief: share of the belief.
    """

    robot: Robot
    followed: LocalVelocity
    delay: float
    misfit: float
    turn_misfit: float
    evidence: float
    belief: float


class Sending(Protocol):
    """The velocity of a command [m/s, rad/s], and when it was sent [s].

    Not nested, because numba would otherwise take the simulator's longer commands for such velocities.
    """

    vx: float
    vy: float
    omega: float
    time: float


class SeenRobot(Protocol):
    """What was seen of a robot, and what is known of it under every hypothesis alike.

    Attributes:
        x, y, heading: where the robot is seen [m, rad].
        place, turn: how uncertain place and heading are.
    """

    x: float
    y: float
    heading: float
    place: Uncertainty
    turn: Uncertainty


HYPOTHESIS, SENDING, SEEN_ROBOT = record_dtype(Hypothesis), record_dtype(Sending), record_dtype(SeenRobot)


@compiled_lean
def advance(
    hypotheses_: FloatArray, sent_: FloatArray, limits_: FloatArray, begin: float, end: float
) -> None:
    """Move a robot on under each hypothesis.

    Args:
        hypotheses_: (n, ...) of :class:`Hypothesis`; changed.
        sent_: (m, ...) of :class:`Sending`, the oldest first.
        limits_: of the robot, :class:`~robobt.world.records.Limits`.
        begin: time of the hypotheses [s].
        end: to which they are moved [s].
    """
    hypotheses, sent = hypotheses_.view(HYPOTHESIS)[:, 0], sent_.view(SENDING)[:, 0]
    limits = limits_.view(LIMITS)[0]
    for i in range(len(hypotheses)):
        it = hypotheses[i]
        now, index = begin, len(sent) - 1
        while index >= 0 and sent[index].time + it.delay > now + _ROUNDING:
            index -= 1
        while now < end - _ROUNDING:
            until = end
            if index + 1 < len(sent):
                until = min(until, sent[index + 1].time + it.delay)
            if index >= 0:
                _move(it.robot, it.followed, sent[index], limits, until - now)
            else:
                _drift(it.robot, until - now)
            now = until
            while index + 1 < len(sent) and sent[index + 1].time + it.delay <= now + _ROUNDING:
                index += 1


@compiled_lean
def _move(robot: Robot, followed: LocalVelocity, command: LocalVelocity, limits: Limits, time: float) -> None:
    """Move a robot on under one command for a time [s]."""
    steps = max(1, int(time / _STEP + 0.999))
    dt = time / steps
    for _ in range(steps):
        vx, vy, omega = robot.vx, robot.vy, robot.omega
        follow(followed, command, limits, dt)
        drive(robot, followed, limits, dt)
        robot.x += 0.5 * dt * (vx + robot.vx)
        robot.y += 0.5 * dt * (vy + robot.vy)
        robot.heading += 0.5 * dt * (omega + robot.omega)


@compiled_lean
def _drift(robot: Robot, time: float) -> None:
    """Move a robot whose command is unknown on at its velocity for a time [s]."""
    robot.x += time * robot.vx
    robot.y += time * robot.vy
    robot.heading += time * robot.omega


@compiled_lean
def start(hypotheses_: FloatArray, sight_: FloatArray) -> None:
    """Take a robot to be where it is seen, at an unknown velocity; keep what is believed of its delay.

    Args:
        hypotheses_: (n, ...) of :class:`Hypothesis`; changed.
        sight_: a :class:`SeenRobot`; its uncertainty is changed.
    """
    hypotheses, sight = hypotheses_.view(HYPOTHESIS)[:, 0], sight_.view(SEEN_ROBOT)[0]
    for i in range(len(hypotheses)):
        robot = hypotheses[i].robot
        robot.x, robot.y, robot.heading = sight.x, sight.y, sight.heading
        robot.vx = robot.vy = robot.omega = 0.0
    sight.place.pp, sight.place.pv, sight.place.vv = NOISE * NOISE, 0.0, _START_SPEED * _START_SPEED
    sight.turn.pp, sight.turn.pv = HEADING_NOISE * HEADING_NOISE, 0.0
    sight.turn.vv = _START_TURN * _START_TURN


@compiled_lean
def nearest(hypotheses_: FloatArray, sight_: FloatArray) -> float:
    """Return how far the nearest prediction is from where the robot is seen [m].

    Args:
        hypotheses_: (n, ...) of :class:`Hypothesis`.
        sight_: a :class:`SeenRobot`.
    """
    hypotheses, sight = hypotheses_.view(HYPOTHESIS)[:, 0], sight_.view(SEEN_ROBOT)[0]
    square = 1e9
    for i in range(len(hypotheses)):
        robot = hypotheses[i].robot
        dx, dy = sight.x - robot.x, sight.y - robot.y
        square = min(square, dx * dx + dy * dy)
    return sqrt(square)
