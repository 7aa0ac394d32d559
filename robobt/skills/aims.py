"""Where a ball may be kicked: what raters and selections return."""

from __future__ import annotations

from dataclasses import dataclass

from robobt.world.geometry import Point


@dataclass(slots=True, frozen=True)
class Shot:
    """A rated shot: what every shot rater returns.

    Attributes:
        target: point to aim at, on the opponent's goal line [m].
        tolerance: half angle around it that still counts as this shot [rad].
        score: 0 (hopeless) to 1 (as good as in).
    """

    target: Point
    tolerance: float
    score: float


@dataclass(slots=True, frozen=True)
class GoalLine:
    """The opponent's goal line as a shot rater judges it, small enough to be recorded at every tick.

    Attributes:
        reach: distance of the outermost points from the goal's middle, on either side; the others are evenly
            spaced between them [m].
        chances: chance of a goal at every point from right (y < 0) to left, in percent, one byte each, in
            base64.
    """

    reach: float
    chances: str


@dataclass(slots=True, frozen=True)
class Pass:
    """A chosen pass.

    Attributes:
        receiver: the receiver's number.
        target: point to which it is kicked [m].
        speed: speed of the ball when it is kicked [m/s].
        score: how good it is, 0 to 1.
        wait: how long to wait before the kick, so that the receiver is there in time [s].
        chip: whether the ball is chipped over robots.
    """

    receiver: int
    target: Point
    speed: float
    score: float
    wait: float = 0.0
    chip: bool = False
