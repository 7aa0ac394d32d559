"""Whether the ball still slides, from the change of its speed."""

from __future__ import annotations

from math import inf
from typing import Protocol

from robobt.world.compiled import compilable
from robobt.world.state import Frame

_OLDEST = 0.2
"""Frames farther apart allow no conclusion about the deceleration [s]."""
_KICK_ACCELERATION = 2.0
"""A ball that speeds up faster than this has been hit [m/s^2]."""
_GUESS = 0.8
"""Share of its speed at which a ball will roll if its kick was not seen."""


@compilable
def rolling_after(
    elapsed: float, before: float, rolling: float, speed: float, slide: float, roll: float, share: float
) -> float:
    """Return the speed at which a ball will roll, or its own when it seems to roll already [m/s].

    Args:
        elapsed: time since the last frame [s].
        before: the ball's speed in the last frame [m/s].
        rolling: the result for the last frame [m/s].
        speed: the ball's speed now [m/s].
        slide: the ball's deceleration while it slides [m/s^2].
        roll: the ball's deceleration while it rolls [m/s^2].
        share: share of a kick's speed at which the ball rolls.
    """
    if not 0.0 < elapsed < _OLDEST:
        return speed
    deceleration = (before - speed) / elapsed
    if deceleration < -_KICK_ACCELERATION:
        return share * speed
    if deceleration < 0.5 * (slide + roll):
        return speed
    return _GUESS * speed if rolling >= speed else rolling


class Watch(Protocol):
    """Time of the ball's last observation [s], its speed then, and the speed below which it rolls [m/s]."""

    time: float
    speed: float
    rolling: float


@compilable
def follow(watch: Watch, time: float, speed: float, slide: float, roll: float, share: float) -> float:
    """Look at the ball's speed at a ``time``; return that below which it rolls [m/s]."""
    elapsed = time - watch.time
    if elapsed != 0.0:
        watch.rolling = rolling_after(elapsed, watch.speed, watch.rolling, speed, slide, roll, share)
        watch.time, watch.speed = time, speed
    return min(watch.rolling, speed)


class BallWatch:
    """The ball's speed from frame to frame, a :class:`Watch`.

    A frame holds no spin, so a sliding ball and a rolling one look the same in
    it; over two frames the sliding one loses its speed several times as fast.
    """

    def __init__(self) -> None:
        self.time = -inf
        self.speed = 0.0
        self.rolling = 0.0

    def rolling_speed(self, frame: Frame) -> float:
        """Return the speed [m/s] below which the ball rolls: its own when it already rolls."""
        model = frame.ball_model
        slide, roll, share = model.slide_deceleration, model.roll_deceleration, model.switch_share
        return follow(self, frame.time, frame.ball.speed, slide, roll, share)
