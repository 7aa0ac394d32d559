"""Kicks: what becomes of a commanded speed, and of the speed with which a ball came to the first touch."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, hypot, nan, sin, sqrt
from typing import NamedTuple

import numpy as np

from robobt.identify.ball import SeenKick
from robobt.identify.ball_ways import MOUTH_DISTANCE
from robobt.identify.estimate import Estimate, from_error, not_negative, unseen
from robobt.identify.observations import Observations
from robobt.world.geometry import FloatArray

_KICK_TIME = 0.07
"""The heading at a kick is that of a line through what was seen within this time of it [s]."""

_COMMANDED_BEFORE, _COMMANDED_AFTER = 0.06, 0.02
"""How long before and after it could take effect a command to kick is looked for [s]."""

_SAME_COMMAND = 0.03
"""Relative difference of commanded speeds within that time from which it is unclear which was kicked."""

_UNLIMITED_KICK = 6.35
"""A faster ball may have been held back by the kicker at the rules' limit, and its speed tells nothing of a
touch [m/s]."""

_LEAST_KICKS, _LEAST_TOUCHES, _LEAST_CARRIED = 3, 4, 3
"""Numbers of kicks, of first touches and of kicks of a ball that moved with the robot below which their
shares are not seen enough."""

_BEFORE_KICK, _ALIKE, _MOVING, _PUSHES = 0.1, 0.2, 0.3, 0.1
"""A ball seen within this time before its kick [s] moved with the robot if it was as fast ahead, to within
this much, and rested if it was slower than that, while the robot was faster than this [m/s]. Kicks of a
resting ball show the carried share only where it is clearly more than this."""

_MOST_SHARE_ERROR, _MOST_TOUCH_ERROR = 0.1, 0.1
"""Half widths of intervals beyond which the share of a command and those of a touch are not seen enough."""

_OUTLYING_KICK = 4.0


class KickEstimate(NamedTuple):
    """What kicks do.

    Attributes:
        share: of the commanded speed that a ball leaves with; own robots only.
        spread: relative standard deviation of that.
        returned: share of the speed at which a ball comes that a kick on the first touch adds; own robots
            only.
        kept: share of a ball's speed across the heading, seen by the robot's front, that a kick on the first
            touch leaves.
        carried: share of the forward speed of a ball that moves with the robot which a kick adds.
        fastest: speed of the fastest kick of any robot [m/s].
    """

    share: Estimate
    spread: Estimate
    returned: Estimate
    kept: Estimate
    carried: Estimate
    fastest: Estimate


@dataclass(slots=True)
class _Kick:
    """A kick in the robot's frame: what was commanded, how the ball left and, negative towards it, came.

    ``front`` is how fast the robot's front moved sideways [m/s]; ``carried`` says whether the ball was seen
    to move ahead with the robot, ``pushed`` whether it rested and the robot drove into it.
    """

    commanded: float
    ahead: float
    aside: float
    came_ahead: float
    came_aside: float
    first_touch: bool
    turn: float
    front: float
    carried: bool = False
    pushed: bool = False

    @property
    def held_back(self) -> bool:
        """Whether the kicker may have held the ball back at the rules' limit."""
        return self.first_touch and hypot(self.ahead, self.aside) >= _UNLIMITED_KICK


def identify_kicks(seen: Observations, kicks: list[SeenKick], delay: float | None) -> KickEstimate:
    """Identify what kicks do.

    Args:
        seen: what cameras saw and what was sent.
        kicks: that were seen.
        delay: whole delay from a command to its seen effect [s]; None where no commands are known.

    Returns:
        the figures, each with its interval.
    """
    found = [kick for it in kicks if (kick := _in_frame(seen, it, delay)) is not None]
    fastest = max([it.speed for it in kicks], default=0.0)
    return KickEstimate(
        *_shares([kick for kick in found if kick.commanded > 0.0]),
        Estimate(fastest, fastest, fastest, len(kicks), len(kicks) >= _LEAST_KICKS, "m/s"),
    )


