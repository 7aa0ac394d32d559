"""A robot's state from noisy, delayed detections and the commands it was sent.

A Kalman filter with constant velocity between commands. Its process noise is
almost zero while the detections agree with the model, which makes the estimate
steady, and grows as soon as the innovations point in one direction.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, hypot, sin, sqrt
from typing import NamedTuple

from robobt.league.estimate.kalman import Mismatch
from robobt.league.estimate.offsets import MeanOffsets, OffsetCovariance
from robobt.league.estimate.rivals import Rivals
from robobt.world.answer import FollowedCommand, followed_until
from robobt.world.command import RobotCommand
from robobt.world.driving import drive, follow
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits


class Sent(NamedTuple):
    """A command, and when it takes effect [s]."""

    since: float
    command: RobotCommand


SentCommands = list[Sent]
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


_TURNING_STEP = 0.005
"""Longest step of the motion model, as a commanded velocity turns with the robot [s]."""

_NOISE, _TURN_NOISE = 0.03, 0.4
"""Acceleration noise while the model fits [m/s^2, rad/s^2]."""

_MANOEUVRE_NOISE, _TURN_MANOEUVRE_NOISE = 6.0, 60.0
"""Additional acceleration noise while the model does not fit: what robots can do [m/s^2, rad/s^2]."""

_COMMAND_ERROR = 0.1
"""Relative error of the acceleration that commands cause in the model."""


_ROBOT_OFFSET_SPREAD, _HEADING_OFFSET_SPREAD = 0.03, 0.03
"""Standard deviation of a camera's offset about its mean [m, rad]."""

_HEADING_GATE = 6.0
"""Largest deviation of a heading, in standard deviations."""

_HEADING_REACH = 0.6
"""Headings this close to each other agree [rad]."""

_COLLISION_SPIN = 15.0
"""Turning rate that a robot may get in a collision [rad/s]."""

_HEADING_CONFIRMATIONS, _SPUN_CONFIRMATIONS = 10, 3
"""Number of agreeing headings in a row beyond the gate that are believed, and of such as a spin explains."""

_HEADING_PERIOD = 0.03
"""Headings that come at least this often leave no gap in which a robot turns unseen [s]."""


@dataclass(slots=True)
class RobotSensing:
    """How cameras see robots: standard deviations of detections [m, rad], and the cameras' mean offsets."""

    noise: float
    heading_noise: float
    offsets: MeanOffsets = field(default_factory=lambda: MeanOffsets(2))
    heading_offsets: MeanOffsets = field(default_factory=lambda: MeanOffsets(1))


