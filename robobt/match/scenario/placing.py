"""Placing robots and ball within a scenario's starts, without contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, hypot, pi, sin

import numpy as np

from robobt.config.errors import FieldError, short_repr
from robobt.match.scenario.starts import Anywhere, Around, BallStart, Box, Disc, RobotStart
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point, wrap_angle
from robobt.world.protocol import Placement
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, RobotId

HELD_DISTANCE = 0.098
"""Distance from a robot's centre to a ball in its mouth at the start [m]."""

_PLACING_TRIES = 1000


def check_starts(field: FieldGeometry, robots: Mapping[RobotId, RobotStart], ball: BallStart) -> None:
    """Check for errors that no random draw can avoid: places off the field, fixed starts that overlap.

    Raises:
        FieldError: with the scenario's field ("robots.blue.0.start").
    """
    taken: list[tuple[str, float, float, float]] = []
    holder = _robot_called(ball.held_by)
    if ball.position is not None:
        check_inside(ball.position, field, "ball.position")
        if isinstance(ball.position, tuple):
            taken.append(("the ball", *ball.position, BALL_RADIUS))
    elif holder not in robots:
        there = ", ".join(map(str, robots))
        raise FieldError("ball.held_by", f"no robot is called {short_repr(ball.held_by)}; there are {there}")
    for robot, start in robots.items():
        where = _field_of(robot, robots)
        position = start.position
        check_inside(position, field, f"{where}.position")
        if robot == holder and isinstance(position, Around) and position.around == "ball":
            raise FieldError(f"{where}.position", "it holds the ball, so it cannot start around the ball")
        if robot == holder and start.heading == "towards ball":
            raise FieldError(f"{where}.heading", "it holds the ball, so it cannot turn towards the ball")
        if isinstance(position, tuple):
            x, y = _turned(robot, position)
            for other, other_x, other_y, radius in taken:
                if hypot(x - other_x, y - other_y) < ROBOT_RADIUS + radius:
                    hint = " (to start with it in the mouth, use held_by)" if other == "the ball" else ""
                    raise FieldError(where, f"{robot} would overlap {other}{hint}")
            taken.append((str(robot), x, y, ROBOT_RADIUS))


