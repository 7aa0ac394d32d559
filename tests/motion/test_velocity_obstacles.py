"""Velocities that meet nobody who moves."""

from __future__ import annotations

import random
from dataclasses import replace
from math import cos, hypot, inf, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.motion.path_planner import travel
from robobt.motion.scene import scene_of, trip_of
from robobt.motion.velocity_obstacles import MOVES, clear_velocity
from robobt.testing import frame, robot
from robobt.world import ROBOT_RADIUS, Frame, RobotLimits, RobotState
from robobt.world.avoiding import AHEAD, free_time
from robobt.world.geometry import Point
from robobt.world.records import LIMITS, SCENE, TRIP, limits_of, mover_records, movers_of
from robobt.world.rules import in_their_defense_area
from tests.skills.fixed_world import moved
from tests.skills.refereed import STOP

PERIOD = 1 / 60
FAR_BALL = (0.0, 2.9)
place, speed = st.floats(-2, 2), st.floats(-3, 3)
places = st.lists(st.tuples(place, place, speed, speed), max_size=8)


def clear(seen: Frame, me: RobotState, wanted: Point, goal: Point) -> Point:
    limits, trip = limits_of(me.limits).view(LIMITS)[0], trip_of(me, goal).view(TRIP)[0]
    scene, movers = scene_of(seen).view(SCENE)[0], mover_records(movers_of(seen))
    return clear_velocity(trip, scene, movers, limits, limits, wanted, goal)


def cleared(
    me: RobotState,
    others: list[tuple[float, float, float, float]],
    wanted: Point,
    goal: Point,
    mirror: int = 1,
) -> Point:
    """The velocity instead of the one wanted, among others by place and velocity; mirrored by -1."""
    opponents = tuple(
        RobotState(number, x, mirror * y, 0.0, vx, mirror * vy)
        for number, (x, y, vx, vy) in enumerate(others)
    )
    me = RobotState(me.id, me.x, mirror * me.y, 0.0, me.vx, mirror * me.vy)
    seen, goal = frame(me, (0.0, 0.0), opponents=opponents), (goal[0], mirror * goal[1])
    vx, vy = clear(seen, me, (wanted[0], mirror * wanted[1]), goal)
    return vx, mirror * vy


@given(others=places, vx=speed, vy=speed, wanted=st.tuples(speed, speed), goal=st.tuples(place, place))
def test_nobody_is_made_faster_and_left_and_right_are_the_same(
    others: list[tuple[float, float, float, float]], vx: float, vy: float, wanted: Point, goal: Point
) -> None:
    me = robot(velocity=(vx, vy, 0.0))
    found, mirrored = (cleared(me, others, wanted, goal, mirror) for mirror in (1, -1))
    assert hypot(*found) <= hypot(*wanted) + 1e-9
    # Of two that are equally good the first is taken.
    off, mirrored_off = (hypot(one[0] - wanted[0], one[1] - wanted[1]) for one in (found, mirrored))
    assert off == pytest.approx(mirrored_off, abs=1e-6)


@given(
    others=st.lists(st.tuples(place, place, st.floats(0, MOVES), st.just(0.0)), max_size=8),
    wanted=st.tuples(speed, speed),
    goal=st.tuples(place, place),
)
def test_among_robots_that_stand_nothing_changes(
    others: list[tuple[float, float, float, float]], wanted: Point, goal: Point
) -> None:
    assert cleared(robot(), others, wanted, goal) == wanted


@pytest.mark.parametrize(
    "other",
    [(1.5, 0.0, 2.0, 0.0), (-1.0, 0.0, -1.0, 0.0), (0.6, -3.0, 0.0, 0.5), (3.0, 0.0, -1.0, 0.0)],
    ids=["drives ahead as fast", "drives away", "passes behind it", "beyond the goal"],
)
def test_who_is_not_met_on_the_way_changes_nothing(other: tuple[float, float, float, float]) -> None:
    me = robot(velocity=(2.0, 0.0, 0.0))
    assert cleared(me, [other], (2.0, 0.0), (1.5, 0.0)) == (2.0, 0.0)


def test_a_ball_that_it_may_touch_is_nothing_to_evade() -> None:
    """While another moves nearby rounding once made it an obstacle straight ahead, in 1 of 80 directions."""
    for step in range(500):
        x, y = 0.3 * cos(0.0125 * step), 0.3 * sin(0.0125 * step)
        me = robot(velocity=(5 * x, 5 * y, 0.0))
        away = robot(-2 * x, -2 * y, velocity=(-3 * x, -3 * y, 0.0))
        seen, goal, wanted = frame(me, (x, y), opponents=(away,)), (1.2 * x, 1.2 * y), (6.0 * x, 6.0 * y)
        assert clear(seen, me, wanted, goal) == wanted


def test_one_that_crosses_is_evaded_the_more_the_sooner_it_is_met() -> None:
    me = robot(velocity=(1.5, 0.0, 0.0))
    changes = []
    for gap in (2.0, 0.9, 0.4):
        found = cleared(me, [(gap, -gap, 0.0, 1.5)], (1.5, 0.0), (3.0, 0.0))
        changes.append(hypot(found[0] - 1.5, found[1]))
    assert 0.0 == changes[0] < changes[1] < changes[2]


