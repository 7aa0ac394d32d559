"""The observation vectors are what the paper says, and do not change with the view."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.world import DIVISION_B, BallState, Frame, RobotState
from robobt.world.features import (
    ABSENT,
    GO_TO_BALL,
    OBSERVATIONS,
    SCENE_HEAD,
    SCENE_OPPONENTS,
    SHOOT,
    SHOT,
    SHOT_SCENE,
    find_observation,
    go_to_ball_of,
    go_to_ball_rows,
    shoot_of,
    shoot_rows,
    shot_features,
    shot_scene,
)
from robobt.world.team_view import team_view

coordinate = st.floats(-5, 5)
turn = st.floats(-3.1, 3.1)


def moved(points: np.ndarray, angle: float, dx: float, dy: float) -> np.ndarray:
    c, s = cos(angle), sin(angle)
    x, y = points[..., 0], points[..., 1]
    return np.stack([c * x - s * y + dx, s * x + c * y + dy], axis=-1)


def eq_4(shooter: np.ndarray, target: np.ndarray, opponent: np.ndarray) -> np.ndarray:
    return shot_features(shooter, target[None], opponent[None])[0, 0]


def go_to_ball(robot: np.ndarray | list[float], ball: np.ndarray | list[float]) -> np.ndarray:
    resting = np.array([[*ball, 0.0, 0.0]], dtype=float)
    return go_to_ball_rows(np.array([robot], dtype=float), resting, 4.5, 6)[0]


def shoot(robot: np.ndarray | list[float], ball: np.ndarray | list[float]) -> np.ndarray:
    return shoot_rows(np.array([robot], dtype=float), np.array([ball], dtype=float), 4.5, 0.5)[0]


def test_eq_4_by_hand() -> None:
    # Shooter at the origin, target 3 m up the y axis, opponent 1 m along and 0.5 m to the right of the line.
    found = eq_4(np.zeros(2), np.array([0.0, 3.0]), np.array([0.5, 1.0]))
    np.testing.assert_allclose(found, [atan2(0.5, 1.0), 3.0, hypot(0.5, 1.0), 1.0, 0.5])


@given(coordinate, coordinate, coordinate, coordinate, turn, coordinate, coordinate)
def test_eq_4_does_not_change_when_the_field_is_turned_moved_or_mirrored(
    tx: float, ty: float, ox: float, oy: float, angle: float, dx: float, dy: float
) -> None:
    points = np.array([[0.3, -0.2], [tx, ty], [ox, oy]])
    if np.hypot(*(points[1] - points[0])) < 1e-3:
        return
    base = eq_4(*points)
    np.testing.assert_allclose(eq_4(*moved(points, angle, dx, dy)), base, atol=1e-6)
    np.testing.assert_allclose(eq_4(*(points * [1, -1])), base, atol=1e-9)
    assert (base >= [0, 0, 0, -np.inf, 0]).all()
    assert base[0] <= pi


def test_going_to_the_ball_to_shoot_shows_the_goal_too() -> None:
    # Heading up the y axis; from the ball at (2, 2.5) m the goal's middle lies 45 degrees to the right of +x.
    robot, ball = np.array([[0.0, 0.0, pi / 2, 1.0, 0.0, 0.3]]), np.array([[2.0, 2.5, 0.0, 0.0]])
    (found,) = go_to_ball_rows(robot, ball, 4.5, 8)
    np.testing.assert_allclose(found[:6], go_to_ball_rows(robot, ball, 4.5, 6)[0])
    np.testing.assert_allclose(found[6:], [-sqrt(0.5), -sqrt(0.5)])


def test_go_to_ball_by_hand() -> None:
    # Heading up the y axis, ball 2 m to the right of the robot, driving along +x.
    found = go_to_ball([0, 0, pi / 2, 1.0, 0.0, 0.3], [2, 0])
    np.testing.assert_allclose(found, [-1, 0, 2, 0, -1, 0.3], atol=1e-12)


def test_shoot_by_hand() -> None:
    found = shoot([3.5, 0, 0, 0, 0, 2.0], [3.6, 0, 1, 0.5])
    post = atan2(0.5, 1.0)
    np.testing.assert_allclose(
        found, [0.1, 0, 1, 0.5, 2.0, 1.0, sin(post), cos(post), -sin(post), cos(post)], atol=1e-12
    )


@given(st.lists(coordinate, min_size=2, max_size=2), turn, st.lists(coordinate, min_size=2, max_size=2), turn)
def test_the_state_of_go_to_ball_does_not_change_when_everything_is_turned(
    position: list[float], heading: float, ball: list[float], angle: float
) -> None:
    robot = np.array([*position, heading, 0.4, -0.3, 1.1])
    b = np.array(ball)
    if np.hypot(*(b - robot[:2])) < 1e-3:
        return
    turned = np.array(
        [*moved(robot[:2], angle, 0, 0), heading + angle, *moved(robot[3:5], angle, 0, 0), robot[5]]
    )
    np.testing.assert_allclose(go_to_ball(turned, moved(b, angle, 0, 0)), go_to_ball(robot, b), atol=1e-9)


@given(st.lists(coordinate, min_size=2, max_size=2), turn, st.lists(coordinate, min_size=4, max_size=4))
def test_the_state_of_shoot_mirrors_with_the_field(
    position: list[float], heading: float, ball: list[float]
) -> None:
    flip = np.array([1, -1, 1, -1])
    found = shoot([*position, heading, 0.4, -0.3, 1.1], ball)
    mirror = shoot([*(position * flip[:2]), -heading, 0.4, 0.3, -1.1], ball * flip)
    np.testing.assert_allclose(mirror[:6], found[:6] * [1, -1, 1, -1, -1, 1], atol=1e-9)
    # The posts change places.
    np.testing.assert_allclose(mirror[6:], found[[8, 9, 6, 7]] * [-1, 1, -1, 1], atol=1e-9)


def test_a_skill_sees_what_training_sees() -> None:
    rng = np.random.default_rng(1)
    robots, balls = rng.normal(size=(40, 6)), rng.normal(size=(40, 4))
    robots[0, :2] = balls[0, :2]
    go, shots = go_to_ball_rows(robots, balls, 4.5, 6), shoot_rows(robots, balls, 4.5, 0.5)
    for i in range(40):
        me = RobotState(3, *robots[i].tolist())
        frame = Frame(0.0, DIVISION_B, BallState(*balls[i].tolist()), (me,))
        np.testing.assert_array_equal(go_to_ball_of(frame, me), go[i])
        np.testing.assert_array_equal(shoot_of(frame, me), shots[i])


def test_a_frame_gives_the_same_vector_in_both_teams_views() -> None:
    me = RobotState(3, -1.0, 0.5, 0.7, 0.2, -0.1, 0.4)
    frame = Frame(0.0, DIVISION_B, BallState(0.5, -0.5, 1, 2), (me,), (RobotState(0, 4.0, 0.1),))
    other = frame.mirrored()
    twin = other.opponents[0]
    np.testing.assert_allclose(go_to_ball_of(other, twin), go_to_ball_of(frame, me), atol=1e-12)


def test_no_distance_gives_no_nan() -> None:
    assert np.isfinite(eq_4(*np.ones((3, 2)))).all()
    np.testing.assert_array_equal(go_to_ball([1, 2, 0.5, 0, 0, 0], [1, 2]), [0, 1, 0, 0, 0, 0])


def test_a_row_has_as_many_entries_as_its_specification() -> None:
    robots, balls, points = np.ones((1, 6)), np.ones((1, 4)), np.ones((1, 2))
    assert go_to_ball_rows(robots, balls, 4.5, 6).shape == (1, GO_TO_BALL.size)
    assert shoot_rows(robots, balls, 4.5, 0.5).shape == (1, SHOOT.size)
    assert shot_features(np.ones(2), points, points).shape == (1, 1, SHOT.size)
    assert shot_scene(robots, balls, points, robots[None]).shape == (1, SHOT_SCENE.size)


def test_every_observation_names_its_entries_once() -> None:
    for spec in OBSERVATIONS.values():
        names = [entry.name for entry in spec.entries]
        assert len(set(names)) == spec.size
        assert spec.version >= 1


SHOOTER = (1.0, 1.0, 0.0, 0.5, 0.0, 0.0)
OPPONENTS = [(4.0, 3.0, 0.0, 0.0, 0.0, 0.0), (0.6, 3.0, 0.0, 0.3, 0.1, 0.0)]


def scene_of(ball: list[float], opponents: list[tuple[float, ...]]) -> dict[str, float]:
    """The scene of a shot straight to the left of the field's axis: along is +y, across is -x."""
    robots = np.array(opponents, dtype=float).reshape(1, -1, 6)
    row = shot_scene(np.array([SHOOTER]), np.array([ball]), np.array([[1.0, 4.0]]), robots)[0]
    return {entry.name: value for entry, value in zip(SHOT_SCENE.entries, row, strict=True)}


