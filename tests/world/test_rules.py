"""Lines, goals, defence areas and possession: what decides a match."""

from __future__ import annotations

from math import copysign, cos, hypot, pi, radians, sin

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from robobt.world import BALL_RADIUS, DIVISION_B, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState, Team
from robobt.world.compiled import compiled
from robobt.world.geometry import Point
from robobt.world.rules import (
    ALL_AROUND,
    HELD_GAP,
    KEPT_GAP,
    ball_out,
    carries,
    exit_point,
    goal_side,
    has_ball,
    hull_gap,
    in_area,
    in_defense_area,
    keeps_ball,
    leaving,
    own_side,
    owner,
    scorer,
    touches,
)
from robobt.world.state import GOAL_HEIGHT, RECEIVED_HEIGHT, ROBOT_HEIGHT

FIELD = DIVISION_B
EDGE_X, EDGE_Y = FIELD.half_length + BALL_RADIUS, FIELD.half_width + BALL_RADIUS
POST = FIELD.goal_width / 2
FIELD_SIZE = (FIELD.half_length, FIELD.half_width, POST)
REACH = ROBOT_RADIUS + BALL_RADIUS + HELD_GAP

inside = st.tuples(st.floats(-EDGE_X, EDGE_X), st.floats(-EDGE_Y, EDGE_Y))
anywhere = st.tuples(st.floats(-6.0, 6.0), st.floats(-4.0, 4.0))


def turned(point: Point) -> Point:
    return (-point[0], -point[1])


def approx(x: float, y: float) -> object:
    return pytest.approx((x, y), abs=1e-9)


# Lines.


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_ball_is_out_once_it_is_over_a_line_as_a_whole(side: float) -> None:
    assert not ball_out(FIELD, (side * (EDGE_X - 1e-6), 0.0))
    assert ball_out(FIELD, (side * (EDGE_X + 1e-6), 0.0))
    assert not ball_out(FIELD, (0.0, side * (EDGE_Y - 1e-6)))
    assert ball_out(FIELD, (0.0, side * (EDGE_Y + 1e-6)))


def test_the_exit_lies_where_the_way_crosses_the_line() -> None:
    assert exit_point(FIELD, (EDGE_X - 0.1, 1.0), (EDGE_X + 0.3, 1.4)) == (approx(EDGE_X, 1.1), True)
    assert exit_point(FIELD, (1.0, EDGE_Y - 0.1), (1.4, EDGE_Y + 0.3)) == (approx(1.1, EDGE_Y), False)


@pytest.mark.parametrize("x_side", [-1.0, 1.0])
@pytest.mark.parametrize("y_side", [-1.0, 1.0])
def test_of_two_lines_crossed_in_one_step_the_first_counts(x_side: float, y_side: float) -> None:
    def leave(before: Point, after: Point) -> tuple[Point, bool]:
        return exit_point(
            FIELD, (x_side * before[0], y_side * before[1]), (x_side * after[0], y_side * after[1])
        )

    goal_line_first = leave((EDGE_X - 0.1, EDGE_Y - 0.2), (EDGE_X + 0.3, EDGE_Y + 0.2))
    assert goal_line_first == (approx(x_side * EDGE_X, y_side * (EDGE_Y - 0.1)), True)
    touch_line_first = leave((EDGE_X - 0.2, EDGE_Y - 0.1), (EDGE_X + 0.2, EDGE_Y + 0.3))
    assert touch_line_first == (approx(x_side * (EDGE_X - 0.1), y_side * EDGE_Y), False)


def test_a_ball_that_was_out_already_left_where_it_is() -> None:
    assert exit_point(FIELD, (EDGE_X + 0.1, 0.0), (EDGE_X + 0.2, 0.1)) == ((EDGE_X + 0.2, 0.1), True)
    assert exit_point(FIELD, (0.0, EDGE_Y + 0.1), (0.1, EDGE_Y + 0.2)) == ((0.1, EDGE_Y + 0.2), False)


