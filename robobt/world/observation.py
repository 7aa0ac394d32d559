"""What observation vectors are made of, whatever they hold."""

from __future__ import annotations

from dataclasses import dataclass

from robobt.world.geometry import FloatArray
from robobt.world.state import Frame, RobotState

Row = FloatArray | tuple[float, ...]
"""Numbers in a fixed order: a robot's x, y, heading, vx, vy, omega or a ball's x, y, vx, vy."""


@dataclass(frozen=True)
class ObservationSpec:
    """Name, version and entries (name, unit) of an observation vector."""

    name: str
    version: int
    entries: tuple[tuple[str, str], ...]

    @property
    def size(self) -> int:
        """Length of the vector."""
        return len(self.entries)


def observation_spec(name: str, version: int, **units: str) -> ObservationSpec:
    """Return the observation whose entries are the keywords, in their order, with their units."""
    return ObservationSpec(name, version, tuple(units.items()))


def kinematics(r: RobotState) -> Row:
    """Return a robot as observations take it."""
    # Whole numbers would make numba compile a version of their own.
    return (float(r.x), float(r.y), float(r.heading), float(r.vx), float(r.vy), float(r.omega))


def motion(frame: Frame) -> Row:
    """Return the ball as observations take it."""
    ball = frame.ball
    return (float(ball.x), float(ball.y), float(ball.vx), float(ball.vy))
