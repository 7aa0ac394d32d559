"""How long a kicked ball takes and how fast it has to be kicked, in closed form."""

from __future__ import annotations

from math import inf, sqrt

from pydantic import Field

from robobt.config.validation import Settings


class BallModel(Settings):
    """A ball that slides, then rolls: what skills assume about the ball.

    A kicked ball slides with one deceleration down to ``switch_share`` of the
    speed it was kicked with, and rolls with a smaller one from there to rest.
    The defaults are those of the default simulator; parameters and names follow
    the two-phase model of the league's vision packet (straight_two_phase).
    """

    slide_deceleration: float = Field(3.0, gt=0, le=50, description="while it slides [m/s^2]")
    switch_share: float = Field(0.66, gt=0.05, lt=1, description="share of the kick speed where it rolls")
    roll_deceleration: float = Field(0.3, gt=0, le=20, description="while it rolls [m/s^2]")

    def time_to(self, distance: float, speed: float) -> float:
        """Return the seconds in which a ball kicked at ``speed`` [m/s] goes ``distance`` [m], else inf."""
        return self.time_for(distance, speed, self.switch_share * speed)

    def way_in(self, time: float, speed: float, rolling: float | None = None) -> float:
        """Return how far a ball seen at ``speed`` goes within ``time`` [m].

        It rolls from the speed ``rolling`` on [m/s]; None when it rolls already.
        """
        way = 0.0
        if rolling is not None and rolling < speed:
            sliding = min(time, (speed - rolling) / self.slide_deceleration)
            way = (speed - 0.5 * self.slide_deceleration * sliding) * sliding
            speed -= self.slide_deceleration * sliding
            time -= sliding
        rolled = min(time, speed / self.roll_deceleration)
        return way + (speed - 0.5 * self.roll_deceleration * rolled) * rolled

    def time_for(self, way: float, speed: float, rolling: float | None = None) -> float:
        """Return the seconds for ``way`` [m], the inverse of :meth:`way_in`; inf if the ball rests before."""
        if way <= 0.0:
            return 0.0
        time = 0.0
        if rolling is not None and rolling < speed:
            slide = self.slide_deceleration
            slid = (speed * speed - rolling * rolling) / (2.0 * slide)
            if way <= slid:
                return (speed - sqrt(speed * speed - 2.0 * slide * way)) / slide
            time, way, speed = (speed - rolling) / slide, way - slid, rolling
        at_end = speed * speed - 2.0 * self.roll_deceleration * way
        return time + (speed - sqrt(at_end)) / self.roll_deceleration if at_end >= 0.0 else inf

    def kick_speed(self, distance: float, arrival_speed: float) -> float:
        """Return the kick speed with which the ball has ``arrival_speed`` after ``distance`` [m/s, m]."""
        slide, roll, share = self.slide_deceleration, self.roll_deceleration, self.switch_share
        distance = max(0.0, distance)
        sliding = sqrt(arrival_speed * arrival_speed + 2.0 * slide * distance)
        if share * sliding <= arrival_speed:
            return sliding
        squared = (distance + arrival_speed * arrival_speed / (2.0 * roll)) / (
            (1.0 - share * share) / (2.0 * slide) + share * share / (2.0 * roll)
        )
        return sqrt(squared)


DEFAULT_BALL = BallModel()
