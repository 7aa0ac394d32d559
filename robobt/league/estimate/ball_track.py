"""The ball's state from noisy, delayed detections: it slides, then rolls, and may be carried.

Source of the model: a kicked ball slides with one deceleration down to a share of
the speed it was kicked with, and rolls with another from there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot, inf, sqrt

from robobt.league.estimate.kalman import Mismatch
from robobt.league.estimate.offsets import MeanOffsets, OffsetCovariance
from robobt.sim.settings import BallSettings


@dataclass(slots=True)
class BallMotion:
    """A ball's state in field coordinates.

    ``rolls_at`` is the speed at which sliding turns into rolling; below it, the ball rolls. ``z`` is the
    height above a resting ball, ``vz`` its rate [m, m/s].
    """

    x: float
    y: float
    vx: float = 0.0
    vy: float = 0.0
    rolls_at: float = 0.0
    z: float = 0.0
    vz: float = 0.0


_RESTING_NOISE, _ROLLING_NOISE = 0.05, 0.25
"""Acceleration noise of a free ball that rests or rolls: carpets differ in how they slow it [m/s^2]."""

_ROLLING_SPEED = 0.1
"""Speed below which a ball rolls [m/s]."""

_PUSHED_NOISE = 6.0
"""Acceleration noise of a ball that a robot may push [m/s^2]."""

_KICK = 8.0
"""Standard deviation of the velocity that a kick may cause [m/s]."""

_SURPRISE = 49.0
"""Squared innovation, in variances, that is not noise."""

_CARRIED_SPREAD = 0.2
"""Standard deviation of a carried ball's velocity relative to its robot [m/s]."""

_FADING = 0.95
"""Share of a misfit that remains one detection later."""

_SHORTEST_STEP, _LONGEST_STEP = 0.005, 0.05
"""Time between two detections from which a kick's velocity is inferred [s]."""

_BALL_OFFSET_SPREAD = 0.03
"""Standard deviation of a camera's offset about its mean [m]."""

_RELEARNT = 5
"""Number of surprising detections after which a camera, contradicted by others, has another offset."""

_SETTLING_DETECTIONS = 4
"""Detections after a kick during which its speed is still being determined."""


