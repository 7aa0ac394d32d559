"""A robot's state from noisy, delayed detections and the commands it was sent.

A Kalman filter with constant velocity between commands. Its process noise is
almost zero while the detections agree with the model, which makes the estimate
steady, and grows as soon as the innovations point in one direction.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin, sqrt

from robobt.league.estimate.kalman import Covariance, Mismatch
from robobt.world.command import RobotCommand
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits

SentCommands = list[tuple[float, RobotCommand]]
"""A robot's commands and when they take effect [s], oldest first."""


@dataclass(slots=True)
class RobotMotion:
    """A robot's pose and velocity in field coordinates [m, rad, m/s, rad/s]."""

    x: float
    y: float
    heading: float
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0


_STEP = 0.005
"""Longest step of the motion model, as a commanded velocity turns with the robot [s]."""

_NOISE, _TURN_NOISE = 0.03, 0.4
"""Acceleration noise while the model fits [m/s^2, rad/s^2]."""

_MANOEUVRE_NOISE, _TURN_MANOEUVRE_NOISE = 6.0, 60.0
"""Additional acceleration noise while the model does not fit: what robots can do [m/s^2, rad/s^2]."""

_COMMAND_ERROR = 0.1
"""Relative error of the acceleration that commands cause in the model."""


class RobotTrack:
    """The estimate of one robot.

    It begins with a first detection; detections deviate by ``noise`` [m] and ``heading_noise`` [rad].

    Attributes:
        motion: the estimate at ``time``.
        time: timestamp of the last detection that was used [s].
    """

    def __init__(
        self,
        x: float,
        y: float,
        heading: float,
        time: float,
        limits: RobotLimits,
        noise: float,
        heading_noise: float,
    ) -> None:
        self.limits = limits
        self._r, self._rh = noise * noise, heading_noise * heading_noise
        self.restart(x, y, heading, time)

    def restart(self, x: float, y: float, heading: float, time: float) -> None:
        """Restart the track at rest at a detection."""
        self.motion = RobotMotion(x, y, heading)
        self.time = time
        self._position = Covariance(self._r, 0.0, 1.0)
        self._heading = Covariance(self._rh, 0.0, 10.0)
        self._mismatch, self._heading_mismatch = Mismatch(), Mismatch()

    def advance(self, time: float, commands: SentCommands) -> None:
        """Predict the estimate to ``time`` under the commands that were in force."""
        dt = time - self.time
        if dt <= 0.0:
            return
        before = self.motion
        after = self.motion = predict_robot(before, self.time, time, commands, self.limits)
        acceleration = hypot(after.vx - before.vx, after.vy - before.vy) / dt
        turn_acceleration = abs(after.omega - before.omega) / dt
        self._position.predict(
            _NOISE + _COMMAND_ERROR * acceleration + self._mismatch.level * _MANOEUVRE_NOISE, dt
        )
        self._heading.predict(
            _TURN_NOISE
            + _COMMAND_ERROR * turn_acceleration
            + self._heading_mismatch.level * _TURN_MANOEUVRE_NOISE,
            dt,
        )
        self.time = time

    @property
    def spread(self) -> float:
        """Standard deviation of the position in each direction [m]."""
        return sqrt(max(0.0, self._position.pp))

    def deviation(self, x: float, y: float) -> float:
        """Return the distance of a detection at the track's time from the prediction [m]."""
        return hypot(x - self.motion.x, y - self.motion.y)

    def correct(self, x: float, y: float, heading: float | None) -> None:
        """Correct the estimate with a detection captured at the track's time."""
        m = self.motion
        s = self._position.pp + self._r
        dx, dy = x - m.x, y - m.y
        k, g = self._position.gains(s)
        m.x += k * dx
        m.y += k * dy
        m.vx += g * dx
        m.vy += g * dy
        self._position.correct(k, g)
        scale = 1.0 / sqrt(s)
        self._mismatch.update(dx * scale, dy * scale)
        if heading is not None:
            s = self._heading.pp + self._rh
            dh = wrap_angle(heading - m.heading)
            k, g = self._heading.gains(s)
            m.heading = wrap_angle(m.heading + k * dh)
            m.omega += g * dh
            self._heading.correct(k, g)
            self._heading_mismatch.update(dh / sqrt(s))


def predict_robot(
    motion: RobotMotion, start: float, end: float, commands: SentCommands, limits: RobotLimits
) -> RobotMotion:
    """Return a robot's motion at ``end``, given that at ``start`` and the commands it was sent.

    Before the first command, and without any, the robot keeps its velocity.
    """
    # Copied by hand, as dataclasses.replace takes longer than the prediction itself.
    state = RobotMotion(motion.x, motion.y, motion.heading, motion.vx, motion.vy, motion.omega)
    now = start
    index = 0
    while now < end - 1e-9:
        while index < len(commands) and commands[index][0] <= now + 1e-9:
            index += 1
        until = min(end, commands[index][0]) if index < len(commands) else end
        until = min(until, now + _STEP)
        _drive(state, commands[index - 1][1] if index else None, limits, until - now)
        now = until
    return state


def _drive(state: RobotMotion, command: RobotCommand | None, limits: RobotLimits, dt: float) -> None:
    """Drive one step; a robot's wheels limit its acceleration to an ellipse in its own frame."""
    vx, vy, omega = state.vx, state.vy, state.omega
    if command is not None:
        c, s = cos(state.heading), sin(state.heading)
        dx = c * command.vx - s * command.vy - vx
        dy = s * command.vx + c * command.vy - vy
        size = hypot(dx, dy)
        if size > 0.0:
            ahead, aside = (c * dx + s * dy) / size, (c * dy - s * dx) / size
            if dx * vx + dy * vy < 0.0:
                along, across = limits.braking, limits.lateral_braking
            else:
                along, across = limits.acceleration, limits.lateral_acceleration
            share = min(1.0, dt / (sqrt((ahead / along) ** 2 + (aside / across) ** 2) * size))
            state.vx = vx + dx * share
            state.vy = vy + dy * share
        most = limits.turn_acceleration * dt
        state.omega = omega + min(max(command.omega - omega, -most), most)
    state.x += (vx + state.vx) / 2.0 * dt
    state.y += (vy + state.vy) / 2.0 * dt
    state.heading = wrap_angle(state.heading + (omega + state.omega) / 2.0 * dt)
