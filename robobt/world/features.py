"""The observation vectors of the learned skills, each defined once.

Training, the skill at run time and the shot collector all call these functions.
Each works on arrays with any leading batch axes; the ``..._of`` wrappers take a
frame. A model card names the observation with its version: change what a vector
means and its version has to change with it.

Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
Eq. 4 and the state definitions of Go-To-Ball and Shoot-Towards-Goal, in the
form of the authors' published code; lengths here are metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robobt.world.geometry import FloatArray, wrap_angles
from robobt.world.state import Frame, RobotState


@dataclass(frozen=True)
class ObservationSpec:
    """Name, version and entries (name, unit) of an observation vector."""

    name: str
    version: int
    entries: tuple[tuple[str, str], ...]

    @property
    def size(self) -> int:
        """Length of the vector."""
        return len(self.entries)


SHOT = ObservationSpec(
    "shot",
    1,
    (
        ("angle", "rad"),
        ("target_distance", "m"),
        ("opponent_distance", "m"),
        ("along", "m"),
        ("across", "m"),
    ),
)
"""Eq. 4: one opponent beside the line shooter -> target."""

GO_TO_BALL = ObservationSpec(
    "go_to_ball",
    1,
    (
        ("sin_ball", "1"),
        ("cos_ball", "1"),
        ("ball_distance", "m"),
        ("vx", "m/s"),
        ("vy", "m/s"),
        ("omega", "rad/s"),
    ),
)
"""The ball and the robot's velocity, in the robot's frame."""

SHOOT = ObservationSpec(
    "shoot",
    1,
    (
        ("ball_x", "m"),
        ("ball_y", "m"),
        ("ball_vx", "m/s"),
        ("ball_vy", "m/s"),
        ("omega", "rad/s"),
        ("goal_distance", "m"),
        ("sin_upper_post", "1"),
        ("cos_upper_post", "1"),
        ("sin_lower_post", "1"),
        ("cos_lower_post", "1"),
    ),
)
"""The ball and the posts of the attacked goal, in the robot's frame."""

SCENE_OPPONENTS = 6
"""How many opponents a shot's scene has room for."""

ABSENT = (-99.0, 99.0, 0.0, 0.0)
"""An empty place in a shot's scene: a robot far behind the shooter."""

SHOT_SCENE = ObservationSpec(
    "shot_scene",
    1,
    (
        ("target_distance", "m"),
        ("target_angle", "rad"),
        ("target_offset", "m"),
        ("turn", "rad"),
        ("shooter_v_along", "m/s"),
        ("shooter_v_across", "m/s"),
        ("ball_along", "m"),
        ("ball_across", "m"),
        ("ball_v_along", "m/s"),
        ("ball_v_across", "m/s"),
        *(
            (f"opponent_{number}_{entry}", unit)
            for number in range(SCENE_OPPONENTS)
            for entry, unit in (("along", "m"), ("across", "m"), ("v_along", "m/s"), ("v_across", "m/s"))
        ),
    ),
)
"""All that moves, seen along the line shooter -> target, and the shot's place on the field."""

SCENE_HEAD = SHOT_SCENE.size - 4 * SCENE_OPPONENTS
"""Entries of a shot's scene before its opponents, which have four each."""

OBSERVATIONS = {spec.name: spec for spec in (SHOT, SHOT_SCENE, GO_TO_BALL, SHOOT)}


def shot_features(shooter: ArrayLike, target: ArrayLike, opponent: ArrayLike) -> FloatArray:
    """Eq. 4 of the paper.

    The frame has its origin at the shooter and its first axis along shooter ->
    target (not along the robot's heading).

    Args:
        shooter, target, opponent: (..., 2) positions [m]; axes broadcast.

    Returns:
        (..., 5): :data:`SHOT`.
    """
    origin = np.asarray(shooter, dtype=np.float64)
    to_target = np.asarray(target, dtype=np.float64) - origin
    to_opponent = np.asarray(opponent, dtype=np.float64) - origin
    length = np.hypot(to_target[..., 0], to_target[..., 1])
    safe = np.where(length > 0.0, length, 1.0)
    cos = np.where(length > 0.0, to_target[..., 0] / safe, 1.0)
    sin = to_target[..., 1] / safe
    along = cos * to_opponent[..., 0] + sin * to_opponent[..., 1]
    across = np.abs(cos * to_opponent[..., 1] - sin * to_opponent[..., 0])
    parts = np.broadcast_arrays(np.arctan2(across, along), length, np.hypot(along, across), along, across)
    return np.stack(parts, axis=-1)


