"""The way round robots, ball and defence areas."""

from __future__ import annotations

import random
from math import hypot, pi

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba.core.dispatcher import Dispatcher

from robobt.motion import arrival, give_way, path_planner, pilot, scene, velocity_obstacles
from robobt.motion.path_planner import allowed_target, next_waypoint, travel
from robobt.testing import frame, robot
from robobt.world import (
    DIVISION_A,
    DIVISION_B,
    FIELDS,
    ROBOT_RADIUS,
    Frame,
    GameState,
    RefereeCommand,
    Restart,
    RobotState,
    Team,
)
from robobt.world.geometry import Point, segment_distance
from robobt.world.rules import in_own_defense_area, in_their_defense_area
from tests.skills.fixed_world import moved

STOPPED = GameState(command=RefereeCommand.STOP)
THEIR_FREE_KICK = GameState(
    command=RefereeCommand.DIRECT_FREE_YELLOW, restart=Restart.FREE_KICK, restart_team=Team.YELLOW
)
THEIR_KICKOFF = GameState(
    command=RefereeCommand.PREPARE_KICKOFF_YELLOW, restart=Restart.KICKOFF, restart_team=Team.YELLOW
)
FAR_BALL = (0.0, 2.9)


def leg(me: RobotState, target: Point, *others: RobotState, **options: bool) -> tuple[Point, float]:
    return next_waypoint(frame(me, FAR_BALL, opponents=others), me, target, **options)


def driven(
    me: RobotState,
    target: Point,
    others: list[RobotState],
    ball: Point = FAR_BALL,
    most: float = 8.0,
    **options: bool,
) -> list[Frame]:
    """Frames of the drive, the others moving on at constant velocity."""
    period = 1 / 60
    frames = [frame(me, ball, opponents=tuple(others))]
    while frames[-1].time < most:
        last = frames[-1]
        me = moved(me, travel(last, me, target, 0.0, me.limits, **options), period)
        others = [RobotState(o.id, o.x + o.vx * period, o.y + o.vy * period, 0.0, o.vx, o.vy) for o in others]
        frames.append(frame(me, ball, opponents=tuple(others), time=last.time + period))
        if hypot(me.x - target[0], me.y - target[1]) < 0.01 and me.speed < 0.1:
            break
    return frames


def test_a_free_way_is_straight() -> None:
    assert leg(robot(-2.0, 0.0), (2.0, 0.0), robot(0.0, 0.5), robot(2.5, 0.0)) == ((2.0, 0.0), 0.0)


def test_a_blocked_way_leaves_on_the_shorter_side() -> None:
    left, _ = leg(robot(-2.0, 0.0), (2.0, 0.0), robot(0.0, -0.05))
    right, _ = leg(robot(-2.0, 0.0), (2.0, 0.0), robot(0.0, 0.05))
    assert left[1] > 0.1
    assert right[1] < -0.1
    assert segment_distance((0.0, -0.05), (-2.0, 0.0), left) > 2 * ROBOT_RADIUS


def test_the_first_robot_along_the_way_is_passed_first() -> None:
    point, _ = leg(robot(-2.0, 0.0), (2.0, 0.0), robot(1.0, 0.1), robot(-1.0, 0.1))
    assert -1.5 < point[0] < -0.5
    assert point[1] < 0.0


def test_a_way_point_is_passed_at_speed_and_faster_the_less_it_turns() -> None:
    _, gentle = leg(robot(-2.0, 0.0), (2.0, 0.0), robot(0.0, 0.2))
    _, sharp = leg(robot(-0.25, 0.0), (0.25, 0.0), robot(0.0, 0.0))
    assert gentle > sharp > 0.3


def test_it_keeps_to_the_side_it_already_drives_to() -> None:
    obstacle = robot(0.0, 0.02)
    still, _ = leg(robot(-1.0, 0.0), (1.0, 0.0), obstacle)
    moving, _ = leg(robot(-1.0, 0.0, velocity=(1.0, 0.8, 0.0)), (1.0, 0.0), obstacle)
    assert still[1] < 0.0 < moving[1]


def test_an_obstacle_is_avoided_where_it_will_be() -> None:
    leaving, _ = leg(robot(-1.0, 0.0), (1.0, 0.0), robot(0.0, 0.1, velocity=(0.0, 1.0, 0.0)))
    coming, _ = leg(robot(-1.0, 0.0), (1.0, 0.0), robot(0.0, -0.4, velocity=(0.0, 1.0, 0.0)))
    assert leaving == (1.0, 0.0)
    assert coming[1] != 0.0


def test_a_robot_in_touch_with_another_may_leave_it_but_not_push_it() -> None:
    touching = robot(0.185, 0.0)
    assert leg(robot(), (-1.0, 0.0), touching) == ((-1.0, 0.0), 0.0)
    point, _ = leg(robot(), (1.0, 0.0), touching)
    assert abs(point[1]) > abs(point[0])


def test_a_target_next_to_a_robot_can_be_reached() -> None:
    frames = driven(robot(-1.0, 0.0), (-0.19, 0.0), [robot(0.0, 0.0)], most=4.0)
    assert hypot(frames[-1].own[0].x + 0.19, frames[-1].own[0].y) < 0.01


