"""Robots, ball and scene as records: how compiled code reads plain float arrays, by names of fields.

A compiled function that Python calls takes plain arrays and views each as what it is, ``me_.view(ROBOT)[0]``:
numba needs many times as long to look at the type of a record when it is called. All further functions take
the records. A record does not keep its array alive: a function may view arrays that it was given, but none
that it has made itself, unless it uses that array after the record.

:class:`~robobt.world.state.RobotState` and :class:`~robobt.world.state.BallState` have the fields of
:class:`Robot` and :class:`Ball`, so that a function that Python and compiled code share takes either.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from struct import pack_into
from typing import Any, NamedTuple, Protocol

import numpy as np

from robobt.world.compiled import compilable, record_dtype
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.state import MIRRORED_FROM, BallState, Frame, RobotState


class Robot(Protocol):
    """Centre [m], heading [rad], velocity in field coordinates [m/s] and turning rate [rad/s]."""

    x: float
    y: float
    heading: float
    vx: float
    vy: float
    omega: float


class Ball(Protocol):
    """Place [m] and velocity [m/s] along the ground."""

    x: float
    y: float
    vx: float
    vy: float


class Place(Protocol):
    """A point of the field [m]."""

    x: float
    y: float


class Limits(Protocol):
    """What driving and kicking need of :class:`~robobt.world.limits.RobotLimits`, by the same names."""

    max_speed: float
    acceleration: float
    lateral_acceleration: float
    braking: float
    lateral_braking: float
    separate_axes: float
    max_turn: float
    turn_acceleration: float
    angular_braking: float
    trailing_time: float
    lag: float
    side_lag: float
    turn_lag: float
    gain: float
    side_gain: float
    turn_gain: float
    cross_ahead: float
    cross_aside: float
    touch_kept: float
    touch_returned: float
    carried: float


class Mover(Protocol):
    """A robot seen from outside: place [m], velocity [m/s], limits [m/s, m/s^2] and number on its team."""

    x: float
    y: float
    vx: float
    vy: float
    max_speed: float
    acceleration: float
    braking: float
    number: float


class Meeting(Protocol):
    """When [s] and where [m] a robot meets the ball."""

    time: float
    x: float
    y: float


class Scene(Protocol):
    """What a plan depends on but the robots; see :func:`robobt.motion.scene.scene_of`.

    Attributes:
        half_length, half_width, half_goal: half the field's sizes [m].
        area_depth, area_width: of a defence area [m].
        margin, behind: from side line and goal line to the walls [m].
        ball: the ball.
        period: time until the next command [s].
        keeps_off: whether robots have to stay away from the ball.
        their_gap: from their defence area to a robot's centre [m].
        insists: on which side robots go round for now, 1 or -1; 0 for the shorter one.
        in_play: whether the ball is in play.
        max_speed: the rules' speed limit [m/s].
        evades: whether ways evade robots that move; else they go round where those will be.
        mates: how many of the movers, the first, are of the own team.
    """

    half_length: float
    half_width: float
    half_goal: float
    area_depth: float
    area_width: float
    margin: float
    behind: float
    ball: Ball
    period: float
    keeps_off: float
    their_gap: float
    insists: float
    in_play: float
    max_speed: float
    evades: float
    mates: float


class Trip(Protocol):
    """A robot and where it is to go; see :func:`robobt.motion.scene.trip_of`.

    Attributes:
        me: the robot.
        x, y: the target [m].
        heading: where the mouth is to point [rad].
        final_speed: speed allowed at the target [m/s].
        ball_gap: how far to stay from the ball, hull to ball [m]; negative where it is no obstacle.
        avoids_robots: whether robots are obstacles.
        goalkeeper: may enter the own defence area.
        placing: may enter both defence areas.
        number: the robot's on its team.
    """

    me: Robot
    x: float
    y: float
    heading: float
    final_speed: float
    ball_gap: float
    avoids_robots: float
    goalkeeper: float
    placing: float
    number: float


ROBOT, BALL, LIMITS = record_dtype(Robot), record_dtype(Ball), record_dtype(Limits)
FIELD_PLACE = record_dtype(Place)
MOVER, MEETING = record_dtype(Mover), record_dtype(Meeting)
SCENE, TRIP = record_dtype(Scene), record_dtype(Trip)

ROBOT_SIZE, BALL_SIZE, MOVER_SIZE = (len(kind.names or ()) for kind in (ROBOT, BALL, MOVER))
"""How many numbers they are."""

_MOVER_PLACES = slice(0, 4)
"""Columns of a :class:`Mover` that change their signs where the other team looks."""

_MOST_KNOWN = 256


class _KnownLimits(NamedTuple):
    """A robot's limits, their numbers, and the three that a :class:`Mover` has."""

    limits: RobotLimits
    numbers: FloatArray
    moving: tuple[float, float, float]