class RobotTrack:
    """The estimate of one robot.

    It begins with a ``camera``'s detection at ``time`` [m, rad, s].

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
        camera: int,
        limits: RobotLimits,
        sensing: RobotSensing,
    ) -> None:
        self.limits = limits
        self._sensing = sensing
        self._r, self._rh = sensing.noise**2, sensing.heading_noise**2
        self.restart(x, y, heading, time, camera)

    def restart(self, x: float, y: float, heading: float, time: float, camera: int) -> None:
        """Restart the track at rest at a camera's detection."""
        self.time = time
        self._position = OffsetCovariance(1.0, _ROBOT_OFFSET_SPREAD, self._sensing.offsets)
        dx, dy = self._position.begin(camera, time, self._r)
        self.motion = RobotMotion(x - dx, y - dy, heading)
        self._mismatch = Mismatch()
        self._headings = Rivals(_HEADING_CONFIRMATIONS, _HEADING_REACH, _COLLISION_SPIN)
        self._headings.saw_track(camera, 1.0, time)
        self._restart_heading(heading, time, camera)

    def _restart_heading(self, heading: float, time: float, camera: int) -> None:
        self._heading = OffsetCovariance(
            _COLLISION_SPIN**2, _HEADING_OFFSET_SPREAD, self._sensing.heading_offsets
        )
        (offset,) = self._heading.begin(camera, time, self._rh)
        self.motion.heading, self.motion.omega = wrap_angle(heading - offset), 0.0
        self._heading_mismatch = Mismatch()
        self._heading_seen = self._heading_used = time

    def advance(self, time: float, commands: SentCommands) -> None:
        """Predict the estimate to ``time`` under the commands that were in force."""
        dt = time - self.time
        if dt <= 0.0:
            return
        before = self.motion
        after = self.motion = predict_robot(before, self.time, time, commands, self.limits)
        shift = self._position.settle(dt)
        if shift is not None:
            dx, dy = shift
            after.x += dx
            after.y += dy
        shift = self._heading.settle(dt)
        if shift is not None:
            (turn,) = shift
            after.heading = wrap_angle(after.heading + turn)
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
        return sqrt(max(0.0, self._position.position_variance))

    def deviation(self, x: float, y: float, camera: int) -> float:
        """Return the distance of a camera's detection at the track's time from the prediction [m]."""
        dx, dy = self._position.offset(camera)
        return hypot(x - dx - self.motion.x, y - dy - self.motion.y)

    def correct(self, x: float, y: float, camera: int) -> None:
        """Correct the estimate with the place at which a camera saw the robot at the track's time."""
        m, p = self.motion, self._position
        ox, oy = p.offset(camera)
        s = p.detection_variance(camera) + self._r
        dx, dy = x - ox - m.x, y - oy - m.y
        k, g = p.correct(camera, self.time, s, [dx, dy])
        m.x += k * dx
        m.y += k * dy
        m.vx += g * dx
        m.vy += g * dy
        scale = 1.0 / sqrt(s)
        self._mismatch.update(dx * scale, dy * scale)
        p.teach()

    def correct_heading(self, heading: float, camera: int, confidence: float) -> None:
        """Correct the estimate with the heading at which a camera saw the robot at the track's time.

        A heading far from the prediction, as of a pattern that was misread, is left out until it is
        confirmed.
        """
        m, p, time = self.motion, self._heading, self.time
        dh = wrap_angle(heading - p.offset(camera)[0] - m.heading)
        s = p.detection_variance(camera) + self._rh
        unseen, self._heading_seen = time - self._heading_seen, time
        gate = _HEADING_GATE * sqrt(s) + self.limits.turn_acceleration * unseen**2 / 2
        gate += self.limits.max_turn * max(0.0, unseen - _HEADING_PERIOD)
        if abs(dh) > gate:
            spun = abs(dh) < _HEADING_REACH + _COLLISION_SPIN * (time - self._heading_used)
            if self._headings.believes(
                cos(heading),
                sin(heading),
                camera,
                confidence,
                time,
                confirmations=_SPUN_CONFIRMATIONS if spun else _HEADING_CONFIRMATIONS,
            ):
                self._restart_heading(heading, time, camera)
            return
        self._headings.saw_track(camera, confidence, time)
        self._heading_used = time
        if abs(dh) > _HEADING_REACH:
            self._restart_heading(heading, time, camera)
            return
        k, g = p.correct(camera, time, s, [dh])
        m.heading = wrap_angle(m.heading + k * dh)
        m.omega += g * dh
        self._heading_mismatch.update(dh / sqrt(s))
        p.teach()


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
    followed = FollowedCommand()
    if limits.longest_lag > 0.0:
        followed = followed_until(commands, limits, start)
    while now < end - 1e-9:
        while index < len(commands) and commands[index].since <= now + 1e-9:
            index += 1
        until = min(end, commands[index].since) if index < len(commands) else end
        until = min(until, now + _TURNING_STEP)
        dt = until - now
        vx, vy, omega = state.vx, state.vy, state.omega
        if index:
            follow(followed, commands[index - 1].command, limits, dt)
            drive(state, followed, limits, dt)
        state.x += (vx + state.vx) / 2.0 * dt
        state.y += (vy + state.vy) / 2.0 * dt
        state.heading = wrap_angle(state.heading + (omega + state.omega) / 2.0 * dt)
        now = until
    return state