class Placer:
    """Samples one placement: fixed objects first, then the ball, then the other robots.

    Robots' starts are in their own team's view; ``clearance`` is the least gap between hulls, and to the
    ball, for random places [m]; ``rng`` is the only source of randomness.
    """

    def __init__(
        self,
        field: FieldGeometry,
        robots: Mapping[RobotId, RobotStart],
        ball: BallStart,
        clearance: float,
        rng: np.random.Generator,
    ) -> None:
        self._field, self._starts, self._ball_start = field, robots, ball
        self._clearance, self._rng = clearance, rng
        self._holder = _robot_called(ball.held_by)
        self._taken: list[tuple[float, float, float]] = []
        self._poses: dict[RobotId, tuple[float, float, float]] = {}
        self._ball: Point | None = None

    def place(self) -> Placement:
        """Sample the places of robots and ball, in world coordinates."""
        holder = self._holder
        if isinstance(self._ball_start.position, tuple):
            self._put_ball(self._ball_start.position)
        for robot, start in self._starts.items():
            if isinstance(start.position, tuple):
                self._put_robot(robot, _turned(robot, start.position))
        if holder is not None:
            if holder not in self._poses:
                self._sample_robot(holder)
            self._face(holder)
            x, y, heading = self._poses[holder]
            self._put_ball((x + HELD_DISTANCE * cos(heading), y + HELD_DISTANCE * sin(heading)))
        elif self._ball is None:
            self._sample_ball()
        for robot in self._starts:
            if robot not in self._poses:
                self._sample_robot(robot)
            if robot != holder:
                self._face(robot)
        assert self._ball is not None
        poses = {robot: self._poses[robot] for robot in self._starts}
        return Placement(poses, (*self._ball, *self._ball_start.velocity))

    def _sample_robot(self, robot: RobotId) -> None:
        position = self._starts[robot].position
        # The ball in its mouth needs space too, for every heading.
        radius = ROBOT_RADIUS + (2 * BALL_RADIUS if robot == self._holder else 0.0)
        for _ in range(_PLACING_TRIES):
            place = _turned(robot, self._sample(position, robot))
            if self._free(place, radius):
                self._put_robot(robot, place)
                return
        raise FieldError(_field_of(robot, self._starts), _full(position))

    def _sample_ball(self) -> None:
        position = self._ball_start.position
        assert isinstance(position, Anywhere | Box | Disc)
        for _ in range(_PLACING_TRIES):
            if isinstance(position, Anywhere):
                place = position.sample(self._rng, self._field)
                free = self._clear(place, BALL_RADIUS)
            else:
                place = position.sample(self._rng)
                free = self._free(place, BALL_RADIUS)
            if free:
                self._put_ball(place)
                return
        raise FieldError("ball.position", _full(position))

    def _sample(self, position: object, robot: RobotId) -> Point:
        if isinstance(position, Around):
            if position.around == "ball":
                assert self._ball is not None
                return position.sample(self._rng, _turned(robot, self._ball))
            own = position.around == "own goal"
            return position.sample(self._rng, self._field.our_goal if own else self._field.their_goal)
        assert isinstance(position, Box | Disc)
        return position.sample(self._rng)

    def _free(self, place: Point, radius: float) -> bool:
        return self._field.contains(*place) and self._clear(place, radius)

    def _clear(self, place: Point, radius: float) -> bool:
        gap = radius + self._clearance
        return all(hypot(place[0] - x, place[1] - y) >= gap + other for x, y, other in self._taken)

    def _put_ball(self, place: Point) -> None:
        self._ball = place
        self._taken.append((*place, BALL_RADIUS))

    def _put_robot(self, robot: RobotId, place: Point) -> None:
        self._poses[robot] = (*place, 0.0)
        self._taken.append((*place, ROBOT_RADIUS))

    def _face(self, robot: RobotId) -> None:
        x, y, _ = self._poses[robot]
        ball = None if self._ball is None else _turned(robot, self._ball)
        heading = self._starts[robot].sample_heading(self._rng, _turned(robot, (x, y)), ball, self._field)
        self._poses[robot] = (x, y, wrap_angle(heading + (pi if robot.team is Team.YELLOW else 0.0)))


def _full(position: object) -> str:
    return f"no free place {position} found in {_PLACING_TRIES} tries"


def check_inside(position: object, field: FieldGeometry, where: str) -> None:
    """Check that places are on the field: a point, a whole box, or the centre of a disc.

    Raises:
        FieldError: a place is not; ``where`` is its field.
    """
    points: Sequence[Point] = ()
    if isinstance(position, Box):
        points = [(x, y) for x in position.x for y in position.y]
    elif isinstance(position, Disc):
        points = [position.center]
    elif isinstance(position, tuple):
        points = [position]
    for x, y in points:
        if not field.contains(x, y):
            size = f"{field.length:g} m x {field.width:g} m"
            raise FieldError(where, f"({x:g}, {y:g}) lies outside the field, which is {size} around (0, 0)")


def _turned(robot: RobotId, place: Point) -> Point:
    """Convert between the robot's view and the world's; half a turn is its own inverse."""
    return place if robot.team is Team.BLUE else (-place[0], -place[1])


def _field_of(robot: RobotId, robots: Mapping[RobotId, RobotStart]) -> str:
    team = [other for other in robots if other.team is robot.team]
    return f"robots.{robot.team.value}.{team.index(robot)}.start"


def _robot_called(name: str | None) -> RobotId | None:
    team, _, number = (name or "").partition(" ")
    return RobotId(Team(team), int(number)) if team in set(Team) and number in _ROBOT_NUMBERS else None


_ROBOT_NUMBERS = frozenset(str(number) for number in range(16))
