"""What observation vectors are made of, whatever they hold."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from robobt.world.geometry import FloatArray
from robobt.world.state import Frame, RobotState

Row = FloatArray | tuple[float, ...]
"""Numbers in a fixed order: a robot's x, y, heading, vx, vy, omega or a ball's x, y, vx, vy."""


@dataclass(frozen=True, slots=True)
class Entry:
    """An entry of an observation vector.

    Attributes:
        name: unique in the vector.
        unit: "1" for none.
        range: its largest magnitude, in that unit; or the name of a quantity that follows from a task's
            settings, such as ``speed``.
        scale: its typical magnitude, by which a network's input is divided; or the field of the action's
            scaling that says it, ``max_speed`` or ``max_turn``.
        signed: whether it can be negative.
    """

    name: str
    unit: str = "1"
    range: float | str = inf
    scale: float | str = 1.0
    signed: bool = True


@dataclass(frozen=True)
class ObservationSpec:
    """Name, version and entries of an observation vector.

    ``vectors`` are the indices at which plane vectors in the robot's frame begin, that to the ball first;
    none where a policy cannot be asked in the ball's frame.
    """

    name: str
    version: int
    entries: tuple[Entry, ...]
    vectors: tuple[int, ...] = ()

    @property
    def size(self) -> int:
        """Length of the vector."""
        return len(self.entries)


def entries(
    names: str, unit: str = "1", most: float | str = inf, scale: float | str = 1.0, *, signed: bool = True
) -> tuple[Entry, ...]:
    """Return entries with these ``names``, separated by blanks; ``most`` is their range.

    The rest is as for :class:`Entry`.
    """
    return tuple([Entry(name, unit, most, scale, signed) for name in names.split()])


def kinematics(r: RobotState) -> Row:
    """Return a robot as observations take it."""
    # Whole numbers would make numba compile a version of their own.
    return (float(r.x), float(r.y), float(r.heading), float(r.vx), float(r.vy), float(r.omega))


def motion(frame: Frame) -> Row:
    """Return the ball as observations take it."""
    ball = frame.ball
    return (float(ball.x), float(ball.y), float(ball.vx), float(ball.vy))