def _in_frame(seen: Observations, kick: SeenKick, delay: float | None) -> _Kick | None:
    near = np.flatnonzero(np.abs(seen.times - kick.time) < _KICK_TIME)
    near = near[np.isfinite(seen.poses[near, kick.robot, 0])]
    if len(near) < 4:
        return None
    since = seen.times[near] - kick.time
    _, turn, heading = np.polyfit(since, np.unwrap(seen.poses[near, kick.robot, 2]), 2).tolist()
    drove = np.array([np.polyfit(since, seen.poses[near, kick.robot, axis], 1)[0] for axis in (0, 1)])
    c, s = cos(heading), sin(heading)
    came = drove if kick.came is None else kick.came
    angle = kick.direction - heading
    commanded = _commanded(seen, kick, delay)
    first_touch = kick.came is not None and commanded > 0.0
    if kick.came is not None and not first_touch:
        commanded = 0.0
    found = _Kick(
        commanded,
        kick.speed * cos(angle),
        kick.speed * sin(angle),
        float(c * came[0] + s * came[1]),
        float(c * came[1] - s * came[0]),
        first_touch,
        abs(turn),
        float(c * drove[1] - s * drove[0]) + turn * MOUTH_DISTANCE,
    )
    if kick.came is None and found.came_ahead > _MOVING:
        before = _ball_before(seen, kick.time, heading)
        found.carried = abs(before - found.came_ahead) < _ALIKE
        found.pushed = abs(before) < min(_ALIKE, 0.5 * found.came_ahead)
    return found


def _ball_before(seen: Observations, time: float, heading: float) -> float:
    """Return how fast the ball moved along a robot's heading just before its kick [m/s]; NaN if unknown."""
    rows = np.flatnonzero((seen.times > time - _BEFORE_KICK) & (seen.times < time))
    rows = rows[np.isfinite(seen.ball[rows, 0])]
    if len(rows) < 4:
        return nan
    vx, vy = np.polyfit(seen.times[rows] - time, seen.ball[rows], 1)[0].tolist()
    return float(cos(heading) * vx + sin(heading) * vy)


def _commanded(seen: Observations, kick: SeenKick, delay: float | None) -> float:
    """Return the speed that was commanded for a flat kick [m/s]; 0 if that is not known."""
    if delay is None:
        return 0.0
    sent = kick.time - delay
    rows = np.flatnonzero((seen.sent > sent - _COMMANDED_BEFORE) & (seen.sent < sent + _COMMANDED_AFTER))
    speeds = seen.commands[rows, kick.robot, 3]
    asked = speeds > 0.0
    if not asked.any() or np.any(seen.commands[rows[asked], kick.robot, 4] > 0.0):
        return 0.0
    speeds = speeds[asked]
    middle = float(np.median(speeds))
    return middle if np.ptp(speeds) < _SAME_COMMAND * middle else 0.0


def _shares(kicks: list[_Kick]) -> tuple[Estimate, Estimate, Estimate, Estimate, Estimate]:
    """Return the share of the command, its spread, what touches give back and keep, and what kicks carry on.

    Among few touches a misread one, such as that of a ball that met the hull before the mouth, looks as good
    as any. So the errors of a touch's shares are at least the jackknife's over touches.
    """
    pushed = True
    fitted = _fitted(kicks, pushed)
    if fitted is None or fitted.numbers[3] - 2.0 * fitted.deviations[3] < _PUSHES:
        pushed = False
        fitted = _fitted(kicks, pushed)
    if fitted is None:
        count = sum(not kick.held_back for kick in kicks)
        return unseen(count), unseen(count), unseen(), unseen(), unseen()
    numbers, deviations, residuals = fitted
    touches = [kick for kick in kicks if kick.first_touch]
    without = [_fitted([other for other in kicks if other is not kick], pushed) for kick in touches]
    if len(touches) >= _LEAST_TOUCHES and all(it is not None for it in without):
        others = np.array([it.numbers for it in without if it is not None])
        jackknife = np.sqrt((len(touches) - 1) * np.mean((others - others.mean(axis=0)) ** 2, axis=0))
        deviations[1:] = np.maximum(deviations[1:], jackknife[1:])
    count, free = len(residuals), sum(not kick.held_back for kick in touches)
    carried = sum(kick.carried or (pushed and kick.pushed) for kick in kicks)
    freedom = max(count - 1, 1)
    deviation = sqrt(float(np.sum(residuals**2)) / freedom)
    half = 1.96 * deviation / sqrt(2.0 * freedom)
    return (
        _judged(numbers[0], deviations[0], count, _LEAST_KICKS, _MOST_SHARE_ERROR),
        Estimate(deviation, max(deviation - half, 0.0), deviation + half, count, count >= 5),
        not_negative(_judged(numbers[1], deviations[1], free, _LEAST_TOUCHES, _MOST_TOUCH_ERROR)),
        not_negative(_judged(numbers[2], deviations[2], len(touches), _LEAST_TOUCHES, _MOST_TOUCH_ERROR)),
        _judged(numbers[3], deviations[3], carried, _LEAST_CARRIED, _MOST_TOUCH_ERROR),
    )


