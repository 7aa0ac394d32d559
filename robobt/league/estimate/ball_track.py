"""The ball's state from noisy, late detections: it slides, then rolls, and somebody may have it.

Source of the model: a kicked ball slides with one deceleration until it has a
share of the speed it was kicked with, and rolls with another from there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot, inf, sqrt

from robobt.league.estimate.robot_track import MEMORY, doubt, grown
from robobt.sim.settings import BallSettings


@dataclass(slots=True)
class BallMotion:
    """A ball's state in field coordinates.

    Attributes:
        x, y: position [m].
        vx, vy: velocity [m/s].
        rolls_at: speed at which it stops sliding and rolls [m/s]; below it, it rolls.
    """

    x: float
    y: float
    vx: float = 0.0
    vy: float = 0.0
    rolls_at: float = 0.0


_CALM = 0.05
"""Acceleration noise of a ball left to itself [m/s^2]."""

_NEAR_ROBOT = 6.0
"""The same of one that a robot may push [m/s^2]."""

_KICK = 8.0
"""Spread of the velocity that a kick may give a ball [m/s]."""

_SURPRISE = 25.0
"""Squared deviation, in variances, of something that was no noise."""

_CARRIED = 0.2
"""Spread of a carried ball's velocity about its robot's [m/s]."""

_FADING = 0.95
"""What is left of a misfit one detection later."""

_SHORTEST, _LONGEST = 0.005, 0.05
"""Time between two detections from which a kick's velocity is told [s]."""

_SETTLING = 4
"""Detections after a kick in which the speed it gave becomes known."""


class BallTrack:
    """The estimate of the ball.

    After a kick or a bounce nobody can tell at once whether the ball slides or
    rolls: both are followed, and the one that fits better is believed.

    Args:
        x, y: first detection [m].
        time: of the capture [s].
        settings: how the ball slides and rolls.
        noise: standard deviation of detections [m].

    Attributes:
        time: of the estimate [s].
    """

    def __init__(self, x: float, y: float, time: float, settings: BallSettings, noise: float) -> None:
        self.settings = settings
        self._r = noise * noise
        self.restart(x, y, time)

    @property
    def motion(self) -> BallMotion:
        """The estimate at ``time``."""
        return self._rolling if self._misfit_rolling < self._misfit_sliding else self._sliding

    def restart(self, x: float, y: float, time: float) -> None:
        """Begin anew where the ball is now."""
        self._sliding, self._rolling = BallMotion(x, y), BallMotion(x, y, rolls_at=inf)
        self._misfit_sliding = self._misfit_rolling = 0.0
        self.time = time
        self._pp, self._pv, self._vv = self._r, 0.0, _KICK**2
        self._mean_x = self._mean_y = self._doubt = 0.0
        self._settling, self._kicked, self._last_step = _SETTLING, time, 0.0

    def advance(self, time: float, near_robot: bool) -> None:
        """Let the ball roll on to ``time``."""
        dt = time - self.time
        if dt <= 0.0:
            return
        self._sliding = rolled(self._sliding, dt, self.settings)
        self._rolling = rolled(self._rolling, dt, self.settings)
        noise = _NEAR_ROBOT if near_robot else _CALM + self._doubt * _NEAR_ROBOT
        self._pp, self._pv, self._vv = grown(self._pp, self._pv, self._vv, noise, dt)
        self.time, self._last_step = time, dt

    def carried_to(self, motion: BallMotion, time: float) -> None:
        """A robot has the ball and takes it along."""
        self._rolling, self._sliding = replace(motion, rolls_at=inf), replace(motion, rolls_at=inf)
        self._vv = max(self._vv, _CARRIED**2)
        self.time = max(self.time, time)

    def surprise(self, x: float, y: float) -> float:
        """Distance of a detection at the track's time from what is expected [m]."""
        return hypot(x - self.motion.x, y - self.motion.y)

    def correct(self, x: float, y: float, kickable: bool = False) -> None:
        """Use a detection captured at the track's time.

        Args:
            kickable: whether a robot was close enough to the ball before to kick it; a ball that
                has left all of a sudden is then taken to have been kicked at the detection before.
        """
        m = self.motion
        s = self._pp + self._r
        dx, dy = x - m.x, y - m.y
        if (dx * dx + dy * dy) / s > _SURPRISE:
            # Kicked, bounced or touched: whatever it did before tells nothing about its velocity now.
            self._vv = max(self._vv, _KICK**2)
            self._pp = max(self._pp, dx * dx + dy * dy)
            self._pv = 0.0
            self._mean_x = self._mean_y = self._doubt = 0.0
            self._misfit_sliding = self._misfit_rolling = 0.0
            self._sliding, self._rolling = replace(m), replace(m, rolls_at=inf)
            self._settling, self._kicked = _SETTLING, self.time - self._last_step / 2
            s = self._pp + self._r
            if kickable and _SHORTEST <= self._last_step <= _LONGEST:
                # Goalkeepers cannot wait for the next detection to learn how fast it goes.
                self._pv = s / self._last_step
                self._vv += self._pv / self._last_step
        else:
            scale = 1.0 / sqrt(s)
            self._mean_x += MEMORY * (dx * scale - self._mean_x)
            self._mean_y += MEMORY * (dy * scale - self._mean_y)
            self._doubt = doubt((self._mean_x**2 + self._mean_y**2) / 2)
        k, g = self._pp / s, self._pv / s
        self._misfit_sliding = _FADING * self._misfit_sliding + _nudge(self._sliding, x, y, k, g) / s
        self._misfit_rolling = _FADING * self._misfit_rolling + _nudge(self._rolling, x, y, k, g) / s
        self._vv -= g * self._pv
        self._pv *= 1.0 - k
        self._pp *= 1.0 - k
        if self._settling:
            self._settling -= 1
            m = self._sliding
            # What it has lost since the kick, it had then.
            lost = self.settings.slide_deceleration * (self.time - self._kicked)
            m.rolls_at = self.settings.switch_share * (hypot(m.vx, m.vy) + lost)


def _nudge(motion: BallMotion, x: float, y: float, k: float, g: float) -> float:
    """Correct a state by gains for position and velocity; returns the squared deviation [m^2]."""
    dx, dy = x - motion.x, y - motion.y
    motion.x += k * dx
    motion.y += k * dy
    motion.vx += g * dx
    motion.vy += g * dy
    return dx * dx + dy * dy


def rolled(motion: BallMotion, dt: float, settings: BallSettings) -> BallMotion:
    """Where a ball left to itself is ``dt`` seconds later, in closed form."""
    state = replace(motion)
    speed = hypot(state.vx, state.vy)
    left = dt
    if speed > state.rolls_at:
        sliding = min(left, (speed - state.rolls_at) / settings.slide_deceleration)
        speed = _slow(state, speed, settings.slide_deceleration, sliding)
        left -= sliding
    if left > 0.0 and speed > 0.0:
        rolling = min(left, speed / settings.roll_deceleration)
        if rolling < left:
            left = rolling
            _slow(state, speed, settings.roll_deceleration, rolling)
            state.vx = state.vy = 0.0
        else:
            _slow(state, speed, settings.roll_deceleration, left)
    return state


def _slow(state: BallMotion, speed: float, deceleration: float, dt: float) -> float:
    """Move on for ``dt`` under a deceleration; returns the speed at the end."""
    end = max(0.0, speed - deceleration * dt)
    way = (speed + end) / 2.0 * dt
    state.x += state.vx / speed * way
    state.y += state.vy / speed * way
    state.vx *= end / speed
    state.vy *= end / speed
    return end