@given(inside, anywhere)
def test_an_exit_lies_on_the_way_and_on_a_line(before: Point, after: Point) -> None:
    assume(ball_out(FIELD, after))
    (x, y), goal_line = exit_point(FIELD, before, after)
    assert (abs(x) if goal_line else abs(y)) == pytest.approx(EDGE_X if goal_line else EDGE_Y, abs=1e-9)
    assert abs(x) <= EDGE_X + 1e-9
    assert abs(y) <= EDGE_Y + 1e-9
    way = hypot(after[0] - before[0], after[1] - before[1])
    parts = hypot(x - before[0], y - before[1]) + hypot(after[0] - x, after[1] - y)
    assert parts == pytest.approx(way, abs=1e-9)


@given(inside, anywhere)
def test_half_a_turn_of_the_way_turns_the_exit(before: Point, after: Point) -> None:
    assume(ball_out(FIELD, after))
    point, goal_line = exit_point(FIELD, before, after)
    assert exit_point(FIELD, turned(before), turned(after)) == (turned(point), goal_line)


@given(inside, anywhere, st.floats(1.0, 3.0))
def test_going_farther_along_the_same_way_moves_no_exit(before: Point, after: Point, factor: float) -> None:
    assume(ball_out(FIELD, after))
    farther = tuple(a + factor * (b - a) for a, b in zip(before, after, strict=True))
    point, _ = exit_point(FIELD, before, after)
    assert exit_point(FIELD, before, (farther[0], farther[1]))[0] == approx(*point)


# Goals.


def scoring(before: Point, after: Point, *heights: float) -> Team | None:
    low, high = heights or (0.0, 0.0)
    return scorer(FIELD, BallState(*before, z=low), BallState(*after, z=high))


def test_a_goal_is_scored_where_the_whole_ball_passes_between_the_posts() -> None:
    assert scoring((4.4, 0.2), (EDGE_X + 1e-6, 0.2)) is Team.BLUE
    assert scoring((4.4, 0.2), (EDGE_X - 1e-6, 0.2)) is None
    assert scoring((-4.4, 0.2), (-EDGE_X - 1e-6, 0.2)) is Team.YELLOW
    assert scoring((4.4, POST + 0.01), (EDGE_X + 0.1, POST + 0.01)) is None


def test_the_crossing_decides_not_where_the_ball_is_seen_next() -> None:
    before = (EDGE_X - 0.1, POST - 0.1)
    assert scoring(before, (EDGE_X + 0.1, POST + 0.05)) is Team.BLUE
    assert scoring(before, (EDGE_X + 0.1, POST + 0.15)) is None
    assert scoring((EDGE_X - 0.1, POST + 0.2), (EDGE_X + 0.1, POST - 0.1)) is None


def test_a_ball_that_was_out_scores_no_goal() -> None:
    assert scoring((EDGE_X + 0.01, 0.0), (EDGE_X + 0.1, 0.0)) is None
    assert scoring((EDGE_X - 0.1, EDGE_Y + 0.01), (EDGE_X + 0.1, 0.0)) is None


def test_a_ball_above_the_bar_scores_no_goal() -> None:
    low, high = GOAL_HEIGHT - 2 * BALL_RADIUS - 1e-6, GOAL_HEIGHT - 2 * BALL_RADIUS + 1e-6
    before, after = (EDGE_X - 0.1, 0.0), (EDGE_X + 0.1, 0.0)
    assert scoring(before, after, low, low) is Team.BLUE
    assert scoring(before, after, high, high) is None
    # What counts is the height half-way, where it crosses.
    assert scoring(before, after, low + 0.1, low - 0.1) is Team.BLUE
    assert scoring(before, after, high + 0.1, high - 0.1) is None


@given(inside, anywhere)
def test_half_a_turn_gives_the_goal_to_the_other_team(before: Point, after: Point) -> None:
    team = scoring(before, after)
    assert scoring(turned(before), turned(after)) is (None if team is None else team.other)


@given(inside, anywhere)
def test_a_goal_leaves_the_field_over_a_goal_line_between_the_posts(before: Point, after: Point) -> None:
    (_, y), goal_line = exit_point(FIELD, before, after)
    scored = ball_out(FIELD, after) and goal_line and abs(y) <= POST
    team = scoring(before, after)
    assert (team is not None) is scored
    if team is not None:
        assert copysign(1.0, after[0]) == -own_side(team)