def test_the_scene_of_a_shot_is_seen_along_the_shot() -> None:
    scene = scene_of([1.0, 1.1, 0.0, 2.0], OPPONENTS)
    assert scene["target_distance"] == pytest.approx(3.0)
    assert scene["target_angle"] == scene["turn"] == pytest.approx(np.pi / 2)
    assert scene["target_offset"] == pytest.approx(4.0)
    assert (scene["shooter_v_along"], scene["shooter_v_across"]) == pytest.approx((0.0, -0.5))
    assert (scene["ball_along"], scene["ball_across"]) == pytest.approx((0.1, 0.0))
    assert (scene["ball_v_along"], scene["ball_v_across"]) == pytest.approx((2.0, 0.0))
    assert (scene["opponent_0_along"], scene["opponent_0_across"]) == pytest.approx((2.0, 0.4))
    assert (scene["opponent_0_v_along"], scene["opponent_0_v_across"]) == pytest.approx((0.1, -0.3))
    assert (scene["opponent_1_along"], scene["opponent_1_across"]) == pytest.approx((2.0, -3.0))
    assert tuple(scene[f"opponent_2_{name}"] for name in ("along", "across", "v_along", "v_across")) == ABSENT


def test_who_stands_beyond_the_target_comes_after_who_is_nearer_to_the_way_there() -> None:
    beyond, behind = (1.0, 5.0, 0.0, 0.0, 0.0, 0.0), (1.0, 0.2, 0.0, 0.0, 0.0, 0.0)
    scene = scene_of([1.0, 1.0, 0.0, 0.0], [beyond, behind, *OPPONENTS])
    places = [(scene[f"opponent_{i}_along"], scene[f"opponent_{i}_across"]) for i in range(4)]
    assert places == [pytest.approx(place) for place in ((2.0, 0.4), (-0.8, 0.0), (4.0, 0.0), (2.0, -3.0))]


