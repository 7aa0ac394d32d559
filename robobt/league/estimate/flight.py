"""A chipped ball, recognised and followed by where cameras see it.

A camera takes every ball to lie on the ground: one at height z above where it lies is seen
at p = P + a z, where P is its place and a = (p - c) / h, with the camera's place c and its
height h above the ball. After a kick, P and z are linear in where the ball started and how
fast, so these follow from least squares on the detections, beside what a flat kick would be
seen as: a straight line along which the ball slides, then rolls. It counts as chipped once it
can be no flat kick and a chip explains what was seen.

At a touch-down the next hop is what the league's model chip_fixed_loss says, to within what
the detections since then say. The approach is that of ER-Force's and Sumatra's filters.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot

import numpy as np

from robobt.league.estimate.ball_track import BallMotion, predict_ball
from robobt.league.estimate.flat_kick import flat_misfit
from robobt.league.estimate.hop import LAST_APEX, Hop
from robobt.league.estimate.kicks import Kick
from robobt.league.wire.geometry import CameraPlace
from robobt.sim.settings import BallSettings
from robobt.world.ball_model import GRAVITY
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS

_FEWEST_DETECTIONS = 6
"""Number of detections from which a chip can be distinguished."""

_CHIP_DEADLINE = 0.9
"""A kick not recognised as a chip within this time counts as flat [s]."""

_NOT_FLAT = 9.0
"""Mean squared misfit, in variances of a detection, from which a kick is not flat."""

_BETTER = 0.3
"""A chip has to have less than this share of the flat kick's misfit."""

_FITS = 3.0
"""Largest mean squared misfit of a chip, in variances."""

_ELEVATION = (0.36, 2.8)
"""Least and greatest tangent of the angle at which robots chip: 20 and 70 degrees."""

_USUAL = 0.2
"""Standard deviation of that tangent from 1, because robots chip at about 45 degrees."""

_LEAST_RISE = 1.0
"""A ball with a lower initial vertical speed hops less than 5 cm high [m/s]. Source: ER-Force's filter."""

_START = (0.01, 0.01, 20.0, 20.0, 0.004, 20.0)
"""Prior standard deviations of a launch: place, velocity, height [m, m/s]."""

_UNKNOWN_KICK_SPREADS = (1.0, 1.0, 20.0, 20.0, 1.0, 20.0)
"""Prior standard deviations of a launch with an unknown kick time."""

_HIGHEST = 2.0
"""No ball that is chipped by the rules, at 6.5 m/s and 70 degrees, rises higher [m]."""

_FASTER = 0.3
"""A ball that gains this much observed speed with no robot near does not roll [m/s]."""

_BACK = 1e-6
"""A ball seen no farther than this from the kick has not flown [m]."""

_HOP = (0.05, 0.05, 0.3, 0.3, 0.02, 0.3)
"""Prior standard deviations of a hop, from the previous hop."""

_LAUNCHES, _INTERVALS_BEFORE = 4, 6
"""Number of launch times tried per interval between two detections, and number of detections before the kick
from which the ball may have been launched."""

_SETTLED_FLIGHT_DETECTIONS = 15
"""Number of detections in flight after which the interval of the launch is known."""

_LOST_DISTANCE = 0.1
"""A ball detected this far from the prediction is not in this flight [m]."""

_LOST_FOR = 3
"""Number of such detections in a row that end a flight."""

_REMEMBERED_DETECTIONS = 12
"""Number of detections kept before a kick."""


@dataclass(slots=True)
class _BallDetection:
    """A detection: its time, its place, and its shift per metre of height."""

    time: float
    x: float
    y: float
    ax: float
    ay: float