@compiled
def _compiled_goal(x0: float, y0: float, x1: float, y1: float) -> tuple[int, tuple[float, float, bool]]:
    side = goal_side(x0, y0, x1, y1, FIELD_SIZE[0], FIELD_SIZE[1], FIELD_SIZE[2])
    return side, leaving(x0, y0, x1, y1, FIELD_SIZE[0], FIELD_SIZE[1])


@given(inside, anywhere)
def test_compiled_code_decides_the_same(before: Point, after: Point) -> None:
    side = goal_side(*before, *after, *FIELD_SIZE)
    assert _compiled_goal(*before, *after) == (side, leaving(*before, *after, *FIELD_SIZE[:2]))


# Defence areas.


def test_a_defence_area_is_its_own_teams_and_grows_by_the_tolerance() -> None:
    front, side = FIELD.half_length - FIELD.defense_depth, FIELD.defense_width / 2
    assert in_defense_area(FIELD, Team.YELLOW, front, side)
    assert in_defense_area(FIELD, Team.BLUE, -front, side)
    assert not in_defense_area(FIELD, Team.BLUE, front, 0.0)
    assert not in_defense_area(FIELD, Team.YELLOW, front - 0.01, 0.0)
    assert not in_defense_area(FIELD, Team.YELLOW, front, side + 0.01)
    assert in_defense_area(FIELD, Team.YELLOW, front - 0.01, -side - 0.01, 0.02)
    assert not in_defense_area(FIELD, Team.YELLOW, front, 0.0, -0.01)


@given(anywhere, st.floats(-0.2, 0.2))
def test_the_areas_are_one_by_half_a_turn(point: Point, tolerance: float) -> None:
    theirs = in_defense_area(FIELD, Team.YELLOW, *point, tolerance)
    assert in_defense_area(FIELD, Team.BLUE, *turned(point), tolerance) is theirs
    assert in_area(*point, FIELD.half_length, FIELD.defense_depth, FIELD.defense_width, tolerance) is theirs


# Touches and possession.


def robot(
    x: float = 0.0, y: float = 0.0, heading: float = 0.0, *, number: int = 0, contact: bool = False
) -> RobotState:
    return RobotState(number, x, y, heading, ball_contact=contact)


def ball_at(robot: RobotState, distance: float, bearing: float = 0.0) -> BallState:
    angle = robot.heading + bearing
    return BallState(robot.x + distance * cos(angle), robot.y + distance * sin(angle))


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5, pi])
def test_a_ball_in_the_mouth_is_had(heading: float) -> None:
    me = robot(1.0, -1.0, heading)
    assert has_ball(me, ball_at(me, 0.098))


def test_the_sensor_is_believed_wherever_the_ball_is_seen() -> None:
    assert has_ball(robot(contact=True), BallState(1.0, 1.0))


@pytest.mark.parametrize(
    ("degrees", "expected"), [(0, True), (44, True), (-44, True), (46, False), (180, False)]
)
def test_only_a_ball_ahead_counts(degrees: float, expected: bool) -> None:
    assert has_ball(robot(), ball_at(robot(), 0.11, radians(degrees))) is expected


@given(st.floats(-pi, pi), st.floats(-pi, pi))
def test_all_around_a_ball_at_the_hull_is_had_on_every_side(heading: float, bearing: float) -> None:
    me = robot(heading=heading)
    assert has_ball(me, ball_at(me, REACH - 1e-6, bearing), ALL_AROUND)
    assert not has_ball(me, ball_at(me, REACH + 1e-6, bearing), ALL_AROUND)


def test_a_ball_out_of_reach_is_not_had() -> None:
    assert has_ball(robot(), BallState(REACH - 0.001, 0.0))
    assert not has_ball(robot(), BallState(REACH + 0.001, 0.0))


@given(st.floats(-pi, pi), st.floats(-pi, pi), st.floats(0.05, 0.3))
def test_who_has_the_ball_keeps_it_too(heading: float, bearing: float, distance: float) -> None:
    me = robot(heading=heading)
    ball = ball_at(me, distance, bearing)
    assert keeps_ball(me, ball) or not has_ball(me, ball, ALL_AROUND)
    assert has_ball(me, ball, ALL_AROUND) or not has_ball(me, ball)


