"""An object's covariance, with the offset of each camera that sees it.

Calibrated cameras disagree by centimetres about where a thing is. Each detection is taken as
position + the camera's offset + noise, and the Kalman filter estimates the offsets with position
and velocity: what alternates with the camera is an offset, what all cameras see is motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

_DETECTIONS_KNOWN = 5
"""Number of detections after which a camera's offset counts as known."""

_FORGOTTEN = 2.0
"""A camera that has not seen the object for this long is dropped from its estimate [s]."""

_UNKNOWN_POSITION_VARIANCE = 1.0
"""Variance of a position that is not known at all [m^2 or rad^2]."""

_JOINT_SIGHT_TIME = 0.1
"""Cameras that saw the object within this time see it together [s]."""

_OFFSET_GROWTH = 0.02
"""Growth of an offset's variance, as a share of its first one [1/s]: it changes with the place."""

_LEARNING_EVERY = 7
"""Number of detections of an object after which means and position are adjusted; cameras take turns."""

_LEARNING_RATE = 0.05
"""Least weight of what one object shows in a camera's mean offset."""

_SETTLING_TIME = 0.5
"""Time constant with which what all cameras of an object share goes into its position [s]."""


class MeanOffsets:
    """The mean offset of each camera over all objects, in metres or radians.

    Only differences between cameras can be seen, so the offsets add up to zero.

    Args:
        axes: number of coordinates.
    """

    def __init__(self, axes: int) -> None:
        self._axes = axes
        self._means: dict[int, list[float]] = {}
        self._counts: dict[int, int] = {}

    @property
    def empty(self) -> bool:
        """Whether nothing is known, as with a single camera."""
        return not self._means

    def of(self, camera: int) -> list[float]:
        """Return a camera's mean offset, one entry per axis; zeros while it is unknown."""
        mean = self._means.get(camera)
        return [0.0] * self._axes if mean is None else list(mean)

    def learn(self, offsets: dict[int, list[float]]) -> None:
        """Learn from one object's offsets in two or more cameras."""
        counts, means = self._counts, self._means
        for camera in offsets:
            counts[camera] = counts.get(camera, 0) + 1
        # All cameras get the weight of the least known one; otherwise their offsets would no longer add up to
        # 0.
        weight = max(_LEARNING_RATE, 1.0 / min(counts[camera] for camera in offsets))
        for axis in range(self._axes):
            changes = {camera: offset[axis] - self.of(camera)[axis] for camera, offset in offsets.items()}
            shared = sum(changes.values()) / len(changes)
            for camera, change in changes.items():
                means.setdefault(camera, [0.0] * self._axes)[axis] += weight * (change - shared)


@dataclass(slots=True)
class _CameraOffset:
    """A camera's offset from the object's position, one entry per axis, and when and how often it saw it."""

    offset: list[float]
    seen: float
    detections: int = 0


