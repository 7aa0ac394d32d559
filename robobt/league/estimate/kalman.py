"""Constant-velocity Kalman filtering of one coordinate, and a test of whether its model fits."""

from __future__ import annotations

from dataclasses import dataclass

_NEWEST_WEIGHT = 0.25
"""Weight of the newest innovation in the running mean that separates a manoeuvre from noise."""

_SUSPECT = 9.0
"""Squared running mean, in variances, from which on the model is doubted."""

_CERTAIN = 27.0
"""Squared running mean, in variances, from which on the model is rejected."""

_MEAN_VARIANCE = _NEWEST_WEIGHT / (2.0 - _NEWEST_WEIGHT)
"""Variance of the running mean of white innovations of unit variance."""


@dataclass(slots=True)
class Covariance:
    """Covariance of position and velocity: the variances ``pp`` and ``vv``, and ``pv``."""

    pp: float
    pv: float
    vv: float

    def predict(self, noise: float, dt: float) -> None:
        """Grow over ``dt`` seconds under an acceleration noise [m/s^2]."""
        q = noise * noise
        pp, pv, vv = self.pp, self.pv, self.vv
        self.pp = pp + dt * (2.0 * pv + dt * (vv + q * dt * dt / 4.0))
        self.pv = pv + dt * (vv + q * dt * dt / 2.0)
        self.vv = vv + q * dt * dt

    def gains(self, s: float) -> tuple[float, float]:
        """Return the gains of position and velocity for an innovation of variance ``s``."""
        return self.pp / s, self.pv / s

    def correct(self, k: float, g: float) -> None:
        """Shrink after a correction with these gains."""
        self.vv -= g * self.pv
        self.pv *= 1.0 - k
        self.pp *= 1.0 - k


class Mismatch:
    """Detects innovations that keep pointing in one direction, which noise does not.

    Attributes:
        level: how little the model fits, from 0 to 1.
    """

    def __init__(self) -> None:
        self.level = 0.0
        self._means: list[float] = []

    def update(self, *innovations: float) -> None:
        """Add the innovation of each axis, in units of its expected standard deviation."""
        means = self._means or [0.0] * len(innovations)
        self._means = [
            mean + _NEWEST_WEIGHT * (new - mean) for mean, new in zip(means, innovations, strict=True)
        ]
        square = sum([mean**2 for mean in self._means]) / len(self._means)
        level = (square / _MEAN_VARIANCE - _SUSPECT) / (_CERTAIN - _SUSPECT)
        self.level = min(1.0, max(0.0, level))