def test_a_ball_is_lost_at_60_mm() -> None:
    hull = ROBOT_RADIUS + BALL_RADIUS
    assert hull_gap(robot(), BallState(-hull - 0.01, 0.0)) == pytest.approx(0.01)
    assert keeps_ball(robot(), BallState(0.0, hull + KEPT_GAP - 1e-6))
    assert not keeps_ball(robot(), BallState(0.0, hull + KEPT_GAP + 1e-6))


def test_nobody_owns_a_free_ball() -> None:
    assert owner(Frame(0.0, FIELD, BallState(2.0, 0.0), (robot(),))) is None


def test_the_owner_is_named_with_its_team() -> None:
    me, opponent = robot(number=3), robot(1.0, 0.0, pi, number=4)
    assert owner(Frame(0.0, FIELD, ball_at(me, 0.098), (me,), (opponent,))) == RobotId(Team.BLUE, 3)
    assert owner(Frame(0.0, FIELD, ball_at(opponent, 0.098), (me,), (opponent,))) == RobotId(Team.YELLOW, 4)
    assert owner(Frame(0.0, FIELD, ball_at(me, 0.098), (me,), team=Team.YELLOW)) == RobotId(Team.YELLOW, 3)


def test_of_two_that_have_it_the_nearer_owns_it() -> None:
    near, far = robot(number=1), robot(0.22, 0.0, pi, number=2)
    assert owner(Frame(0.0, FIELD, BallState(0.1, 0.0), (near,), (far,))) == RobotId(Team.BLUE, 1)
    assert owner(Frame(0.0, FIELD, BallState(0.12, 0.0), (near,), (far,))) == RobotId(Team.YELLOW, 2)


def test_a_ball_is_carried_while_it_moves_along_and_no_longer_once_kicked() -> None:
    me = RobotState(0, 0.0, 0.0, vx=1.5)
    assert carries(me, BallState(0.098, 0.0, 1.5, 0.2))
    assert not carries(me, BallState(0.098, 0.0, 6.0, 0.0))
    assert not carries(me, BallState(0.598, 0.0, 1.5, 0.0))


@pytest.mark.parametrize("bearing", [0.0, 1.0, 2.0, 3.0])
def test_contact_ends_a_few_millimetres_off_the_hull(bearing: float) -> None:
    me = robot(heading=-bearing)
    hull = 0.075 if bearing == 0.0 else ROBOT_RADIUS
    assert touches(me, BallState(hull + BALL_RADIUS + 0.002, 0.0))
    assert not touches(me, BallState(hull + BALL_RADIUS + 0.01, 0.0))


def test_a_ball_before_the_flat_front_is_measured_from_the_flat() -> None:
    ball = BallState(0.108, 0.0)
    assert hypot(ball.x, ball.y) < ROBOT_RADIUS + BALL_RADIUS
    assert not touches(robot(), ball)


@pytest.mark.parametrize("heading", [0.0, 1.5708, -1.5708, 3.1416])
def test_the_flat_front_turns_with_the_robot(heading: float) -> None:
    me = robot(heading=heading)
    assert not touches(me, ball_at(me, 0.108))
    assert touches(me, ball_at(me, -0.108))


def test_a_ball_well_aside_is_not_touched() -> None:
    assert not touches(robot(), BallState(0.05, 0.15))


# In the air.


def test_a_ball_above_the_robots_touches_none() -> None:
    me, (x, y) = robot(), ball_at(robot(), 0.098).position
    assert touches(me, BallState(x, y, z=ROBOT_HEIGHT - 1e-6))
    assert not touches(me, BallState(x, y, z=ROBOT_HEIGHT))


def test_nobody_has_a_ball_that_is_too_high_to_be_received() -> None:
    me, (x, y) = robot(), ball_at(robot(), 0.098).position
    assert has_ball(me, BallState(x, y, z=RECEIVED_HEIGHT))
    assert not has_ball(me, BallState(x, y, z=RECEIVED_HEIGHT + 1e-6))