def shot_scene(shooter: ArrayLike, ball: ArrayLike, target: ArrayLike, opponents: ArrayLike) -> FloatArray:
    """Everyone's state in the frame of a shot.

    The frame is that of :func:`shot_features`; ``across`` is positive to the left.
    ``target_angle`` is the direction shooter -> target on the field,
    ``target_offset`` the target's distance from the field's long axis, ``turn`` what
    the shooter's heading lacks to that direction.

    Args:
        shooter: (..., 6) x, y, heading, vx, vy, omega in field coordinates.
        ball: (..., 4) x, y, vx, vy in field coordinates.
        target: (..., 2) point aimed at.
        opponents: (..., K, 6) like the shooter. Of more than :data:`SCENE_OPPONENTS`
            those nearest to the segment shooter -> target count.

    Returns:
        (..., 34): :data:`SHOT_SCENE`, the nearest opponent first, then the others by
        their distance from the segment; places that are left are :data:`ABSENT`.
    """
    r, b = np.asarray(shooter, dtype=np.float64), np.asarray(ball, dtype=np.float64)
    t, o = np.asarray(target, dtype=np.float64), np.asarray(opponents, dtype=np.float64)
    dx, dy = t[..., 0] - r[..., 0], t[..., 1] - r[..., 1]
    length, angle = np.hypot(dx, dy), np.arctan2(dy, dx)
    cos, sin = np.cos(angle), np.sin(angle)

    def along(x: FloatArray, y: FloatArray) -> FloatArray:
        return np.asarray(cos * x + sin * y)

    def across(x: FloatArray, y: FloatArray) -> FloatArray:
        return np.asarray(cos * y - sin * x)

    bx, by = b[..., 0] - r[..., 0], b[..., 1] - r[..., 1]
    head = (
        length,
        angle,
        np.abs(t[..., 1]),
        wrap_angles(angle - r[..., 2]),
        along(r[..., 3], r[..., 4]),
        across(r[..., 3], r[..., 4]),
        along(bx, by),
        across(bx, by),
        along(b[..., 2], b[..., 3]),
        across(b[..., 2], b[..., 3]),
    )
    cos, sin = cos[..., None], sin[..., None]
    ox, oy = o[..., 0] - r[..., 0, None], o[..., 1] - r[..., 1, None]
    entries = (along(ox, oy), across(ox, oy), along(o[..., 3], o[..., 4]), across(o[..., 3], o[..., 4]))
    block = np.stack(np.broadcast_arrays(*entries), axis=-1)
    beyond = block[..., 0] - np.clip(block[..., 0], 0.0, length[..., None])
    order = np.argsort(np.hypot(beyond, block[..., 1]), axis=-1, kind="stable")[..., :SCENE_OPPONENTS]
    block = np.take_along_axis(block, order[..., None], axis=-2)
    lead = np.broadcast_shapes(block.shape[:-2], *(entry.shape for entry in head))
    scene = np.empty((*lead, SHOT_SCENE.size))
    for i, entry in enumerate(head):
        scene[..., i] = entry
    room = scene[..., SCENE_HEAD:].reshape(*lead, SCENE_OPPONENTS, 4)
    room[:] = ABSENT
    room[..., : block.shape[-2], :] = block
    scene[..., SCENE_HEAD:] = room.reshape(*lead, -1)
    return scene


def go_to_ball_observation(robot: ArrayLike, ball: ArrayLike) -> FloatArray:
    """State of the Go-To-Ball skill.

    Args:
        robot: (..., 6) x, y, heading, vx, vy, omega in field coordinates.
        ball: (..., >=2) x, y.

    Returns:
        (..., 6): :data:`GO_TO_BALL`.
    """
    r = np.asarray(robot, dtype=np.float64)
    b = np.asarray(ball, dtype=np.float64)
    parts = _go_to_ball(np, *_columns(r, 6), *_columns(b, 2))
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def shoot_observation(
    robot: ArrayLike, ball: ArrayLike, upper_post: ArrayLike, lower_post: ArrayLike
) -> FloatArray:
    """State of the Shoot-Towards-Goal skill.

    Args:
        robot: (..., 6) x, y, heading, vx, vy, omega in field coordinates.
        ball: (..., 4) x, y, vx, vy in field coordinates.
        upper_post, lower_post: (..., 2) the attacked goal's posts (y > 0, y < 0).

    Returns:
        (..., 10): :data:`SHOOT`.
    """
    r = np.asarray(robot, dtype=np.float64)
    b = np.asarray(ball, dtype=np.float64)
    upper = np.asarray(upper_post, dtype=np.float64)
    lower = np.asarray(lower_post, dtype=np.float64)
    parts = _shoot(np, *_columns(r, 6), *_columns(b, 4), *_columns(upper, 2), *_columns(lower, 2))
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def ball_angle(robot: ArrayLike, ball: ArrayLike) -> FloatArray:
    """Angle from the robot's heading to the ball in (-pi, pi] [rad]; shapes as above."""
    r = np.asarray(robot, dtype=np.float64)
    b = np.asarray(ball, dtype=np.float64)
    return wrap_angles(np.arctan2(b[..., 1] - r[..., 1], b[..., 0] - r[..., 0]) - r[..., 2])


