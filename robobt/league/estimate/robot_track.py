"""One robot's state from noisy, late detections and the commands it was sent.

A Kalman filter with constant velocity between commands. Its process noise is
next to nothing while the detections agree with the model, which is what makes
the estimate steady, and grows as soon as their deviations point in one direction.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin, sqrt

from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits


@dataclass(slots=True)
class SentCommand:
    """A robot's velocity command, in its own frame, in force from ``time`` on [s, m/s, rad/s]."""

    time: float
    vx: float
    vy: float
    omega: float


@dataclass(slots=True)
class Motion:
    """A robot's pose and velocity in field coordinates [m, rad, m/s, rad/s]."""

    x: float
    y: float
    heading: float
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0


_STEP = 0.005
"""Longest step of the motion model; a commanded velocity turns with the robot [s]."""

_CALM = 0.03
"""Acceleration noise while the model fits [m/s^2]."""

_CALM_TURN = 0.4
"""The same of the heading [rad/s^2]."""

_WILD = 6.0
"""Acceleration noise while it does not: what robots can do [m/s^2]."""

_WILD_TURN = 60.0

_DRIVEN = 0.1
"""Share of a commanded acceleration that the model may be wrong by."""

MEMORY = 0.25
"""Weight of the newest deviation in the running mean that tells a manoeuvre from noise."""

_SUSPECT = 4.0
"""Squared running mean, in variances, from which on the model is doubted."""

_CERTAIN = 16.0
"""The same from which on it is not believed at all."""


class RobotTrack:
    """The estimate of one robot.

    Args:
        x, y, heading: first detection [m, rad].
        time: of the capture [s].
        limits: what the robot can do.
        noise: standard deviation of detections [m].
        heading_noise: the same of headings [rad].

    Attributes:
        motion: the estimate at ``time``.
        time: of the last detection that was used [s].
        seen: how many were used.
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
        """Begin anew where the robot is now."""
        self.motion = Motion(x, y, heading)
        self.time = time
        self.seen = 1
        self._pp, self._pv, self._vv = self._r, 0.0, 1.0
        self._hh, self._hw, self._ww = self._rh, 0.0, 10.0
        self._mean_x = self._mean_y = self._mean_h = 0.0
        self._doubt = self._doubt_h = 0.0

    def advance(self, time: float, commands: list[SentCommand]) -> None:
        """Move the estimate on to ``time`` under the commands that were in force."""
        dt = time - self.time
        if dt <= 0.0:
            return
        before = self.motion
        after = self.motion = predicted(before, self.time, time, commands, self.limits)
        driven = hypot(after.vx - before.vx, after.vy - before.vy) / dt
        turned = abs(after.omega - before.omega) / dt
        a = _CALM + _DRIVEN * driven + self._doubt * _WILD
        h = _CALM_TURN + _DRIVEN * turned + self._doubt_h * _WILD_TURN
        self._pp, self._pv, self._vv = grown(self._pp, self._pv, self._vv, a, dt)
        self._hh, self._hw, self._ww = grown(self._hh, self._hw, self._ww, h, dt)
        self.time = time

    def deviation(self, x: float, y: float) -> float:
        """Distance of a detection at the track's time from what is expected [m]."""
        return hypot(x - self.motion.x, y - self.motion.y)

    def correct(self, x: float, y: float, heading: float | None) -> None:
        """Use a detection captured at the track's time."""
        m = self.motion
        s = self._pp + self._r
        dx, dy = x - m.x, y - m.y
        k, g = self._pp / s, self._pv / s
        m.x += k * dx
        m.y += k * dy
        m.vx += g * dx
        m.vy += g * dy
        self._vv -= g * self._pv
        self._pv *= 1.0 - k
        self._pp *= 1.0 - k
        scale = 1.0 / sqrt(s)
        self._mean_x += MEMORY * (dx * scale - self._mean_x)
        self._mean_y += MEMORY * (dy * scale - self._mean_y)
        self._doubt = doubt((self._mean_x**2 + self._mean_y**2) / 2)
        if heading is not None:
            s = self._hh + self._rh
            dh = wrap_angle(heading - m.heading)
            k, g = self._hh / s, self._hw / s
            m.heading = wrap_angle(m.heading + k * dh)
            m.omega += g * dh
            self._ww -= g * self._hw
            self._hw *= 1.0 - k
            self._hh *= 1.0 - k
            self._mean_h += MEMORY * (dh / sqrt(s) - self._mean_h)
            self._doubt_h = doubt(self._mean_h**2)
        self.seen += 1


def doubt(mean_square: float) -> float:
    """How little the model is to be believed, 0 to 1.

    Args:
        mean_square: square of the running mean of deviations, each in units of its expected spread.
    """
    # What the running mean of white deviations has as its variance.
    variance = MEMORY / (2.0 - MEMORY)
    return min(1.0, max(0.0, (mean_square / variance - _SUSPECT) / (_CERTAIN - _SUSPECT)))


def grown(pp: float, pv: float, vv: float, noise: float, dt: float) -> tuple[float, float, float]:
    """Variances of position and velocity after ``dt`` seconds under an acceleration noise [m/s^2]."""
    q = noise * noise
    return (
        pp + dt * (2.0 * pv + dt * (vv + q * dt * dt / 4.0)),
        pv + dt * (vv + q * dt * dt / 2.0),
        vv + q * dt * dt,
    )


def predicted(
    motion: Motion, start: float, end: float, commands: list[SentCommand], limits: RobotLimits
) -> Motion:
    """Where a robot gets from ``start`` to ``end`` under the commands it was sent.

    Args:
        commands: oldest first; before the first, and without any, it keeps its velocity.
    """
    # By hand, as dataclasses.replace takes longer than the prediction itself.
    state = Motion(motion.x, motion.y, motion.heading, motion.vx, motion.vy, motion.omega)
    now = start
    index = 0
    while now < end - 1e-9:
        while index < len(commands) and commands[index].time <= now + 1e-9:
            index += 1
        until = min(end, commands[index].time) if index < len(commands) else end
        until = min(until, now + _STEP)
        _drive(state, commands[index - 1] if index else None, limits, until - now)
        now = until
    return state


def _drive(state: Motion, command: SentCommand | None, limits: RobotLimits, dt: float) -> None:
    """One step; a robot's wheels limit its acceleration to an ellipse in its own frame."""
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
