"""Travel times and kick speeds of a ball, in closed form."""

from __future__ import annotations

from itertools import accumulate
from math import cos, inf, sin, sqrt

from pydantic import Field

from robobt.config.validation import Settings
from robobt.world.command import CHIP_ANGLE
from robobt.world.compiled import compilable

GRAVITY = 9.81
"""Acceleration of free fall [m/s^2]."""

LOWEST_HOP = 0.01
"""Lowest hop; below it the ball rolls [m]. Source: Sumatra's model of a chip."""


@compilable
def way_in(time: float, speed: float, rolling: float, slide: float, roll: float) -> float:
    """Return how far a ball seen at ``speed`` goes within ``time`` [m].

    It slides with the deceleration ``slide`` down to the speed ``rolling``, then rolls with ``roll`` [m/s^2].
    """
    way = 0.0
    if rolling < speed:
        sliding = min(time, (speed - rolling) / slide)
        way = (speed - 0.5 * slide * sliding) * sliding
        speed -= slide * sliding
        time -= sliding
    rolled = min(time, speed / roll)
    return way + (speed - 0.5 * roll * rolled) * rolled


@compilable
def time_for(way: float, speed: float, rolling: float, slide: float, roll: float) -> float:
    """Return the seconds for ``way`` [m], the inverse of :func:`way_in`; inf if the ball rests before."""
    if way <= 0.0:
        return 0.0
    time = 0.0
    if rolling < speed:
        slid = (speed * speed - rolling * rolling) / (2.0 * slide)
        if way <= slid:
            return (speed - sqrt(speed * speed - 2.0 * slide * way)) / slide
        time, way, speed = (speed - rolling) / slide, way - slid, rolling
    at_end = speed * speed - 2.0 * roll * way
    return time + (speed - sqrt(at_end)) / roll if at_end >= 0.0 else inf


@compilable
def kick_speed(distance: float, arrival_speed: float, slide: float, roll: float, share: float) -> float:
    """Return the kick speed with which a ball has ``arrival_speed`` after ``distance`` [m/s, m].

    It rolls from ``share`` of that speed on; ``slide`` and ``roll`` are as for :func:`way_in`.
    """
    sliding = sqrt(arrival_speed * arrival_speed + 2.0 * slide * distance)
    if share * sliding <= arrival_speed:
        return sliding
    squared = (distance + arrival_speed * arrival_speed / (2.0 * roll)) / (
        (1.0 - share * share) / (2.0 * slide) + share * share / (2.0 * roll)
    )
    return sqrt(squared)


class BallModel(Settings):
    """The motion of a kicked ball: it slides, then rolls; a chipped ball flies and hops before it rolls.

    On the ground it slides with one deceleration down to ``switch_share`` of the
    speed it was kicked with, and rolls with a smaller one from there to rest. A
    chip leaves at 45 degrees. At each touch-down it keeps a share of its speed
    along the ground and rises with a share of the speed with which it fell; it
    rolls once the next hop would be lower than 1 cm.

    The defaults are those of the default simulator; parameters and names follow
    the models of the league's vision packet (straight_two_phase, chip_fixed_loss).
    """

    slide_deceleration: float = Field(3.0, gt=0, le=50, description="while it slides [m/s^2]")
    switch_share: float = Field(0.66, gt=0.05, lt=1, description="share of the kick speed where it rolls")
    roll_deceleration: float = Field(0.3, gt=0, le=20, description="while it rolls [m/s^2]")
    first_hop: float = Field(0.8, ge=0, le=1, description="share of its speed kept at the first touch-down")
    other_hops: float = Field(0.85, ge=0, le=1, description="the same at all others")
    rebound: float = Field(0.47, ge=0, lt=1, description="share of the speed of falling with which it rises")

    def time_to(self, distance: float, speed: float) -> float:
        """Return the seconds in which a ball kicked at ``speed`` [m/s] goes ``distance`` [m], else inf."""
        return self.time_for(distance, speed, self.switch_share * speed)

    def way_in(self, time: float, speed: float, rolling: float | None = None) -> float:
        """Return how far a ball seen at ``speed`` goes within ``time`` [m].

        It rolls from the speed ``rolling`` on [m/s]; None when it rolls already.
        """
        rolls = speed if rolling is None else rolling
        return way_in(time, speed, rolls, self.slide_deceleration, self.roll_deceleration)

    def time_for(self, way: float, speed: float, rolling: float | None = None) -> float:
        """Return the seconds for ``way`` [m], the inverse of :meth:`way_in`; inf if the ball rests before."""
        rolls = speed if rolling is None else rolling
        return time_for(way, speed, rolls, self.slide_deceleration, self.roll_deceleration)

    def kick_speed(self, distance: float, arrival_speed: float) -> float:
        """Return the kick speed with which the ball has ``arrival_speed`` after ``distance`` [m/s, m]."""
        slide, roll = self.slide_deceleration, self.roll_deceleration
        return kick_speed(max(0.0, distance), arrival_speed, slide, roll, self.switch_share)

    def touch_downs(self, speed: float) -> list[tuple[float, float]]:
        """Return when and how far from the kick a ball chipped at ``speed`` [m/s] touches down [s, m]."""
        rises = [speed * sin(CHIP_ANGLE)]
        while (rises[-1] * self.rebound) ** 2 >= 2.0 * GRAVITY * LOWEST_HOP:
            rises.append(rises[-1] * self.rebound)
        times = [2.0 * rise / GRAVITY for rise in rises]
        ways = [self.along(speed, hop) * time for hop, time in enumerate(times)]
        return list(zip(accumulate(times), accumulate(ways), strict=True))

    def along(self, speed: float, touch_downs: int) -> float:
        """Return the speed along the ground of such a chip after this many touch-downs [m/s]."""
        kept = self.first_hop * self.other_hops ** (touch_downs - 1) if touch_downs else 1.0
        return speed * cos(CHIP_ANGLE) * kept

    def chip_speed(self, distance: float, touch_downs: int = 1) -> float:
        """Return the speed of the chip that is ``distance`` away at that touch-down [m/s, m].

        That is v in F v^2 sin(a) cos(a) 2 / g, where F sums the hops as shares of the first.
        """
        share = sum(self.along(1.0, hop) * self.rebound**hop for hop in range(touch_downs))
        return sqrt(max(distance, 0.0) * GRAVITY / (2.0 * share * sin(CHIP_ANGLE)))


DEFAULT_BALL = BallModel()

SLIDE_DECELERATION, ROLL_DECELERATION = DEFAULT_BALL.slide_deceleration, DEFAULT_BALL.roll_deceleration
"""How the default ball slows down while it slides and while it rolls [m/s^2]."""

SWITCH_SHARE = DEFAULT_BALL.switch_share
"""Share of its kick's speed at which the default ball begins to roll."""
