"""A ball in the air, up to its touch-down and on to the next hop."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

from robobt.league.estimate.ball_track import BallMotion
from robobt.sim.settings import BallSettings
from robobt.world.ball_model import GRAVITY

LAST_APEX = 0.01
"""A hop that would be lower than this is none. Source: Sumatra's model of a chip [m]."""


@dataclass(slots=True)
class Hop:
    """A ball that is in the air from ``time`` on [s]: how it was then, and its touch-downs before."""

    time: float
    ball: BallMotion
    count: int = 0

    def lasts(self) -> float:
        """Return how long it takes to touch down [s]."""
        rise, height = self.ball.vz, max(self.ball.z, 0.0)
        return max((rise + sqrt(rise * rise + 2.0 * GRAVITY * height)) / GRAVITY, 0.0)

    def apex(self) -> float:
        """Return how high it is at most from now on [m]."""
        rise = max(self.ball.vz, 0.0)
        return self.ball.z + 0.5 * rise * rise / GRAVITY

    def at(self, time: float) -> BallMotion:
        """Return the ball at a time up to where it touches down."""
        start, t = self.ball, time - self.time
        z = max(start.z + (start.vz - 0.5 * GRAVITY * t) * t, 0.0)
        place = start.x + start.vx * t, start.y + start.vy * t
        return BallMotion(*place, start.vx, start.vy, 0.0, z, start.vz - GRAVITY * t)

    def next(self, ball: BallSettings) -> Hop:
        """Return what follows: another hop, or a ball that rolls and rises no more."""
        lands = self.time + self.lasts()
        at = self.at(lands)
        keep = ball.other_hops if self.count else ball.first_hop
        rise = -ball.rebound * at.vz
        if rise * rise < 2.0 * GRAVITY * LAST_APEX:
            rise = 0.0
        return Hop(lands, BallMotion(at.x, at.y, keep * at.vx, keep * at.vy, inf, 0.0, rise), self.count + 1)