def test_own_robots_are_obstacles_too_and_robots_can_be_ignored() -> None:
    me, mate = robot(-1.0, 0.0), robot(0.0, 0.0, number=1)
    world = frame(me, FAR_BALL, mates=(mate,))
    assert next_waypoint(world, me, (1.0, 0.0))[0] != (1.0, 0.0)
    assert next_waypoint(world, me, (1.0, 0.0), avoid_robots=False) == ((1.0, 0.0), 0.0)


def test_the_ball_is_an_obstacle_when_asked() -> None:
    me = robot(-1.0, 0.0)
    world = frame(me, ball=(0.0, 0.0))
    assert next_waypoint(world, me, (1.0, 0.0)) == ((1.0, 0.0), 0.0)
    point, _ = next_waypoint(world, me, (1.0, 0.0), avoid_ball=True)
    assert segment_distance((0.0, 0.0), me.position, point) > ROBOT_RADIUS + 0.0215


@pytest.mark.parametrize("x", [4.0, -4.0])
def test_defence_areas_are_passed_round_their_corners(x: float) -> None:
    frames = driven(robot(x, 2.0), (x, -2.0), [])
    assert hypot(frames[-1].own[0].x - x, frames[-1].own[0].y + 2.0) < 0.01
    for world in frames:
        me, field = world.own[0], world.field
        assert not in_their_defense_area(field, me.x, me.y, 0.99 * ROBOT_RADIUS)
        assert not in_own_defense_area(field, me.x, me.y, 0.99 * ROBOT_RADIUS)


def test_the_goalkeeper_drives_through_its_area() -> None:
    me = robot(-4.0, 2.0)
    world = frame(me, FAR_BALL)
    assert next_waypoint(world, me, (-4.0, -2.0), goalkeeper=True) == ((-4.0, -2.0), 0.0)
    assert allowed_target(world, me, (-4.4, 0.0), goalkeeper=True) == (-4.4, 0.0)


@pytest.mark.parametrize("field", FIELDS.values(), ids=FIELDS.keys())
@given(x=st.floats(-10, 10), y=st.floats(-8, 8), goalkeeper=st.booleans())
def test_a_target_is_moved_to_where_a_robot_may_stand(field, x: float, y: float, goalkeeper: bool) -> None:
    me = robot()
    world = frame(me, FAR_BALL, field=field)
    tx, ty = allowed_target(world, me, (x, y), goalkeeper=goalkeeper)
    assert abs(tx) <= field.outer[0] - ROBOT_RADIUS
    assert abs(ty) <= field.outer[1] - ROBOT_RADIUS
    assert not in_their_defense_area(field, tx, ty, ROBOT_RADIUS)
    assert goalkeeper or not in_own_defense_area(field, tx, ty, ROBOT_RADIUS)
    if field.contains(x, y, -0.3) and abs(x) < field.half_length - field.defense_depth - 0.2:
        assert (tx, ty) == (x, y)


@pytest.mark.parametrize("game", [STOPPED, THEIR_FREE_KICK])
@given(x=st.floats(-2, 2), y=st.floats(-2, 2))
def test_it_stays_away_from_the_ball_while_the_referee_wants_it(game: GameState, x: float, y: float) -> None:
    me = robot(-1.0, -1.0)
    world = frame(me, ball=(0.1, 0.2), game=game)
    tx, ty = allowed_target(world, me, (x, y))
    assert hypot(tx - 0.1, ty - 0.2) >= 0.5 + ROBOT_RADIUS
    own_free_kick = GameState(restart=Restart.FREE_KICK, restart_team=Team.BLUE)
    assert allowed_target(frame(me, ball=(0.1, 0.2), game=own_free_kick), me, (x, y)) == (x, y)


def test_during_a_stop_it_is_slow_and_goes_round_the_ball() -> None:
    me = robot(-2.0, 0.0, velocity=(1.5, 0.0, 0.0))
    world = frame(me, ball=(0.0, 0.0), game=STOPPED)
    order = travel(world, me, (2.0, 0.0), 0.0, me.limits)
    assert hypot(order.vx, order.vy) <= 1.5 + 1e-9
    point, _ = next_waypoint(world, me, (2.0, 0.0))
    assert segment_distance((0.0, 0.0), me.position, point) > 0.5 + ROBOT_RADIUS


@pytest.mark.parametrize(
    ("start", "target", "theirs"),
    [
        ((0.06, -1.18), (0.6, 2.05), [(0.3, -0.87), (-0.39, -1.53), (0.04, 1.73), (-0.84, -0.28)]),
        ((-0.13, -1.43), (-0.88, 1.86), [(-0.98, -0.99), (-0.36, -1.1), (-0.3, 1.47), (-1.65, -0.42)]),
        ((-0.75, -1.96), (0.32, -0.9), [(0.08, -1.14), (-0.23, -0.78), (-0.35, -1.86)]),
    ],
)
def test_it_gets_out_from_between_a_robot_and_the_circle_round_the_ball(
    start: Point, target: Point, theirs: list[Point]
) -> None:
    """It wavered for ever: whichever it met first decided on which side to pass the other."""
    others = tuple(robot(*place, number=number) for number, place in enumerate(theirs))
    me, time = robot(*start), 0.0
    while time < 6.0 and hypot(me.x - target[0], me.y - target[1]) > 0.02:
        seen = frame(me, (0.0, 0.0), opponents=others, time=time, game=THEIR_KICKOFF)
        me = moved(me, travel(seen, me, target, 0.0, me.limits), 1 / 60)
        time += 1 / 60
    assert time < 5.0


