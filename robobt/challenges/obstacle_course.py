"""Courses of the obstacle challenge: the two published examples, and unseen ones drawn from a seed.

Source: RoboCup 2025 Obstacle Avoidance Challenge, appendix A; positions were read off its pictures, to about
1 cm. The challenge is played at the field's negative end by rule; here all of it is turned by 180 degrees, so
that blue attacks towards +x as everywhere in robobt.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, inf, pi, sin

import numpy as np

from robobt.motion.clear_way import CAPSULE_COLUMNS, CELL, Ground, clearance, time_map
from robobt.plays.challenges.obstacle_run import OBSTACLE_TARGET, VIRTUAL_LINE
from robobt.world.field import DIVISION_B
from robobt.world.geometry import FloatArray, Point, distance, segment_distance
from robobt.world.rules import AREA_DISTANCE, STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS

_HELD = 0.11
"""Distance of the placed ball from the centre of the robot that carries it [m]."""

_ROOM = 0.08
"""How much wider than the rules ask an unseen course leaves a way open [m]."""


@dataclass(slots=True, frozen=True)
class Obstacle:
    """A yellow robot in the way, in world coordinates.

    Attributes:
        number: its number.
        at: where it starts [m].
        to: where it drives to and fro; None if it stands.
        speed: its top speed [m/s].
    """

    number: int
    at: Point
    to: Point | None = None
    speed: float = 0.0


@dataclass(slots=True, frozen=True)
class ObstacleCourse:
    """A scenario of the obstacle challenge, in world coordinates.

    Attributes:
        name: its name.
        start: where blue's robot starts [m].
        obstacles: the yellow robots.
        carrier: number of the robot that holds the placed ball, its mouth towards -x.
        spot: where the ball is to be placed [m]; None where it lies.
    """

    name: str
    start: Point
    obstacles: tuple[Obstacle, ...]
    carrier: int
    spot: Point | None = None

    @property
    def ball(self) -> Point:
        """Where the ball starts [m]."""
        x, y = next(one.at for one in self.obstacles if one.number == self.carrier)
        return x - _HELD, y


KNOWN = (
    ObstacleCourse(
        "example_1",
        (0.57, 2.44),
        (
            Obstacle(0, (4.33, 0.0)),
            Obstacle(4, (3.09, 2.01)),
            Obstacle(5, (2.96, 1.74)),
            Obstacle(6, (2.85, 1.50)),
        ),
        0,
    ),
    ObstacleCourse(
        "example_2",
        (4.18, -2.69),
        (
            Obstacle(1, (3.92, -1.48), (1.80, -1.48), 1.0),
            Obstacle(2, (3.17, 1.73), (1.77, 1.73), 0.5),
            Obstacle(3, (3.17, 1.33)),
            Obstacle(4, (3.08, -0.01)),
            Obstacle(5, (2.70, -0.02)),
        ),
        1,
        (0.50, 0.0),
    ),
)
"""The published examples. The second is harder than those of the competition, its rules say."""


def unseen(generator: np.random.Generator, placing: bool = True) -> ObstacleCourse:
    """Return a course drawn from ``generator``, of the elements that the rules name.

    Without ``placing`` no course has a ball that is being placed.

    Two to five robots stand near the straight way, up to two drive to and fro with 0.3 to 1 m/s, in half of
    the courses a ball is being placed, and in two of five there is a virtual line. A course is drawn again
    until a way stays open with the moving robots at either end, and the start and the target are free.
    """
    while True:
        course = _drawn(generator, placing)
        if _is_fair(course):
            return course


def _drawn(generator: np.random.Generator, placing: bool) -> ObstacleCourse:
    target = OBSTACLE_TARGET
    uniform = generator.uniform
    while True:
        start = float(uniform(0.2, 4.3)), float(uniform(-2.8, 2.8))
        if distance(start, target) > 2.5:
            break

    def near_way() -> Point:
        share = uniform(0.15, 0.85)
        x, y = (a + share * (b - a) for a, b in zip(start, target, strict=True))
        aside = uniform(0.0, 0.7)
        angle = uniform(-pi, pi)
        return float(x + aside * cos(angle)), float(y + aside * sin(angle))

    def other_end(at: Point, longest: float) -> Point:
        way, angle = uniform(0.6, longest), uniform(-pi, pi)
        return float(at[0] + way * cos(angle)), float(at[1] + way * sin(angle))

    numbers = iter((4, 5, 6, 7, 8, 9, 10))
    obstacles = [Obstacle(next(numbers), near_way()) for _ in range(generator.integers(2, 6))]
    for _ in range(generator.integers(0, 3)):
        at = near_way()
        obstacles.append(Obstacle(next(numbers), at, other_end(at, 2.0), float(uniform(0.3, 1.0))))
    if uniform() < 0.4:
        a = near_way()
        b = other_end(a, 1.0)
        moves = other_end(a, 1.2) if uniform() < 0.5 else None
        obstacles += [Obstacle(2, a, moves, 0.5), Obstacle(3, b)]
    if placing and uniform() < 0.5:
        at = near_way()
        moves = other_end(at, 2.0) if uniform() < 0.5 else None
        spot = float(uniform(0.3, 4.0)), float(uniform(-2.5, 2.5))
        obstacles.append(Obstacle(1, at, moves, float(uniform(0.3, 1.0))))
        return ObstacleCourse("unseen", start, tuple(obstacles), 1, spot)
    obstacles.append(Obstacle(0, (4.33, 0.0)))
    return ObstacleCourse("unseen", start, tuple(obstacles), 0)


def _is_fair(course: ObstacleCourse) -> bool:
    robots = [one.at for one in course.obstacles] + [course.start]
    ends = [one.to for one in course.obstacles if one.to is not None]
    field = DIVISION_B
    if not all(field.contains(x, y, -0.1) for x, y in (*robots, *ends)):
        return False
    if any(distance(a, b) < 0.25 for i, a in enumerate(robots) for b in (*robots[:i], course.ball) if a != b):
        apart = [distance(a, b) for i, a in enumerate(robots) for b in robots[:i]]
        if min(apart) < 0.25 or distance(course.start, course.ball) < 0.25:
            return False
    for one in course.obstacles:
        path = (one.at, one.to or one.at)
        if segment_distance(OBSTACLE_TARGET, *path) < 0.6 or segment_distance(course.start, *path) < 0.6:
            return False
        # Patrols do not meet what stands.
        if one.to is not None and any(
            segment_distance(other.at, *path) < 0.3 for other in course.obstacles if other is not one
        ):
            return False
    return all(_is_open(course, at_end) for at_end in (False, True))


def _is_open(course: ObstacleCourse, at_end: bool) -> bool:
    """Return whether start, target and a way are free with the patrols at one of their ends."""
    places = {one.number: (one.to if at_end and one.to is not None else one.at) for one in course.obstacles}
    rows = [_capsule(place, place, 2.0 * ROBOT_RADIUS) for place in places.values()]
    if course.spot is not None:
        x, y = places[course.carrier]
        rows.append(_capsule((x - _HELD, y), course.spot, STOP_DISTANCE + ROBOT_RADIUS))
    if all(number in places for number in VIRTUAL_LINE):
        a, b = (places[number] for number in VIRTUAL_LINE)
        rows.append(_capsule(a, b, ROBOT_RADIUS))
    obstacles = np.array(rows)
    field = DIVISION_B
    ground = Ground(
        field.half_length + 0.1,
        field.half_width + 0.1,
        field.half_length - field.defense_depth,
        field.defense_width / 2.0,
        AREA_DISTANCE + ROBOT_RADIUS + 0.02,
    )
    for place in (course.start, OBSTACLE_TARGET):
        if clearance(*place, 0.0, obstacles, ground) < 0.0:
            return False
    # A blocked cell costs forty times its width, so the shortest way tells whether there is a free one.
    way = time_map(course.start, OBSTACLE_TARGET, inf, obstacles, ground)
    return _way_at(course.start, way, ground) < 3.0 * hypot(*np.subtract(course.start, OBSTACLE_TARGET)) + 1.0


def _capsule(a: Point, b: Point, radius: float) -> list[float]:
    row = [*a, 0.0, 0.0, *b, 0.0, 0.0, radius + _ROOM]
    assert len(row) == CAPSULE_COLUMNS
    return row


def _way_at(place: Point, way: FloatArray, ground: Ground) -> float:
    i, j = (round((at + half) / CELL) for at, half in zip(place, ground[:2], strict=True))
    return float(way[i, j])
