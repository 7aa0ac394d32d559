"""The building blocks of observation vectors."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.state import Frame, RobotState

Row = tuple[float, ...]
"""The numbers of a :class:`~robobt.world.records.Robot` or a :class:`~robobt.world.records.Ball`."""


@dataclass(frozen=True, slots=True)
class Seen:
    """The input of an observation, in many arenas or in one frame.

    The robots' team attacks towards +x.

    Attributes:
        robots: (n, R) records :data:`~robobt.world.records.ROBOT`: the one that observes, its team-mates,
            the opponents.
        balls: (n,) records :data:`~robobt.world.records.BALL`.
        own: number of robots, the first ones, in the observer's team.
        field: the field.
    """

    robots: NDArray[np.void]
    balls: NDArray[np.void]
    own: int
    field: FieldGeometry

    @property
    def me(self) -> NDArray[np.void]:
        """The robots that observe, (n,)."""
        return self.robots[:, 0]

    @property
    def mates(self) -> NDArray[np.void]:
        """The others of their teams, (n, M)."""
        return self.robots[:, 1 : self.own]

    @property
    def opponents(self) -> NDArray[np.void]:
        """The other teams, (n, K)."""
        return self.robots[:, self.own :]

    def in_frame_of_me(self, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return vectors ``x``, ``y`` (n,) of the field as who observes sees them: ahead, and to its left."""
        c, s = np.cos(self.me["heading"]), np.sin(self.me["heading"])
        return c * x + s * y, c * y - s * x


def seen(robots: FloatArray, balls: FloatArray, own: int, field: FieldGeometry) -> Seen:
    """Return arrays (n, R, 6) and (n, 4) by the names of their numbers; the rest is as for :class:`Seen`."""
    bodies, rolling = np.ascontiguousarray(robots), np.ascontiguousarray(balls)
    found = Seen(bodies.view(ROBOT)[..., 0], rolling.view(BALL)[..., 0], own, field)
    # Observing must not change the state.
    found.robots.flags.writeable = found.balls.flags.writeable = False
    return found


SCALES = "max_speed", "max_turn"
"""Fields of an action's scaling that can be the scale of an entry."""


@dataclass(frozen=True, slots=True)
class ObservationEntry:
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

    def __post_init__(self) -> None:
        if isinstance(self.scale, str) and self.scale not in SCALES:
            known = " or ".join(SCALES)
            raise ValueError(
                f"the scale of the entry {self.name!r} must be a number, {known}, not {self.scale!r}"
            )


class Group(NamedTuple):
    """Places of an observation vector for things of one kind, such as opponents, in any order.

    Attributes:
        first: index of the first place's first entry.
        places: their number.
        empty: the entries of a place for which there is nothing.
    """

    first: int
    places: int
    empty: tuple[float, ...]


@dataclass(frozen=True)
class ObservationSpec:
    """Name, version and entries of an observation vector.

    ``vectors`` are the indices at which plane vectors in the robot's frame begin, that to the ball first;
    none where a policy cannot be asked in the ball's frame. ``groups`` are the places for things of one
    kind, in the order of the entries.
    """

    name: str
    version: int
    entries: tuple[ObservationEntry, ...]
    vectors: tuple[int, ...] = ()
    groups: tuple[Group, ...] = ()

    @property
    def size(self) -> int:
        """Length of the vector."""
        return len(self.entries)


@dataclass(frozen=True)
class Observation(ObservationSpec):
    """An observation with the function that makes it, for training as for a robot in a match.

    ``rows`` takes what is :class:`Seen` and returns the vectors, (n, size).
    """

    rows: Callable[[Seen], FloatArray] = lambda _: np.zeros((0, 0))

    def of(self, frame: Frame, robot: RobotState) -> FloatArray:
        """Compute the vector of one robot in a frame, (size,)."""
        team = [robot, *(mate for mate in frame.own if mate.id != robot.id)]
        robots = np.array([[kinematics(each) for each in (*team, *frame.opponents)]])
        row: FloatArray = self.rows(seen(robots, np.array([motion(frame)]), len(team), frame.field))[0]
        return row


OWN_OBSERVATIONS: dict[str, Observation] = {}
"""Those that :func:`own_observation` has registered, by their names."""


def own_observation(
    name: str, version: int, *vector: ObservationEntry
) -> Callable[[Callable[[Seen], FloatArray]], Observation]:
    """Return a decorator that registers a function as the maker of a user's observation.

    Args:
        name: name in model cards.
        version: to be changed with the meaning of any entry.
        vector: its entries.

    Raises:
        ValueError: another function makes an observation of that name.
    """

    def register(rows: Callable[[Seen], FloatArray]) -> Observation:
        before = OWN_OBSERVATIONS.get(name)
        # A file may be run again, as an imported module say.
        if before is not None and _place(before.rows) != _place(rows):
            raise ValueError(f"observation {name!r} is registered twice; give one of them another name")
        made = Observation(name, version, vector, rows=rows)
        OWN_OBSERVATIONS[name] = made
        return made

    return register


def _place(function: Callable[..., object]) -> tuple[object, str]:
    return getattr(function, "__globals__", {}).get("__file__"), function.__qualname__


def entries(
    names: str, unit: str = "1", most: float | str = inf, scale: float | str = 1.0, *, signed: bool = True
) -> tuple[ObservationEntry, ...]:
    """Return entries with these ``names``, separated by blanks; ``most`` is their range.

    The rest is as for :class:`ObservationEntry`.
    """
    return tuple([ObservationEntry(name, unit, most, scale, signed) for name in names.split()])


def record_of(vector: Iterable[ObservationEntry]) -> np.dtype[np.record]:
    """Return the record as which compiled code fills in a vector, or a part of one, by entries' names."""
    fields = np.dtype([(entry.name, np.float64) for entry in vector])
    return cast("np.dtype[np.record]", np.dtype((np.record, fields)))


class _Robot(NamedTuple):
    x: float
    y: float
    heading: float
    vx: float
    vy: float
    omega: float


class _Ball(NamedTuple):
    x: float
    y: float
    vx: float
    vy: float


def kinematics(r: RobotState) -> Row:
    """Return a robot as observations take it."""
    # Whole numbers would make numba compile a version of their own.
    return (float(r.x), float(r.y), float(r.heading), float(r.vx), float(r.vy), float(r.omega))


def motion(frame: Frame) -> Row:
    """Return the ball as observations take it."""
    ball = frame.ball
    return (float(ball.x), float(ball.y), float(ball.vx), float(ball.vy))


@compilable
def robot_named(numbers: Row) -> Robot:
    """Return :func:`kinematics` by name; numba finds the type of a plain tuple faster when Python calls."""
    named: Any = _Robot(*numbers)
    robot: Robot = named
    return robot


@compilable
def ball_named(numbers: Row) -> Ball:
    """Return :func:`motion` by name."""
    named: Any = _Ball(*numbers)
    ball: Ball = named
    return ball


@compilable
def turned(c: float, s: float, x: float, y: float) -> Point:
    """Return a vector as seen along a direction with this cosine and sine: ahead, and to the left."""
    return c * x + s * y, c * y - s * x