class _Fit(NamedTuple):
    """Shares of command, approach, sideways and carried speed, their errors, and good kicks' misses."""

    numbers: FloatArray
    deviations: FloatArray
    residuals: FloatArray


def _fitted(kicks: list[_Kick], pushed: bool) -> _Fit | None:
    """Fit the four shares; None if too few kicks tell how fast a commanded ball leaves.

    Each kick tells how fast the ball left, unless a limit held it back, and each first touch how it left
    aside; both are linear in the shares. With ``pushed`` a resting ball is carried on as one that moved. The
    direction of a ball that a limit held back is as without.
    """
    rows, values, errors = [], [], []
    for kick in kicks:
        slope = kick.aside / kick.ahead
        if kick.first_touch:
            across = kick.came_aside - kick.front
            rows.append((slope * kick.commanded, -slope * kick.came_ahead, -across, 0.0))
            values.append(kick.front)
            angle_error = hypot(_ANGLE_ERROR, _TIME_ERROR * kick.turn)
            errors.append(hypot(angle_error * kick.ahead, _SPEED_ERROR))
        if not kick.held_back:
            # How a ball that the robot had moved on its own is not known well.
            carried = kick.carried or (pushed and kick.pushed)
            unsure = 0.0 if kick.first_touch or carried or kick.pushed else _HELD_ERROR * kick.came_ahead
            returned = -kick.came_ahead if kick.first_touch else 0.0
            rows.append((kick.commanded, returned, 0.0, kick.came_ahead if carried else 0.0))
            values.append(kick.ahead)
            errors.append(hypot(_LENGTH_ERROR * kick.commanded, _SPEED_ERROR, unsure))
    lengths = [i for i, row in enumerate(rows) if row[2] == 0.0 and row[0] > 0.0]
    if len(lengths) < _LEAST_KICKS:
        return None
    matrix, left, error = np.array(rows), np.array(values), np.array(errors)
    numbers, weights = _EXPECTED_SHARES.copy(), 1.0 / error**2
    spread = 1.0
    for _ in range(30):
        normal = (matrix * weights[:, None]).T @ matrix + np.diag(1.0 / _SHARES_ERROR**2)
        numbers = np.linalg.solve(
            normal, (matrix * weights[:, None]).T @ left + _EXPECTED_SHARES / _SHARES_ERROR**2
        )
        size = (left - matrix @ numbers) / error
        spread = max(1.0, 1.4826 * float(np.median(np.abs(size[lengths]))))
        weights = 1.0 / (error * spread) ** 2 / (1.0 + (size / (3.0 * spread)) ** 2) ** 2
    misses = (left - matrix @ numbers)[lengths] / matrix[lengths, 0]
    good = np.abs(size[lengths]) < _OUTLYING_KICK * spread
    return _Fit(numbers, np.sqrt(np.diag(np.linalg.inv(normal))), misses[good])


def _judged(value: float, error: float, count: int, least: int, most: float) -> Estimate:
    estimate = from_error(float(value), float(error), count, count >= least, freedom=max(count - 1, 1))
    return replace(estimate, seen=estimate.seen and estimate.half_width < most)


_EXPECTED_SHARES, _SHARES_ERROR = np.array([1.0, 0.12, 0.6, 0.0]), np.array([0.2, 0.15, 0.4, 0.5])
"""Shares of command, approach, sideways and carried speed before anything was seen, and their standard
errors. Source of the first three: figures that TIGERs published of real fields and expect of simulators."""

_ANGLE_ERROR, _TIME_ERROR, _LENGTH_ERROR, _SPEED_ERROR, _HELD_ERROR = 0.006, 0.002, 0.004, 0.015, 0.15
"""Standard errors of a direction [rad], of the moment of a kick [s], of a speed as a share of it, of what a
fit leaves [m/s], and of the speed of a ball that the robot had, as a share of the robot's."""