class FlightWatch:
    """Finds chips among kicks, and follows the ball until it rolls.

    Args:
        settings: settings of the ball.
        noise: standard deviation of a detection [m].
        cameras: positions of the cameras, by number; other cameras give no height. May be filled in later.

    Attributes:
        hop: the ball in the air, None while it is on the ground.
        landed: the ball when it began to roll, to be taken by the caller.
    """

    def __init__(self, settings: BallSettings, noise: float, cameras: Mapping[int, CameraPlace]) -> None:
        self.hop: Hop | None = None
        self.landed: BallMotion | None = None
        self._ball, self._variance, self._cameras = settings, noise * noise, cameras
        self._recent: deque[_BallDetection] = deque(maxlen=_REMEMBERED_DETECTIONS)
        self._before: _BallDetection | None = None
        self._last: list[_BallDetection] = []
        self._since: list[_BallDetection] = []
        self._expected: Hop | None = None
        self._unknown = False
        self._lost = 0

    def clear(self) -> None:
        """Forget the ball, because it was placed elsewhere."""
        self.hop = self._before = self.landed = None
        self._recent.clear()

    def at(self, time: float) -> BallMotion | None:
        """Return the ball at a time; None where it was last seen on the ground."""
        hop = self.hop
        if hop is None:
            return None
        while time > hop.time + hop.lasts():
            hop = hop.next(self._ball)
            if hop.ball.vz == 0.0:
                return predict_ball(hop.ball, time - hop.time, self._ball)
        return hop.at(time)

    def known(self, time: float, ball: BallMotion) -> None:
        """Take in the ball's position and height from another filter."""
        self.hop = Hop(time, ball, 1) if ball.z > LAST_APEX or ball.vz > _LEAST_RISE else None

    def update(
        self, time: float, camera: int, x: float, y: float, kick: Kick | None = None, near: bool = False
    ) -> None:
        """Take in a camera's detection of the ball [s, m].

        ``kick`` is the kick that it reveals, if any, ``near`` says whether the ball seems to be near a robot.
        """
        place = self._cameras.get(camera)
        if place is None:
            return
        height = place.z - BALL_RADIUS
        seen = _BallDetection(time, x, y, (x - place.x) / height, (y - place.y) / height)
        if kick is not None:
            self._begin(kick)
        self._recent.append(seen)
        if self.hop is not None:
            self._follow(self.hop, seen)
        elif self._before is None and not near and kick is None:
            self._notice()
        elif self._unknown and near:
            self._before = None
        elif self._before is not None and time > self._before.time:
            self._since.append(seen)
            self._judge(self._before)

    def _begin(self, kick: Kick) -> None:
        """Start checking whether a kick was a chip."""
        self.hop = None
        earlier = [seen for seen in self._recent if seen.time < kick.time - 1e-6]
        self._before, self._unknown = (earlier[-1] if earlier else None), False
        # A ball chipped towards its camera rises unseen at first.
        self._last = earlier[-_INTERVALS_BEFORE:]
        self._since = [seen for seen in self._recent if self._before and seen.time > self._before.time]

    def _notice(self) -> None:
        """Detect a ball that gets faster away from robots, as one that rises towards its camera seems to."""
        if len(self._recent) < 5:
            return
        first, middle, last = self._recent[-5], self._recent[-3], self._recent[-1]
        if not first.time < middle.time < last.time:
            return
        before, after = (
            hypot(b.x - a.x, b.y - a.y) / (b.time - a.time) for a, b in ((first, middle), (middle, last))
        )
        if after > before + _FASTER:
            self._before, self._unknown = first, True
            self._since = [seen for seen in self._recent if seen.time > first.time]

    def _judge(self, before: _BallDetection) -> None:
        """Decide whether the detections since the kick show a chip."""
        if self._since[-1].time - before.time > _CHIP_DEADLINE:
            self._before = None
            return
        if len(self._since) < (2 * _FEWEST_DETECTIONS if self._unknown else _FEWEST_DETECTIONS):
            return
        times, places = _columns(self._since)
        flat = flat_misfit(times - before.time, places, self._ball) / self._variance
        rest = 2 * len(self._since) - 5
        if flat < _NOT_FLAT * rest:
            return
        if not self._unknown and not _left(before, self._since[-1]):
            return
        hop, misfit = self._launch(before)
        along, rise = hypot(hop.ball.vx, hop.ball.vy), hop.ball.vz
        least, most = _ELEVATION
        can_be = rise > _LEAST_RISE and least * along < rise < most * along
        if self._unknown:
            can_be = (
                along > _LEAST_RISE and 2.0 * GRAVITY * max(hop.ball.z, 0.0) + rise * rise > _LEAST_RISE**2
            )
        can_be = can_be and hop.apex() < _HIGHEST
        if can_be and misfit < min(_BETTER * flat, _FITS * rest):
            self.hop, self._lost, self._expected = hop, 0, None

    def _launch(self, before: _BallDetection) -> tuple[Hop, float]:
        """Return the chip that fits best, and its misfit in variances."""
        if self._unknown:
            found, misfit = self._fit(self._since, before.time, _still(before), _UNKNOWN_KICK_SPREADS)
            return _hop(before.time, found, 0), misfit
        newest = self._since[-1]
        dx, dy = newest.x - before.x, newest.y - before.y
        length = hypot(dx, dy)
        lean = np.array([0.0, 0.0, -dx / length, -dy / length, 0.0, 1.0])
        lean /= _USUAL * length / (newest.time - before.time)
        rest, tried = 2 * len(self._since) - 5, []
        for i, last in enumerate(self._last):
            flight = [seen for seen in (*self._last[i + 1 :], *self._since) if seen.time > last.time]
            for k in range(_LAUNCHES):
                start = last.time + (flight[0].time - last.time) * k / _LAUNCHES
                found, misfit = self._fit(flight, start, _still(last), _START, lean)
                tried.append((misfit / (2 * len(flight) - 5) * rest, start, found, last, flight))
        misfit, start, found, last, flight = min(tried, key=lambda each: each[0])
        if self.hop is not None and len(flight) >= _SETTLED_FLIGHT_DETECTIONS:
            self._last, self._since = [last], flight
        return _hop(start, found, 0), misfit

    def _fit(
        self,
        flight: list[_BallDetection],
        start: float,
        mean: FloatArray,
        about: tuple[float, ...],
        lean: FloatArray | None = None,
    ) -> tuple[FloatArray, float]:
        """Fit x, y, vx, vy, z, vz at a time to detections; return them and the misfit of these.

        They are expected at ``mean`` to within ``about``, and ``lean`` times them at 0 to within 1.
        """
        count = len(flight)
        rows, right = np.zeros((2 * count, 6)), np.zeros(2 * count)
        times, places = _columns(flight)
        t = times - start
        fallen = 0.5 * GRAVITY * t * t
        for k, shifts in enumerate(([seen.ax for seen in flight], [seen.ay for seen in flight])):
            a = np.array(shifts)
            part = rows[k * count : (k + 1) * count]
            part[:, k], part[:, 2 + k], part[:, 4], part[:, 5] = 1.0, t, a, a * t
            right[k * count : (k + 1) * count] = places[:, k] + a * fallen
        known = self._variance / np.array(about) ** 2
        left = rows.T @ rows + np.diag(known)
        if lean is not None:
            left += self._variance * np.outer(lean, lean)
        found: FloatArray = np.linalg.solve(left, rows.T @ right + known * mean).astype(np.float64)
        off = rows @ found - right
        return found, float(off @ off) / self._variance

    def _follow(self, hop: Hop, seen: _BallDetection) -> None:
        """Improve the flight by a detection, up to where the ball rolls or is lost."""
        while seen.time > hop.time + hop.lasts():
            hop = self._expected = hop.next(self._ball)
            self._since = []
            if hop.ball.vz == 0.0:
                self.landed, self.hop = predict_ball(hop.ball, seen.time - hop.time, self._ball), None
                return
        ball = hop.at(seen.time)
        astray = hypot(ball.x + seen.ax * ball.z - seen.x, ball.y + seen.ay * ball.z - seen.y)
        self._lost = self._lost + 1 if astray > _LOST_DISTANCE else 0
        if self._lost >= _LOST_FOR:
            self.hop = None
            return
        before = self._before if hop.count == 0 else None
        if before is not None and not _left(before, seen):
            return
        self._since.append(seen)
        if before is not None:
            hop, _ = self._launch(before)
        elif self._expected is not None:
            start = self._expected.ball
            mean = np.array([start.x, start.y, start.vx, start.vy, 0.0, start.vz])
            found, _ = self._fit(self._since, self._expected.time, mean, _HOP)
            hop = _hop(self._expected.time, found, hop.count)
        self.hop = hop


def _left(before: _BallDetection, seen: _BallDetection) -> bool:
    """Return whether a ball was later seen elsewhere; otherwise it has no direction."""
    return seen.time > before.time and hypot(seen.x - before.x, seen.y - before.y) >= _BACK


def _columns(flight: list[_BallDetection]) -> tuple[FloatArray, FloatArray]:
    """Return times (n,) and places (n, 2) of detections."""
    return np.array([seen.time for seen in flight]), np.array([(seen.x, seen.y) for seen in flight])


def _still(seen: _BallDetection) -> FloatArray:
    """Return x, y, vx, vy, z, vz of a ball that lies where it is seen."""
    return np.array([seen.x, seen.y, 0.0, 0.0, 0.0, 0.0])


def _hop(time: float, found: FloatArray, count: int) -> Hop:
    x, y, vx, vy, z, vz = found.tolist()
    return Hop(time, BallMotion(x, y, vx, vy, 0.0, z, vz), count)