def shot_features_of(frame: Frame, robot: RobotState, targets: ArrayLike) -> FloatArray:
    """Eq. 4 for every target point and every opponent of a frame.

    Args:
        targets: (T, 2) points [m].

    Returns:
        (T, K, 5) for the frame's K opponents.
    """
    points = np.asarray(targets, dtype=np.float64)
    opponents = np.array([other.position for other in frame.opponents], dtype=np.float64)
    return shot_features(robot.position, points[:, None, :], opponents.reshape(1, -1, 2))


def shot_scene_of(frame: Frame, robot: RobotState, targets: ArrayLike) -> FloatArray:
    """The scene of a shot for every target point of a frame.

    Args:
        targets: (T, 2) points [m].

    Returns:
        (T, 34): :data:`SHOT_SCENE`.
    """
    ball = frame.ball
    opponents = np.array([_kinematics(other) for other in frame.opponents], dtype=np.float64)
    return shot_scene(
        _kinematics(robot), (ball.x, ball.y, ball.vx, ball.vy), targets, opponents.reshape(-1, 6)
    )


def go_to_ball_of(frame: Frame, robot: RobotState) -> FloatArray:
    """The Go-To-Ball state of one robot in a frame, (6,)."""
    ball = frame.ball
    return np.array(_go_to_ball(math, *_kinematics(robot), ball.x, ball.y))


def shoot_of(frame: Frame, robot: RobotState) -> FloatArray:
    """The Shoot state of one robot in a frame, (10,)."""
    ball, field = frame.ball, frame.field
    goal, half_goal = field.half_length, field.goal_width / 2
    robot_and_ball = (*_kinematics(robot), ball.x, ball.y, ball.vx, ball.vy)
    return np.array(_shoot(math, *robot_and_ball, goal, half_goal, goal, -half_goal))


# The two states below take numbers with the functions of math, or arrays with those of numpy, which
# for a single robot cost several times as much.


def _go_to_ball(
    m: Any, x: Any, y: Any, heading: Any, vx: Any, vy: Any, omega: Any, ball_x: Any, ball_y: Any
) -> tuple[Any, ...]:
    cos, sin = m.cos(heading), m.sin(heading)
    dx, dy = ball_x - x, ball_y - y
    gap = m.hypot(dx, dy)
    # A ball at the robot's very centre counts as straight ahead.
    centred = gap == 0.0
    safe = gap + centred
    return (
        (cos * dy - sin * dx) / safe,
        (cos * dx + sin * dy) / safe + centred,
        gap,
        cos * vx + sin * vy,
        cos * vy - sin * vx,
        omega,
    )


def _shoot(
    m: Any,
    x: Any,
    y: Any,
    heading: Any,
    _vx: Any,
    _vy: Any,
    omega: Any,
    ball_x: Any,
    ball_y: Any,
    ball_vx: Any,
    ball_vy: Any,
    upper_x: Any,
    upper_y: Any,
    lower_x: Any,
    lower_y: Any,
) -> tuple[Any, ...]:
    cos, sin = m.cos(heading), m.sin(heading)
    dx, dy = ball_x - x, ball_y - y
    to_upper = m.atan2(upper_y - y, upper_x - x) - heading
    to_lower = m.atan2(lower_y - y, lower_x - x) - heading
    return (
        cos * dx + sin * dy,
        cos * dy - sin * dx,
        cos * ball_vx + sin * ball_vy,
        cos * ball_vy - sin * ball_vx,
        omega,
        m.hypot((upper_x + lower_x) / 2.0 - x, (upper_y + lower_y) / 2.0 - y),
        m.sin(to_upper),
        m.cos(to_upper),
        m.sin(to_lower),
        m.cos(to_lower),
    )


def _columns(array: FloatArray, count: int) -> list[FloatArray]:
    return [array[..., column] for column in range(count)]


def _kinematics(robot: RobotState) -> tuple[float, float, float, float, float, float]:
    return (robot.x, robot.y, robot.heading, robot.vx, robot.vy, robot.omega)