class BallTrack:
    """The estimate of the ball.

    After a kick or a bounce it is unknown whether the ball slides or rolls: both
    hypotheses are tracked, and the one that fits better is reported.

    It starts at rest in a place, as seen by a ``camera`` if one is given. The detections' standard
    deviation is ``noise`` [m], ``means`` are the cameras' mean offsets.

    Attributes:
        time: time of the estimate [s].
    """

    def __init__(
        self,
        x: float,
        y: float,
        time: float,
        settings: BallSettings,
        noise: float,
        means: MeanOffsets,
        camera: int | None = None,
    ) -> None:
        self.settings = settings
        self._r = noise * noise
        self._means = means
        self.restart(x, y, time, camera)

    def restart(self, x: float, y: float, time: float, camera: int | None = None) -> None:
        """Restart the track at rest, at a camera's detection or where the ball was put."""
        self.time = time
        self._covariance = OffsetCovariance(_KICK**2, _BALL_OFFSET_SPREAD, self._means)
        if camera is not None:
            dx, dy = self._covariance.begin(camera, time, self._r)
            x, y = x - dx, y - dy
        self._last_step = 0.0
        self._startled: dict[int, int] = {}
        self._last_camera: int | None = None
        self._split(BallMotion(x, y), time)

    def _split(self, motion: BallMotion, kicked: float) -> None:
        """Start both hypotheses from one motion, after a kick at a time."""
        self._sliding, self._rolling = replace(motion), replace(motion, rolls_at=inf)
        self._misfit_sliding = self._misfit_rolling = 0.0
        self._mismatch = Mismatch()
        self._settling, self._kicked = _SETTLING_DETECTIONS, kicked

    @property
    def motion(self) -> BallMotion:
        """The estimate at ``time``."""
        return self._rolling if self._misfit_rolling < self._misfit_sliding else self._sliding

    @property
    def settling(self) -> bool:
        """Whether the ball has just been kicked or bounced, and its speed is still being determined."""
        return self._settling > 0

    @property
    def spread(self) -> float:
        """Standard deviation of the position in each direction [m]."""
        return sqrt(max(0.0, self._covariance.position_variance))

    def advance(self, time: float, near_robot: bool) -> None:
        """Predict the estimate to ``time``."""
        dt = time - self.time
        if dt <= 0.0:
            return
        self._sliding = predict_ball(self._sliding, dt, self.settings)
        self._rolling = predict_ball(self._rolling, dt, self.settings)
        shift = self._covariance.settle(dt)
        if shift is not None:
            dx, dy = shift
            for motion in (self._sliding, self._rolling):
                motion.x += dx
                motion.y += dy
        noise = _RESTING_NOISE if hypot(self.motion.vx, self.motion.vy) < _ROLLING_SPEED else _ROLLING_NOISE
        noise = _PUSHED_NOISE if near_robot else noise + self._mismatch.level * _PUSHED_NOISE
        self._covariance.predict(noise, dt)
        self.time, self._last_step = time, dt

    def carry(self, motion: BallMotion, time: float) -> None:
        """Set the motion of a ball that a robot carries."""
        self._rolling, self._sliding = replace(motion, rolls_at=inf), replace(motion, rolls_at=inf)
        self._covariance.widen(_CARRIED_SPREAD**2)
        self.time = max(self.time, time)

    def place(self, x: float, y: float, camera: int) -> tuple[float, float]:
        """Return where the ball is that a camera sees at a place, without the camera's offset [m]."""
        dx, dy = self._covariance.offset(camera)
        return x - dx, y - dy

    def deviation(self, x: float, y: float, camera: int) -> float:
        """Return the distance of a camera's detection at the track's time from the prediction [m]."""
        x, y = self.place(x, y, camera)
        return hypot(x - self.motion.x, y - self.motion.y)

    def correct(self, x: float, y: float, camera: int, kickable: bool = False) -> None:
        """Correct the estimate with a camera's detection captured at the track's time.

        If a robot was close enough to kick the ball (``kickable``), a sudden departure is
        taken for a kick at the previous detection.
        """
        m, p, seen = self.motion, self._covariance, (x, y)
        known = p.knows(camera)
        x, y = self.place(*seen, camera)
        dx, dy = x - m.x, y - m.y
        s = p.detection_variance(camera) + self._r
        surprises = (dx * dx + dy * dy) / s > _SURPRISE
        if not surprises:
            self._startled.pop(camera, None)
        elif known and p.several and self._contradicted(camera, kickable):
            if self._startled[camera] < _RELEARNT:
                return
            # The other cameras still see the ball where it was, so this camera's offset has changed.
            p.forget(camera)
            x, y = self.place(*seen, camera)
            dx, dy = x - m.x, y - m.y
            s = p.detection_variance(camera) + self._r
            # A deviation too large for an offset means that the ball has moved.
            surprises = (dx * dx + dy * dy) / s > _SURPRISE
        self._last_camera = camera
        if surprises:
            self._startled.clear()
            # After a kick, bounce or touch the past motion says nothing about the present velocity.
            p.jump(dx * dx + dy * dy, _KICK**2)
            self._split(m, self.time - self._last_step / 2)
            s = p.detection_variance(camera) + self._r
            if kickable and known and _SHORTEST_STEP <= self._last_step <= _LONGEST_STEP:
                # Goalkeepers cannot wait for the next detection to learn the ball's speed.
                p.move_since(self._last_step, s)
        else:
            scale = 1.0 / sqrt(s)
            self._mismatch.update(dx * scale, dy * scale)
        k, g = p.correct(camera, self.time, s, [dx, dy])
        self._misfit_sliding = _FADING * self._misfit_sliding + _nudge(self._sliding, x, y, k, g) / s
        self._misfit_rolling = _FADING * self._misfit_rolling + _nudge(self._rolling, x, y, k, g) / s
        if self._settling:
            self._settling -= 1
            m = self._sliding
            # The speed lost since the kick belongs to the kick's speed.
            lost = self.settings.slide_deceleration * (self.time - self._kicked)
            m.rolls_at = self.settings.switch_share * (hypot(m.vx, m.vy) + lost)

    def _contradicted(self, camera: int, kickable: bool) -> bool:
        """Return whether other cameras still see the ball in place while one camera sees it depart."""
        before, others = self._startled.get(camera, 0), set(self._startled) - {camera}
        self._startled[camera] = before + 1
        return not (kickable or others or (before and self._last_camera == camera))

    def teach(self) -> None:
        """Let the cameras' mean offsets learn from a ball that rolls along the ground."""
        if not self._settling:
            self._covariance.teach()


def _nudge(motion: BallMotion, x: float, y: float, k: float, g: float) -> float:
    """Correct a motion by gains of position and velocity; return the squared innovation [m^2]."""
    dx, dy = x - motion.x, y - motion.y
    motion.x += k * dx
    motion.y += k * dy
    motion.vx += g * dx
    motion.vy += g * dy
    return dx * dx + dy * dy


def predict_ball(motion: BallMotion, dt: float, settings: BallSettings) -> BallMotion:
    """Return the motion of a free ball ``dt`` seconds later, in closed form."""
    state = replace(motion)
    speed = hypot(state.vx, state.vy)
    left = dt
    if speed > state.rolls_at:
        sliding = min(left, (speed - state.rolls_at) / settings.slide_deceleration)
        speed = _brake(state, speed, settings.slide_deceleration, sliding)
        left -= sliding
    if left > 0.0 and speed > 0.0:
        rolling = min(left, speed / settings.roll_deceleration)
        _brake(state, speed, settings.roll_deceleration, rolling)
        if rolling < left:
            state.vx = state.vy = 0.0
    return state


def _brake(state: BallMotion, speed: float, deceleration: float, dt: float) -> float:
    """Move on for ``dt`` under a deceleration; return the speed at the end."""
    end = max(0.0, speed - deceleration * dt)
    way = (speed + end) / 2.0 * dt
    state.x += state.vx / speed * way
    state.y += state.vy / speed * way
    state.vx *= end / speed
    state.vy *= end / speed
    return end
