"""The observation vectors are what the paper says, and do not change with the view."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin

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
    ball_angle,
    go_to_ball_observation,
    go_to_ball_of,
    shoot_observation,
    shoot_of,
    shot_features,
    shot_features_of,
    shot_scene,
    shot_scene_of,
)

coordinate = st.floats(-5, 5)
turn = st.floats(-3.1, 3.1)


def moved(points: np.ndarray, angle: float, dx: float, dy: float) -> np.ndarray:
    c, s = cos(angle), sin(angle)
    x, y = points[..., 0], points[..., 1]
    return np.stack([c * x - s * y + dx, s * x + c * y + dy], axis=-1)


def test_eq_4_by_hand() -> None:
    # Shooter at the origin, target 3 m up the y axis, opponent 1 m along and 0.5 m to the right of the line.
    found = shot_features((0, 0), (0, 3), (0.5, 1.0))
    np.testing.assert_allclose(found, [atan2(0.5, 1.0), 3.0, hypot(0.5, 1.0), 1.0, 0.5])


@given(coordinate, coordinate, coordinate, coordinate, turn, coordinate, coordinate)
def test_eq_4_does_not_change_when_the_field_is_turned_moved_or_mirrored(
    tx: float, ty: float, ox: float, oy: float, angle: float, dx: float, dy: float
) -> None:
    points = np.array([[0.3, -0.2], [tx, ty], [ox, oy]])
    if np.hypot(*(points[1] - points[0])) < 1e-3:
        return
    base = shot_features(*points)
    np.testing.assert_allclose(shot_features(*moved(points, angle, dx, dy)), base, atol=1e-6)
    np.testing.assert_allclose(shot_features(*(points * [1, -1])), base, atol=1e-9)
    assert (base >= [0, 0, 0, -np.inf, 0]).all()
    assert base[0] <= pi


def test_go_to_ball_by_hand() -> None:
    # Heading up the y axis, ball 2 m to the right of the robot, driving along +x.
    found = go_to_ball_observation((0, 0, pi / 2, 1.0, 0.0, 0.3), (2, 0))
    np.testing.assert_allclose(found, [-1, 0, 2, 0, -1, 0.3], atol=1e-12)
    assert ball_angle((0, 0, pi / 2), (2, 0)) == pytest.approx(-pi / 2)


def test_shoot_by_hand() -> None:
    found = shoot_observation((3.5, 0, 0, 0, 0, 2.0), (3.6, 0, 1, 0.5), (4.5, 0.5), (4.5, -0.5))
    post = atan2(0.5, 1.0)
    np.testing.assert_allclose(
        found, [0.1, 0, 1, 0.5, 2.0, 1.0, sin(post), cos(post), -sin(post), cos(post)], atol=1e-12
    )


@given(st.lists(coordinate, min_size=2, max_size=2), turn, st.lists(coordinate, min_size=4, max_size=4), turn)
def test_the_robot_frame_vectors_do_not_change_when_everything_is_turned(
    position: list[float], heading: float, ball: list[float], angle: float
) -> None:
    robot = np.array([*position, heading, 0.4, -0.3, 1.1])
    posts = np.array([[4.5, 0.5], [4.5, -0.5]])
    b = np.array(ball)
    if np.hypot(*(b[:2] - robot[:2])) < 1e-3:
        return
    turned = np.array(
        [*moved(robot[:2], angle, 0, 0), heading + angle, *moved(robot[3:5], angle, 0, 0), robot[5]]
    )
    turned_ball = np.concatenate([moved(b[:2], angle, 0, 0), moved(b[2:], angle, 0, 0)])
    np.testing.assert_allclose(
        go_to_ball_observation(turned, turned_ball), go_to_ball_observation(robot, b), atol=1e-9
    )
    np.testing.assert_allclose(
        shoot_observation(turned, turned_ball, *moved(posts, angle, 0, 0)),
        shoot_observation(robot, b, *posts),
        atol=1e-9,
    )


def test_batches_give_what_single_calls_give() -> None:
    rng = np.random.default_rng(1)
    robots, balls = rng.normal(size=(4, 6, 6)), rng.normal(size=(4, 6, 4))
    upper, lower = (4.5, 0.5), (4.5, -0.5)
    batch_go, batch_shoot = (
        go_to_ball_observation(robots, balls),
        shoot_observation(robots, balls, upper, lower),
    )
    assert batch_go.shape == (4, 6, GO_TO_BALL.size)
    assert batch_shoot.shape == (4, 6, SHOOT.size)
    for i in np.ndindex(4, 6):
        np.testing.assert_allclose(batch_go[i], go_to_ball_observation(robots[i], balls[i]))
        np.testing.assert_allclose(batch_shoot[i], shoot_observation(robots[i], balls[i], upper, lower))


def test_a_frame_gives_the_same_vectors_in_both_teams_views() -> None:
    me = RobotState(3, -1.0, 0.5, 0.7, 0.2, -0.1, 0.4)
    frame = Frame(0.0, DIVISION_B, BallState(0.5, -0.5, 1, 2), (me,), (RobotState(0, 4.0, 0.1),))
    targets = [[4.5, 0.2], [4.5, -0.2], [4.5, 0.0]]
    assert shot_features_of(frame, me, targets).shape == (3, 1, SHOT.size)
    assert go_to_ball_of(frame, me).shape == (GO_TO_BALL.size,)
    assert shoot_of(frame, me).shape == (SHOOT.size,)
    # Turned by 180 degrees and looking at the same posts, nothing changes.
    other = frame.mirrored()
    twin = other.opponents[0]
    np.testing.assert_allclose(go_to_ball_of(other, twin), go_to_ball_of(frame, me), atol=1e-12)


def test_no_distance_gives_no_nan() -> None:
    assert np.isfinite(shot_features((1, 1), (1, 1), (1, 1))).all()
    assert np.isfinite(go_to_ball_observation((0, 0, 0, 0, 0, 0), (0, 0))).all()


def test_every_observation_names_its_entries_once() -> None:
    for spec in OBSERVATIONS.values():
        names = [name for name, _ in spec.entries]
        assert len(set(names)) == spec.size
        assert spec.version >= 1


SHOOTER = (1.0, 1.0, 0.0, 0.5, 0.0, 0.0)
OPPONENTS = [(4.0, 3.0, 0.0, 0.0, 0.0, 0.0), (0.6, 3.0, 0.0, 0.3, 0.1, 0.0)]


def _entries(scene: np.ndarray) -> dict[str, float]:
    return {name: value for (name, _), value in zip(SHOT_SCENE.entries, scene, strict=True)}


def test_the_scene_of_a_shot_is_seen_along_the_shot() -> None:
    # Straight to the left of the field's axis: along is +y, across is -x.
    scene = _entries(shot_scene(SHOOTER, (1.0, 1.1, 0.0, 2.0), (1.0, 4.0), OPPONENTS))
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


def test_of_many_opponents_the_nearest_to_the_shot_stay_in_the_scene() -> None:
    far = [(x, -2.0, 0.0, 0.0, 0.0, 0.0) for x in np.linspace(-4.0, 0.0, 7)]
    scene = _entries(shot_scene(SHOOTER, (1, 1, 0, 0), (1.0, 4.0), far + OPPONENTS))
    assert (scene["opponent_0_along"], scene["opponent_0_across"]) == pytest.approx((2.0, 0.4))
    assert (scene["opponent_5_along"], scene["opponent_5_across"]) == pytest.approx((-3.0, 3.0))


def test_scenes_of_many_targets_and_frames_are_those_of_one() -> None:
    rng = np.random.default_rng(1)
    shooters, balls = rng.normal(size=(4, 1, 6)), rng.normal(size=(4, 1, 4))
    targets, opponents = rng.normal(size=(5, 2)), rng.normal(size=(4, 1, 8, 6))
    scenes = shot_scene(shooters, balls, targets, opponents)
    assert scenes.shape == (4, 5, SHOT_SCENE.size)
    for i, k in np.ndindex(4, 5):
        one = shot_scene(shooters[i, 0], balls[i, 0], targets[k], opponents[i, 0])
        np.testing.assert_allclose(scenes[i, k], one)


def test_a_frame_without_opponents_has_a_scene() -> None:
    frame = Frame(0.0, DIVISION_B, BallState(0.5, -0.5), (RobotState(3, -1.0, 0.5),))
    scene = shot_scene_of(frame, frame.own[0], [[4.5, 0.2]])
    np.testing.assert_array_equal(scene[0, SCENE_HEAD:].reshape(-1, 4), np.tile(ABSENT, (SCENE_OPPONENTS, 1)))
