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
        reach: the outermost points lie this far to either side of the goal's middle, the others
            evenly between them [m].
        chances: of every point from right (y < 0) to left the chance of a goal in percent, a
            byte each, in base64.
    """

    reach: float
    chances: str


@dataclass(slots=True, frozen=True)
class Pass:
    """A chosen pass.

    Attributes:
        receiver: the receiver's number.
        target: where it goes [m].
        speed: of the ball as it is kicked [m/s].
        score: how good it is, 0 to 1.
        wait: how long it must not be kicked yet, for the receiver to be there in time [s].
        chip: whether it flies over robots first.
    """

    receiver: int
    target: Point
    speed: float
    score: float
    wait: float = 0.0
    chip: bool = False