class OffsetCovariance:
    """Covariance of position, velocity and the cameras' offsets, equal for all axes, and those offsets.

    The position is where the first camera sees the object, less that camera's offset, which is not estimated;
    those of the others are estimated against it.

    Args:
        velocity_variance: of the first estimate; the position is unknown.
        spread: standard deviation of an offset about the camera's mean, in the unit of the position.
        means: the cameras' mean offsets, shared by all objects.

    Attributes:
        several: whether several cameras have seen the object of late.
    """

    def __init__(self, velocity_variance: float, spread: float, means: MeanOffsets) -> None:
        # Rows and columns: position, velocity, then the cameras but the first, in their order.
        self._matrix = [[_UNKNOWN_POSITION_VARIANCE, 0.0], [0.0, velocity_variance]]
        self._cameras: dict[int, _CameraOffset] = {}
        self._spread, self._means = 2.0 * spread * spread, means
        self.several = False
        self._detections = 0
        self._unsettled = 0.0

    def begin(self, camera: int, time: float, noise: float) -> list[float]:
        """Take in the first detection [s], with the variance of its noise; return the camera's offset."""
        self._add(camera, time)
        self._matrix[0][0] = noise
        return self.offset(camera)

    @property
    def position_variance(self) -> float:
        """Variance of the position, the offset that all cameras share left out."""
        return self._matrix[0][0]

    def offset(self, camera: int) -> list[float]:
        """Return a camera's offset, one entry per axis."""
        known = self._cameras.get(camera)
        return self._means.of(camera) if known is None else known.offset

    def knows(self, camera: int) -> bool:
        """Return whether a camera's offset is known."""
        known = self._cameras.get(camera)
        return known is not None and (known.detections >= _DETECTIONS_KNOWN or self._row(camera) < 2)

    def detection_variance(self, camera: int) -> float:
        """Return the variance of where a camera is expected to see the object, without its noise."""
        m = self._matrix
        if camera in self._cameras:
            i = self._row(camera)
            return m[0][0] if i < 2 else m[0][0] + 2.0 * m[0][i] + m[i][i]
        return m[0][0] + (self._spread if self._cameras else 0.0)

    def predict(self, noise: float, dt: float) -> None:
        """Grow over ``dt`` seconds under an acceleration noise, in the position's unit / s^2."""
        m = self._matrix
        q = noise * noise * dt * dt
        position, velocity = m[0], m[1]
        pv = position[1] + dt * velocity[1]
        position[0] += dt * (position[1] + pv) + q * dt * dt / 4.0
        position[1] = velocity[0] = pv + q * dt / 2.0
        velocity[1] += q
        for i in range(2, len(m)):
            position[i] += dt * velocity[i]
            m[i][0] = position[i]
            if self.several:
                m[i][i] += _OFFSET_GROWTH * self._spread * dt

    def settle(self, dt: float) -> list[float] | None:
        """Return what to add to the position, one entry per axis, after ``dt`` seconds; None for nothing.

        An offset that all cameras of an object share cannot be seen. It is moved into the position, towards
        the cameras' means, so that objects seen by different cameras stay in place to each other. No
        velocity comes of it.
        """
        self._unsettled += dt
        if self._means.empty or self._detections % _LEARNING_EVERY:
            return None
        apart = [
            [b - mean for b, mean in zip(known.offset, self._means.of(camera), strict=True)]
            for camera, known in self._cameras.items()
        ]
        if not apart:
            return None
        share = (1.0 - exp(-self._unsettled / _SETTLING_TIME)) / len(apart)
        self._unsettled = 0.0
        shift = [share * sum(axis) for axis in zip(*apart, strict=True)]
        for known in self._cameras.values():
            known.offset = [b - part for b, part in zip(known.offset, shift, strict=True)]
        return shift

    def jump(self, square: float, velocity_variance: float) -> None:
        """Take the object to have been displaced, by a squared distance, and its velocity to be unknown."""
        m = self._matrix
        for row in m:
            row[1] = 0.0
        m[1] = [0.0] * len(m)
        m[1][1] = velocity_variance
        m[0][0] = max(m[0][0], square)
        # What was learned in the last moment may have been the beginning of the jump.
        for camera, known in self._cameras.items():
            if not self.knows(camera):
                known.offset, known.detections = self._means.of(camera), 0
                self._clear(self._row(camera))

    def forget(self, camera: int) -> None:
        """Estimate a camera's offset again from its next detection."""
        known = self._cameras.get(camera)
        if known is not None:
            known.detections = 0
            if self._row(camera) < 2:
                # The next one becomes the first.
                self._drop(camera)
            else:
                self._clear(self._row(camera))

    def move_since(self, dt: float, variance: float) -> None:
        """Let the next innovation, of a total ``variance``, be due to a velocity that began ``dt`` s ago."""
        m = self._matrix
        m[0][1] = m[1][0] = variance / dt
        m[1][1] += variance / dt / dt

    def widen(self, velocity_variance: float) -> None:
        """Raise the variance of the velocity to this value where it is lower."""
        self._matrix[1][1] = max(self._matrix[1][1], velocity_variance)

    def correct(
        self, camera: int, time: float, variance: float, innovation: list[float]
    ) -> tuple[float, float]:
        """Correct the offsets and shrink; return the gains of position and velocity.

        Args:
            camera: whose detection it is.
            time: of the detection [s].
            variance: of the innovation, the camera's noise included.
            innovation: detection less position and offset, one entry per axis.
        """
        known = self._cameras.get(camera) or self._add(camera, time)
        known.seen, known.detections = max(time, known.seen), known.detections + 1
        self._detections += 1
        m = self._matrix
        if len(m) == 2:
            (pp, pv), (_, vv) = m
            k, g = pp / variance, pv / variance
            m[0], m[1] = [pp - k * pp, pv - k * pv], [pv - k * pv, vv - g * pv]
            return k, g
        i = self._row(camera)
        column = list(m[0]) if i < 2 else [a + b for a, b in zip(m[0], m[i], strict=True)]
        gains = [entry / variance for entry in column]
        for j, gain in enumerate(gains):
            m[j] = [entry - gain * each for entry, each in zip(m[j], column, strict=True)]
        for gain, each in zip(gains[2:], list(self._cameras.values())[1:], strict=True):
            each.offset = [b + gain * e for b, e in zip(each.offset, innovation, strict=True)]
        if self._detections % _LEARNING_EVERY == 0:
            self._look_round(time)
        return gains[0], gains[1]

    def _look_round(self, time: float) -> None:
        """Drop cameras that no longer see the object, and find out whether several do."""
        for other in [other for other, each in self._cameras.items() if each.seen < time - _FORGOTTEN]:
            self._drop(other)
        self.several = sum(each.seen > time - _JOINT_SIGHT_TIME for each in self._cameras.values()) > 1

    def teach(self) -> None:
        """Let the cameras' means learn from this object's offsets, now and then."""
        if self.several and self._detections % _LEARNING_EVERY == 0:
            known = {camera: each.offset for camera, each in self._cameras.items() if self.knows(camera)}
            if len(known) > 1:
                self._means.learn(known)

    def _row(self, camera: int) -> int:
        """Return a camera's row; 1 for the first, whose offset is not estimated."""
        return 1 + list(self._cameras).index(camera)

    def _add(self, camera: int, time: float) -> _CameraOffset:
        added = _CameraOffset(self._means.of(camera), time)
        if self._cameras:
            for row in self._matrix:
                row.append(0.0)
            self._matrix.append([0.0] * (len(self._matrix) + 1))
            self._clear(len(self._matrix) - 1)
            self.several = True
        self._cameras[camera] = added
        return added

    def _drop(self, camera: int) -> None:
        m, i = self._matrix, self._row(camera)
        if i < 2:
            # The next one becomes the first, and the position is where that one sees the object.
            i = 2
            m[0] = [a + b for a, b in zip(m[0], m[i], strict=True)]
            for row in m:
                row[0] += row[i]
        del self._cameras[camera], m[i]
        for row in m:
            del row[i]

    def _clear(self, i: int) -> None:
        """Forget a camera's offset but its spread."""
        m = self._matrix
        m[i] = [0.0] * len(m)
        for row in m:
            row[i] = 0.0
        m[i][i] = self._spread