def test_near_their_area_it_keeps_more_distance_in_a_restart() -> None:
    me = robot()
    x, _ = allowed_target(frame(me, FAR_BALL), me, (3.4, 0.0))
    further, _ = allowed_target(frame(me, FAR_BALL, game=STOPPED), me, (3.4, 0.0))
    assert further == pytest.approx(DIVISION_B.half_length - DIVISION_B.defense_depth - 0.2 - ROBOT_RADIUS)
    assert further < x


def test_it_finds_through_standing_robots_without_touching_one() -> None:
    rng = random.Random(3)
    for _ in range(12):
        others = [robot(rng.uniform(-3, 3), rng.uniform(-2, 2), number=i) for i in range(10)]
        free = [
            (x, y)
            for x, y in ((rng.uniform(-3.2, 3.2), rng.uniform(-2.5, 2.5)) for _ in range(60))
            if all(hypot(o.x - x, o.y - y) > 0.3 for o in others)
        ]
        start, end = free[0], max(free, key=lambda p: hypot(p[0] - free[0][0], p[1] - free[0][1]))
        frames = driven(robot(*start), end, others)
        assert frames[-1].time < 6.0
        for world in frames:
            me = world.own[0]
            assert all(hypot(o.x - me.x, o.y - me.y) > 2 * ROBOT_RADIUS for o in others)


def test_it_lets_a_crossing_robot_pass() -> None:
    crossing = robot(0.0, -1.2, velocity=(0.0, 1.0, 0.0))
    frames = driven(robot(-1.5, 0.0), (1.5, 0.0), [crossing])
    assert frames[-1].time < 4.0
    for world in frames:
        me, other = world.own[0], world.opponents[0]
        assert hypot(other.x - me.x, other.y - me.y) > 2 * ROBOT_RADIUS


@settings(max_examples=60)
@given(
    x=st.floats(-6, 6),
    y=st.floats(-4.5, 4.5),
    tx=st.floats(-6, 6),
    ty=st.floats(-4.5, 4.5),
    others=st.lists(st.tuples(st.floats(-6, 6), st.floats(-4.5, 4.5)), max_size=11),
    heading=st.floats(-pi, pi),
)
def test_any_world_gives_a_finite_command_within_the_speed(
    x: float, y: float, tx: float, ty: float, others: list[Point], heading: float
) -> None:
    me = robot(x, y, heading)
    opponents = tuple(robot(*place, number=i) for i, place in enumerate(others))
    world = frame(me, ball=(tx, ty), opponents=opponents, field=DIVISION_A)
    order = travel(world, me, (tx, ty), 0.0, me.limits, avoid_ball=True)
    assert order.finite()
    assert hypot(order.vx, order.vy) <= me.limits.max_speed + 1e-9


@pytest.mark.parametrize("target", [(4.0, 0.0), (-4.0, 0.5)], ids=["theirs", "own"])
def test_whoever_places_the_ball_may_enter_both_defence_areas(target: Point) -> None:
    me = robot(0.0, 2.0)
    seen = frame(me, FAR_BALL)
    assert allowed_target(seen, me, target) != target
    assert allowed_target(seen, me, target, placing=True) == target
    assert next_waypoint(seen, me, target, placing=True)[0] == target


MODULES = (arrival, give_way, path_planner, pilot, scene, velocity_obstacles)


def orders(seed: int) -> list[float]:
    """What robots among many others are sent, on their way and round each other."""
    numbers = random.Random(seed)
    found = []
    for _ in range(50):
        others = [
            RobotState(i, numbers.uniform(-2, 2), numbers.uniform(-2, 2), 0.0, numbers.gauss(0, 1), 0.5)
            for i in range(1, 12)
        ]
        me = robot(numbers.uniform(-3, 3), numbers.uniform(-3, 3), velocity=(numbers.gauss(0, 1), 0.3, 0.0))
        seen = frame(me, (0.3, 0.2), mates=tuple(others[:5]), opponents=tuple(others[5:]), game=STOPPED)
        target = (numbers.uniform(-3, 3), 0.0)
        order = travel(seen, me, target, 0.0, me.limits, avoid_ball=True, spare_mates=True)
        found += [order.vx, order.vy, order.omega]
    return found


def test_compiled_code_drives_as_python_does(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled = orders(1)
    for module in MODULES:
        for name, value in vars(module).items():
            if isinstance(value, Dispatcher):
                monkeypatch.setattr(module, name, value.py_func)
    assert orders(1) == pytest.approx(compiled, abs=1e-9)