def test_the_turn_of_a_shot_is_the_short_way_round() -> None:
    shooter, target = np.array([[0.0, 0.0, -3.0, 0.0, 0.0, 0.0]]), np.array([[-1.0, 0.1]])
    row = shot_scene(shooter, np.zeros((1, 4)), target, np.empty((1, 0, 6)))[0]
    names = [entry.name for entry in SHOT_SCENE.entries]
    assert row[names.index("turn")] == pytest.approx(3.0 - pi - atan2(0.1, 1.0))


def test_of_many_opponents_the_nearest_to_the_shot_stay_in_the_scene() -> None:
    far = [(x, -2.0, 0.0, 0.0, 0.0, 0.0) for x in np.linspace(-4.0, 0.0, 7)]
    scene = scene_of([1.0, 1.0, 0.0, 0.0], far + OPPONENTS)
    assert (scene["opponent_0_along"], scene["opponent_0_across"]) == pytest.approx((2.0, 0.4))
    assert (scene["opponent_5_along"], scene["opponent_5_across"]) == pytest.approx((-3.0, 3.0))


def test_the_places_of_equally_near_opponents_are_in_their_order() -> None:
    pair = [(1.5, 2.0, 0.0, 0.1, 0.0, 0.0), (1.5, 2.0, 0.0, 0.2, 0.0, 0.0)]
    assert scene_of([1.0, 1.0, 0.0, 0.0], pair)["opponent_0_v_across"] == pytest.approx(-0.1)
    assert scene_of([1.0, 1.0, 0.0, 0.0], pair[::-1])["opponent_0_v_across"] == pytest.approx(-0.2)


def test_without_opponents_every_place_in_the_scene_is_absent() -> None:
    places = list(scene_of([1.0, 1.0, 0.0, 0.0], []).values())[SCENE_HEAD:]
    np.testing.assert_array_equal(np.reshape(places, (-1, 4)), np.tile(ABSENT, (SCENE_OPPONENTS, 1)))


@pytest.mark.parametrize("told", [0, 1, 2])
def test_a_team_view_is_found_by_its_name_with_what_it_tells_of_restarts(told: int) -> None:
    spec = team_view(2, 3, told)
    assert find_observation(spec.name) == spec
    assert spec.size == team_view(2, 3).size + told
    assert [entry.name for entry in spec.entries][spec.size - told :] == ["restart", "barred"][:told]
