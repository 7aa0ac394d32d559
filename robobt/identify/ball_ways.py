"""The ways of a free ball: each along its line, with its own speeds, and whether it began with a kick."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt

import numpy as np

from robobt.identify.free_ball import Stretch, carried_on
from robobt.identify.observations import Observations
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.state import BALL_RADIUS

MOUTH_DISTANCE = 0.075 + BALL_RADIUS
"""Distance from a robot's centre to a ball in its mouth [m]."""

_KICKED = 1.0
"""A ball that leaves this much faster than its robot drives was kicked [m/s]."""

_KICK_ANGLE, _TOUCH_ANGLE = 0.2, 0.9
"""Largest angle between a robot's heading and the way of a ball that it kicked, or kicked on [rad]."""

_PASSED_ON, _LEAST_CLOSING = 0.25, 0.5
"""A ball that leaves within this time [s] after it came at this speed [m/s] may have been kicked on."""

SLOWEST_WAY, _SHORTEST = 0.15, 0.05
"""Least speed [m/s] and way [m] of a stretch that tells something."""


@dataclass(slots=True)
class Way:
    """A stretch of free ball along its line.

    Attributes:
        stretch: the stretch.
        times: (n,) since its first detection [s].
        ways: (n,) along the line [m].
        local: its own numbers: where it begins [m], its speed there, and from which speed on it rolls [m/s].
        direction: of the line [rad].
        looks_kicked: whether a robot seems to have kicked it.
        back: from the first detection back to the mouth of that robot [m].
        sideways: root mean square of what was seen across the line [m].
        weights: (n,) of the detections.
        arrived: when a ball that was kicked on had come to the mouth [s]; None for any other.
        kicked: whether it counts as a kick, which takes all spin.
        good: whether a free ball on the ground explains it.
    """

    stretch: Stretch
    times: FloatArray
    ways: FloatArray
    local: FloatArray
    direction: float
    looks_kicked: bool
    back: float
    sideways: float
    weights: FloatArray
    arrived: float | None
    kicked: bool = False
    good: bool = True


def ways_of(seen: Observations, free: list[Stretch]) -> list[Way]:
    """Return the ways of a free ball that went far enough.

    Args:
        seen: what cameras saw.
        free: its stretches of free ball.

    Returns:
        the ways, in their order.
    """
    poses = carried_on(seen.poses)
    pairs = zip(free, [None, *free], strict=False)
    return [way for it, before in pairs if (way := _way(it, before, seen, poses)) is not None]


def way_gone(ball: FloatArray, times: FloatArray, start: float, speed: float, rolling: float) -> FloatArray:
    """Return how far a ball has come at times after it had a speed.

    Args:
        ball: slide deceleration, roll deceleration [m/s^2] and switch share.
        times: since then [s].
        start: where it was then [m].
        speed: that speed [m/s].
        rolling: the speed from which it rolls [m/s].
    """
    slide, roll = ball[0], ball[1]
    rolling = min(rolling, speed)
    until = (speed - rolling) / slide
    slid = np.minimum(times, until)
    rolled = np.clip(times - until, 0.0, rolling / roll)
    gone: FloatArray = (speed - 0.5 * slide * slid) * slid + (rolling - 0.5 * roll * rolled) * rolled
    return start + gone


def _arrival(before: Stretch, stretch: Stretch, robot: FloatArray) -> float | None:
    """Return when the ball of the stretch before came to the mouth of the robot [s]; None if it did not."""
    if before.after != stretch.before or stretch.times[0] - before.times[-1] > _PASSED_ON:
        return None
    last = before.places[-3:] - robot[:2]
    gaps = np.hypot(*last.T)
    closing = (gaps[0] - gaps[-1]) / (before.times[-1] - before.times[-3])
    if closing < _LEAST_CLOSING:
        return None
    return float(before.times[-1] + (gaps[-1] - MOUTH_DISTANCE) / closing)


def _way(stretch: Stretch, before: Stretch | None, seen: Observations, poses: FloatArray) -> Way | None:
    times = stretch.times - stretch.times[0]
    centre = stretch.places.mean(axis=0)
    turned = np.linalg.svd(stretch.places - centre, full_matrices=False)[2]
    axis, across = turned[0], turned[1]
    ways = (stretch.places - centre) @ axis
    if ways[-1] < ways[0]:
        axis, ways = -axis, -ways
    if ways[-1] - ways[0] < _SHORTEST:
        return None
    sideways = float(np.sqrt(np.mean(((stretch.places - centre) @ across) ** 2)))
    early = times <= max(0.1, times[min(4, len(times) - 1)])
    speed, start = np.polyfit(times[early], ways[early], 1)
    if speed < SLOWEST_WAY:
        return None
    direction = float(np.arctan2(axis[1], axis[0]))
    kicked, back, came = False, 0.0, None
    if stretch.before >= 0:
        row = max(stretch.first - 1, 0)
        robot = poses[row, stretch.before]
        gap = hypot(*(stretch.places[0] - robot[:2]))
        back = max(gap - MOUTH_DISTANCE, 0.0)
        early_row = max(row - 6, 0)
        took = seen.times[row] - seen.times[early_row]
        drove = hypot(*(robot[:2] - poses[early_row, stretch.before, :2])) / took if took > 0.0 else 0.0
        along = abs(wrap_angle(direction - float(robot[2])))
        came = None if before is None else _arrival(before, stretch, robot)
        kicked = speed > drove + _KICKED and along < (_KICK_ANGLE if came is None else _TOUCH_ANGLE)
    local = np.array([start, speed, (DEFAULT_BALL.switch_share if kicked else 0.9) * speed])
    return Way(stretch, times, ways, local, direction, kicked, back, sideways, np.ones(len(times)), came)


def rolling_speed(it: Way, ball: FloatArray, local: FloatArray) -> float:
    """Return the speed from which a way's ball rolls [m/s].

    Args:
        it: the way.
        ball: slide deceleration, roll deceleration [m/s^2] and switch share.
        local: the way's own numbers.
    """
    if it.kicked:
        return float(ball[2] * sqrt(max(local[1], 0.0) ** 2 + 2.0 * ball[0] * it.back))
    return float(local[2])


def residuals_of(it: Way, ball: FloatArray, local: FloatArray) -> FloatArray:
    """Return by how much what was seen misses a way with such a ball and such numbers of its own [m].

    Args:
        it: the way.
        ball: slide deceleration, roll deceleration [m/s^2] and switch share.
        local: the way's own numbers.
    """
    return it.ways - way_gone(ball, it.times, local[0], local[1], rolling_speed(it, ball, local))


def speed_after(it: Way, ball: FloatArray, since: float) -> float:
    """Return the speed of a ball some time after its stretch [m/s].

    Args:
        it: its way.
        ball: slide deceleration, roll deceleration [m/s^2] and switch share.
        since: time since the stretch's last detection [s].
    """
    time = it.times[-1] + since
    speed, rolling = float(it.local[1]), min(rolling_speed(it, ball, it.local), float(it.local[1]))
    slid = min(time, (speed - rolling) / ball[0])
    return float(max(speed - ball[0] * slid - ball[1] * (time - slid), 0.0))
