"""The interface every backend implements: the simulator, the league, a recorded match."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

from robobt.world.command import RobotCommand
from robobt.world.state import Frame, RobotId


@dataclass(slots=True)
class Placement:
    """Where everything stands at a start, in world coordinates (blue defends -x).

    Attributes:
        robots: (x, y, heading) of each robot [m, m, rad]; all at rest.
        ball: (x, y, vx, vy) [m, m, m/s, m/s].
    """

    robots: dict[RobotId, tuple[float, float, float]] = field(default_factory=dict)
    ball: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)


class Snapshots(Protocol):
    """A world's numbers as they lie in memory, for records.

    Taking a frame apart number by number costs many times as much.
    """

    @property
    def robots(self) -> Sequence[RobotId]:
        """The robots, all of them always on the field, in the order of the numbers."""

    def snapshot(self) -> bytes:
        """Return the true state.

        x, y, vx, vy of the ball [m, m/s], x, y, heading, vx, vy, omega of each robot
        [m, rad, m/s, rad/s], all float64, and one byte a robot: whether it feels the ball.
        """

    def sent(self) -> bytes | None:
        """Return the commands of the last ``act``, None where not all of them may have been taken down.

        Of each robot vx, vy [m/s], omega [rad/s], kick speed [m/s], whether the kick waits
        for contact and whether the dribbler turns, all float64.
        """


@runtime_checkable
class World(Protocol):
    """A field that can be set up, looked at and acted upon.

    One control tick is one ``observe`` followed by one ``act``. Worlds inherit from
    this class, which has the optional members' defaults.
    """

    def reset(self, placement: Placement, seed: int) -> None:
        """Put robots and ball where ``placement`` says; ``seed`` fixes all later randomness.

        Raises:
            ValueError: a robot of the placement is not part of this world, or
                a coordinate is not finite or lies outside the walls.
        """

    def observe(self) -> Frame:
        """Return what the cameras and sensors report, seen from blue's side."""

    def truth(self) -> Frame:
        """Return the best knowledge of the real state, for referees and records, seen from blue's side."""

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Send one command a robot and let one control period pass.

        A robot without a command stands still.
        """

    def place_ball(self, x: float, y: float) -> None:
        """Put the ball down at rest (the referee's hand), in world coordinates [m]."""

    @property
    def shows_truth(self) -> bool:
        """Whether :meth:`observe` always returns what :meth:`truth` does."""
        return False

    @property
    def snapshots(self) -> Snapshots | None:
        """The world's numbers in memory, None where it does not offer them."""
        return None
