from math import hypot

import numpy as np
import pytest

from robobt.skills.aim.raters.openings import disc_shadow, free_intervals, goal_mouth
from robobt.skills.team.position_grid import clusters, lane_shadow, position_grid, shot_path
from robobt.testing import robot
from robobt.world import DIVISION_A, DIVISION_B, ROBOT_RADIUS, FieldGeometry, RobotState
from robobt.world.geometry import Point, segment_distance
from robobt.world.rules import in_their_defense_area

GRID = position_grid(DIVISION_B, 0.1)
SCENES = [robot(2.5, 0.0), robot(1.0, 1.2), robot(3.0, -0.7), robot(0.3, -2.5)]


def points(mask: np.ndarray) -> list[Point]:
    return [(float(GRID.x[i, 0]), float(GRID.y[0, j])) for i, j in np.argwhere(mask)]


def free_angle(origin: Point, opponent: RobotState) -> float:
    mouth = goal_mouth(DIVISION_B, origin, 0.0)
    assert mouth is not None
    shadow = disc_shadow(DIVISION_B, origin, opponent.position, ROBOT_RADIUS)
    assert shadow is not None
    return sum(high - low for low, high in free_intervals(mouth, [shadow]))


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B])
def test_the_grid_covers_the_opponents_half_and_is_its_own_mirror_image(field: FieldGeometry) -> None:
    grid = position_grid(field, 0.1)
    assert grid.x[0, 0] == 0.0
    assert field.half_length - 0.35 < grid.x[-1, 0] <= field.half_length - 0.2 + 1e-6
    assert (grid.y == -grid.y[:, ::-1]).all()
    assert grid.forbidden.any()
    assert (grid.forbidden == grid.forbidden[:, ::-1]).all()
    assert position_grid(field, 0.1) is grid


def test_the_defence_area_is_forbidden_and_the_rest_is_not() -> None:
    for point in points(GRID.forbidden):
        assert in_their_defense_area(DIVISION_B, *point, tolerance=0.2001)
    for point in points(~GRID.forbidden):
        assert not in_their_defense_area(DIVISION_B, *point, tolerance=0.19)


@pytest.mark.parametrize("opponent", SCENES)
def test_where_the_goal_is_hidden_no_post_is_seen_and_beside_it_one_is(opponent: RobotState) -> None:
    mask = np.zeros(GRID.forbidden.shape, dtype=bool)
    for rows, hidden in GRID.goal_hidden((opponent,), extra=0.0):
        mask[rows] |= hidden
    behind = GRID.x < opponent.x - ROBOT_RADIUS
    assert all(free_angle(point, opponent) < 1e-6 for point in points(mask & behind))
    assert all(free_angle(point, opponent) > 0.0 for point in points(~mask & behind))


def test_a_robot_near_the_goal_line_hides_the_goal_from_right_behind_it_only() -> None:
    grid = position_grid(DIVISION_B, 0.02)
    ((rows, _),) = grid.goal_hidden((robot(3.0, 0.0),), extra=0.0)
    umbra = ROBOT_RADIUS / (0.5 - ROBOT_RADIUS) * 1.5
    assert grid.x[rows.start, 0] == pytest.approx(3.0 - umbra, abs=0.03)


def test_two_robots_side_by_side_hide_more_than_each_alone() -> None:
    pair = (robot(2.5, 0.11), robot(2.5, -0.11, number=1))
    together = sum(int(mask.sum()) for _, mask in GRID.goal_hidden(pair, extra=0.0))
    alone = sum(int(mask.sum()) for each in pair for _, mask in GRID.goal_hidden((each,), extra=0.0))
    assert together > alone


def test_a_robot_behind_the_goal_line_or_on_a_post_is_no_trouble() -> None:
    assert GRID.goal_hidden((robot(4.6, 0.0),), extra=0.1) == []
    GRID.goal_hidden((robot(4.49999999, 0.5),), extra=0.1)


def test_robots_that_let_no_ball_through_are_one_cluster_from_left_to_right() -> None:
    a, b, c = robot(1.0, 0.2), robot(1.0, 0.0, number=1), robot(1.0, -0.5, number=2)
    assert [[r.id for r in group] for group in clusters((c, b, a))] == [[0, 1], [2]]
    assert clusters(()) == []


@pytest.mark.parametrize("ball", [(-1.0, 0.3), (1.5, -1.0), (2.4, 0.05)])
@pytest.mark.parametrize("opponent", SCENES)
def test_a_lane_is_shadowed_where_it_passes_the_robot_too_near(ball: Point, opponent: RobotState) -> None:
    radius = 0.275
    inside = GRID.count_regions([lane_shadow(ball, opponent, radius)]) > 0
    gap = hypot(opponent.x - ball[0], opponent.y - ball[1])
    for expected, region in ((True, inside), (False, ~inside)):
        for point in points(region):
            along = (point[0] - ball[0]) * (opponent.x - ball[0])
            along += (point[1] - ball[1]) * (opponent.y - ball[1])
            distance = segment_distance(opponent.position, ball, point)
            if abs(along / gap - gap) < 1e-3 or abs(distance - radius) < 1e-3:
                continue
            assert (along / gap > gap and distance < radius) is expected, point


def test_regions_are_counted() -> None:
    ball = (0.0, 0.0)
    both = GRID.count_regions(
        [lane_shadow(ball, robot(1.0, 0.0), 0.3), lane_shadow(ball, robot(2.0, 0.0), 0.3)]
    )
    assert GRID.at(both.astype(np.float32), (3.0, 0.0)) == 2.0
    assert GRID.at(both.astype(np.float32), (1.5, 0.0)) == 1.0
    assert GRID.at(both.astype(np.float32), (0.5, 0.0)) == 0.0
    assert not GRID.count_regions([]).any()


def test_the_path_of_a_shot_is_the_triangle_from_the_ball_to_the_widened_goal() -> None:
    region = GRID.count_regions([shot_path(DIVISION_B, (1.0, 0.5), 0.6)]).astype(np.float32)
    for point, inside in (
        ((2.75, 0.2), 1.0),
        ((4.2, 0.9), 1.0),
        ((4.2, -0.9), 1.0),
        ((2.0, 0.9), 0.0),
        ((4.2, 1.2), 0.0),
        ((0.5, 0.5), 0.0),
    ):
        assert GRID.at(region, point) == inside, point


def test_a_value_off_the_grid_is_the_worst() -> None:
    value = np.zeros(GRID.forbidden.shape, dtype=np.float32)
    assert GRID.at(value, (-0.5, 0.0)) == -np.inf
    assert GRID.at(value, (1.0, 5.0)) == -np.inf