_KNOWN_LIMITS: dict[int, _KnownLimits] = {}
"""By the limits' id, which stays theirs as they are kept too: hashing and comparing a model takes longer."""


def limits_of(limits: RobotLimits) -> FloatArray:
    """Return a robot's limits as the numbers of :class:`Limits`; made once."""
    return (_KNOWN_LIMITS.get(id(limits)) or _know(limits)).numbers


def _know(limits: RobotLimits) -> _KnownLimits:
    """Keep limits that are not known yet."""
    if len(_KNOWN_LIMITS) >= _MOST_KNOWN:
        _KNOWN_LIMITS.clear()
    numbers = np.array([getattr(limits, name) for name in LIMITS.names or ()], dtype=np.float64)
    moving = limits.max_speed, limits.acceleration, limits.braking
    known = _KNOWN_LIMITS[id(limits)] = _KnownLimits(limits, numbers, moving)
    return known


def robot_of(robot: RobotState) -> FloatArray:
    """Return a robot's state as the numbers of :class:`Robot`."""
    return np.array((robot.x, robot.y, robot.heading, robot.vx, robot.vy, robot.omega), dtype=np.float64)


def ball_of(ball: BallState) -> FloatArray:
    """Return the ball on the ground as the numbers of :class:`Ball`."""
    return np.array((ball.x, ball.y, ball.vx, ball.vy), dtype=np.float64)


def movers(robots: Iterable[RobotState]) -> FloatArray:
    """Return every robot as the numbers of :class:`Mover`, (n, ``MOVER_SIZE``)."""
    numbers: list[float] = []
    for robot in robots:
        limits = robot.limits
        known = _KNOWN_LIMITS.get(id(limits)) or _know(limits)
        numbers += (robot.x, robot.y, robot.vx, robot.vy, *known.moving, robot.id)
    # Numpy takes longer over a list of numbers, and twice as long over a list of rows.
    packed = bytearray(8 * len(numbers))
    pack_into(f"={len(numbers)}d", packed, 0, *numbers)
    return np.frombuffer(packed, dtype=np.float64).reshape(-1, MOVER_SIZE)


def movers_of(frame: Frame) -> FloatArray:
    """Return :func:`movers` of everybody on the field, the own team first; made once a frame."""
    made: FloatArray | None = frame.made.get("movers")
    if made is None:
        before: Frame | None = frame.made.get(MIRRORED_FROM)
        if before is None:
            made = movers((*frame.own, *frame.opponents))
        else:
            made = turned(movers_of(before), len(before.own), _MOVER_PLACES)
        frame.made["movers"] = made
    return made


def shared_view(frame: Frame, team: Team) -> Frame:
    """Return ``frame.seen_by(team)``, where what is found for all robots is found once for both teams.

    Neither frame may change from then on, unless what the view has ``made`` is cleared.
    """
    view = frame.seen_by(team)
    if view is not frame:
        view.made[MIRRORED_FROM] = frame
    return view


def turned(rows: FloatArray, own: int, places: slice) -> FloatArray:
    """Return rows of everybody as the other team sees them.

    Args:
        rows: one of each robot (n, m), the ``own`` team first.
        own: how many robots that team has.
        places: columns with coordinates and velocities.
    """
    other = np.concatenate((rows[own:], rows[:own]))
    changed = other[:, places]
    np.negative(changed, out=changed)
    return other


@compilable
def mover_records(movers_: FloatArray) -> Sequence[Mover]:
    """Return the rows of :func:`movers` as records."""
    rows: Any = movers_.view(MOVER)
    first: Sequence[Mover] = rows[:, 0]
    return first


@compilable
def robot_records(robots_: FloatArray) -> Sequence[Robot]:
    """Return the rows of states (n, ``ROBOT_SIZE``) as records."""
    rows: Any = robots_.view(ROBOT)
    first: Sequence[Robot] = rows[:, 0]
    return first