def test_a_robot_that_turns_slowly_has_to_evade_sooner() -> None:
    """Whether a velocity is free is seen from how long it takes to get it."""
    me, other = robot(velocity=(2.0, 0.0, 0.0)), robot(0.72, 0.72)
    moving = robot(-2.0, -1.5, number=1, velocity=(1.0, 0.0, 0.0))
    seen, goal, found = frame(me, FAR_BALL, opponents=(other, moving)), (0.5, 2.0), []
    for limits in (RobotLimits(), RobotLimits(acceleration=1.0, braking=1.0)):
        found.append(clear(seen, replace(me, limits=limits), (0.0, 2.0), goal))
    assert found[0] == (0.0, 2.0)
    assert found[1] != (0.0, 2.0)


def test_it_turns_to_no_area_where_it_may_not_be() -> None:
    x, y = 3.35, -0.9
    me, other = robot(x, y, velocity=(0.0, 1.5, 0.0)), robot(x - 0.3, 0.3, velocity=(0.15, -1.5, 0.0))
    frames = [frame(me, FAR_BALL, opponents=(other,))]
    for _ in range(120):
        order = travel(frames[-1], me, (x, 1.5), 0.0, me.limits)
        me = moved(me, order, PERIOD)
        other = robot(
            other.x + other.vx * PERIOD, other.y + other.vy * PERIOD, velocity=(other.vx, other.vy, 0.0)
        )
        frames.append(frame(me, FAR_BALL, opponents=(other,)))
    for seen in frames:
        me, other = seen.own[0], seen.opponents[0]
        assert hypot(me.x - other.x, me.y - other.y) > 2 * ROBOT_RADIUS
        assert not in_their_defense_area(seen.field, me.x, me.y, 0.9 * ROBOT_RADIUS)


def test_in_a_stop_it_evades_nobody_into_the_circle_round_the_ball() -> None:
    me, other = robot(-1.0, -0.65, velocity=(1.4, 0.0, 0.0)), robot(0.6, -0.75, velocity=(-1.4, 0.0, 0.0))
    for _ in range(90):
        seen = frame(me, (0.0, 0.0), opponents=(other,), game=STOP)
        me = moved(me, travel(seen, me, (1.5, -0.65), 0.0, me.limits), PERIOD)
        other = robot(other.x + other.vx * PERIOD, other.y, velocity=(other.vx, 0.0, 0.0))
        assert hypot(me.x, me.y) > 0.5 + ROBOT_RADIUS
        assert hypot(me.x - other.x, me.y - other.y) > 2 * ROBOT_RADIUS


def all_driven(starts: list[Point], goals: list[Point], most: float = 5.0) -> tuple[float, float]:
    """Robots of one team, each on its way: the least gap between two [m], and when the last was there [s]."""
    robots, time, gap = [robot(*start, number=i) for i, start in enumerate(starts)], 0.0, inf
    while time < most and any(
        hypot(r.x - x, r.y - y) > 0.02 for r, (x, y) in zip(robots, goals, strict=True)
    ):
        seen = Frame(
            time, frame(robots[0]).field, frame(robots[0], FAR_BALL).ball, tuple(robots), (), period=PERIOD
        )
        orders = [travel(seen, me, goals[me.id], 0.0, me.limits) for me in robots]
        robots = [moved(me, order, PERIOD) for me, order in zip(robots, orders, strict=True)]
        pairs = [(a, b) for a in robots for b in robots[: a.id]]
        gap = min(gap, *(hypot(a.x - b.x, a.y - b.y) - 2 * ROBOT_RADIUS for a, b in pairs), gap)
        time += PERIOD
    return gap, time


@pytest.mark.parametrize(("count", "most"), [(2, 2.3), (4, 2.3), (6, 2.6)])
def test_mates_change_places_across_a_circle_without_touching(count: int, most: float) -> None:
    angles = [2 * pi * k / count + 0.1 for k in range(count)]
    starts = [(2.0 * cos(angle), 2.0 * sin(angle)) for angle in angles]
    gap, time = all_driven(starts, [(-x, -y) for x, y in starts])
    assert gap > 0.0
    assert time < most


def test_six_mates_on_any_ways_seldom_touch() -> None:
    """Gone round where they would be after 0.4 s they touched in 26 of 60."""
    numbers_ = random.Random(5)
    touched = 0
    for _ in range(10):
        ends: list[list[Point]] = []
        while len(ends) < 2:
            drawn = [(numbers_.uniform(-3, 3), numbers_.uniform(-2.5, 2.5)) for _ in range(6)]
            if all(hypot(a[0] - b[0], a[1] - b[1]) > 0.4 for i, a in enumerate(drawn) for b in drawn[:i]):
                ends.append(drawn)
        gap, time = all_driven(ends[0], ends[1])
        touched += gap < 0.0
        assert time < 4.5
    assert touched <= 1


def test_a_velocity_too_small_to_square_is_none() -> None:
    assert free_time(0.4, 0.3, -1e-163, -1e-162, 0.2) == AHEAD
