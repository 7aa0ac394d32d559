"""The interface of every shot rater, and the raters by name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from typing import Annotated, TypeAlias

from robobt.config.errors import FieldError
from robobt.config.validation import Settings
from robobt.skills.store import Shot
from robobt.tree import Registry
from robobt.tree.by_name import ByName
from robobt.world.geometry import FloatArray, Point, direction, wrap_angle
from robobt.world.state import Frame, RobotState

Chances: TypeAlias = tuple[FloatArray, FloatArray]
"""Target points (T, 2) along the goal line, from right to left [m], and the chance of a goal at each (T,)."""


class ShotRater(Settings, ABC):
    """Judges shots at the opponent's goal.

    A rater is a small read-only object whose fields are its settings; everything it judges is passed in with
    the call. Every rater obeys these rules:

    * robots of both teams block, except the shooter;
    * a robot behind the ball, seen from the goal, does not;
    * mirroring the scene in the x axis mirrors the shots;
    * an additional robot never raises the best score.
    """

    @abstractmethod
    def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:
        """Return every distinct opening, the best first; an empty list without one.

        Among equally good openings, the one that needs the smallest turn of ``me`` comes first.

        Args:
            frame: the field, seen from the shooter's side.
            origin: where the ball will be kicked from [m].
            me: the robot that kicks; it does not block itself.
            delay: time until the kick [s], for raters that know about motion.
        """

    def judge(
        self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0
    ) -> tuple[list[Shot], Chances | None]:
        """Return the openings, and the chance at every point of the goal line where the rater computes one.

        Arguments are as for :meth:`~robobt.skills.aim.raters.base.ShotRater.rate_all`.
        """
        return self.rate_all(frame, origin, me, delay=delay), None

    def rate(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> Shot | None:
        """Return the best opening, None without one; arguments are as for :meth:`ShotRater.rate_all`."""
        shots = self.rate_all(frame, origin, me, delay=delay)
        return shots[0] if shots else None


RATERS: Registry[type[ShotRater]] = Registry(
    "shot rater",
    group="robobt.raters",
    fits=lambda entry: isinstance(entry, type) and issubclass(entry, ShotRater),
)
"""The shot raters by name."""


BY_NAME = ByName(RATERS, ShotRater)
"""Reads a rater by its name, alone or with settings."""

Rater: TypeAlias = Annotated[str | Mapping[str, object] | ShotRater, BY_NAME]
"""A shot rater as parameters take it: its name, a mapping with the name and settings, or a rater."""


def make_rater(rater: Rater) -> ShotRater:
    """Return the rater for a name or a mapping; a rater object is returned unchanged.

    Raises:
        ValueError: no rater has that name, it has no such setting, or it refuses a value.
    """
    try:
        made: ShotRater = BY_NAME.make(rater)
    except FieldError as error:
        raise ValueError(f"rater {error.field}: {error}") from error
    return made


def best_first(shots: Iterable[Shot], origin: Point, heading: float) -> list[Shot]:
    """Sort shots by falling score; equal ones by the turn they need from ``heading``, then left to right."""

    def rank(shot: Shot) -> tuple[float, float, float]:
        turn = abs(wrap_angle(direction(origin, shot.target) - heading))
        # Rounded, so that scores that differ by a rounding error count as equal.
        return (-round(shot.score, 9), round(turn, 9), -shot.target[1])

    return sorted(shots, key=rank)
