"""The observation vectors of the learned skills, each defined once and compiled.

What a vector holds is written as a function of one robot, one ball, …, that fills one
row; training calls it in a compiled loop over many arenas, a skill for its own robot
through the ``..._of`` function that takes a frame. A model card names the observation
with its version: change what a vector means and its version has to change with it.

Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
Eq. 4 and the state definitions of Go-To-Ball and Shoot-Towards-Goal, in the
form of the authors' published code; lengths here are metres.
"""

from __future__ import annotations

from math import atan2, cos, hypot, sin

import numpy as np

from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.observation import OWN_OBSERVATIONS, Row, entries, kinematics, motion
from robobt.world.observation import ObservationSpec as ObservationSpec
from robobt.world.scoring import SCORE_ON_GOALKEEPER
from robobt.world.state import Frame, RobotState
from robobt.world.team_view import places_of, team_view

SHOT = ObservationSpec(
    "shot", 1, (*entries("angle", "rad"), *entries("target_distance opponent_distance along across", "m"))
)
"""Eq. 4: one opponent beside the line shooter -> target."""

GO_TO_BALL = ObservationSpec(
    "go_to_ball",
    1,
    (
        *entries("sin_ball cos_ball", most=1.0),
        *entries("ball_distance", "m", "far", 3.0, signed=False),
        *entries("vx vy", "m/s", "speed", "max_speed"),
        *entries("omega", "rad/s", "turn", "max_turn"),
    ),
)
"""The ball and the robot's velocity, in the robot's frame."""

GO_TO_BALL_TO_SHOOT = ObservationSpec(
    "go_to_ball_to_shoot", 1, (*GO_TO_BALL.entries, *entries("sin_goal cos_goal", most=1.0))
)
"""The same, and the direction from the ball to the middle of the attacked goal, in the robot's frame."""

SHOOT = ObservationSpec(
    "shoot",
    1,
    (
        *entries("ball_x ball_y", "m", "far", 0.1),
        *entries("ball_vx ball_vy", "m/s", "ball_speed", 1.0),
        *entries("omega", "rad/s", "turn", "max_turn"),
        *entries("goal_distance", "m", "far", 3.0, signed=False),
        *entries("sin_upper_post cos_upper_post sin_lower_post cos_lower_post", most=1.0),
    ),
)
"""The ball and the posts of the attacked goal, in the robot's frame.

The scales are those of a ball that is about to slip off the dribbler, by millimetres, at less than 1 m/s.
"""

SCENE_OPPONENTS = 6
"""How many opponents a shot's scene has room for."""

ABSENT = (-99.0, 99.0, 0.0, 0.0)
"""An empty place in a shot's scene: a robot far behind the shooter."""

SHOT_SCENE = ObservationSpec(
    "shot_scene",
    1,
    (
        *entries("target_distance", "m"),
        *entries("target_angle", "rad"),
        *entries("target_offset", "m"),
        *entries("turn", "rad"),
        *entries("shooter_v_along shooter_v_across", "m/s"),
        *entries("ball_along ball_across", "m"),
        *entries("ball_v_along ball_v_across", "m/s"),
        *(
            entry
            for k in range(SCENE_OPPONENTS)
            for entry in (
                *entries(f"opponent_{k}_along opponent_{k}_across", "m"),
                *entries(f"opponent_{k}_v_along opponent_{k}_v_across", "m/s"),
            )
        ),
    ),
)
"""All that moves, seen along the line shooter -> target, and the shot's place on the field."""

SCENE_HEAD = SHOT_SCENE.size - 4 * SCENE_OPPONENTS
"""Entries of a shot's scene before its opponents, which have four each."""

_ABSENT = np.array(ABSENT)

OBSERVATIONS = {
    spec.name: spec
    for spec in (
        *(SHOT, SHOT_SCENE, GO_TO_BALL, GO_TO_BALL_TO_SHOOT, GO_TO_BALL_AMONG_ROBOTS),
        *(SHOOT, SCORE_ON_GOALKEEPER),
    )
}
"""By their names, but those of robots in a team, of which there are as many as sizes of teams."""


def find_observation(name: str) -> ObservationSpec | None:
    """Return the observation of that name, those of robots in a team included; None: there is none."""
    places = places_of(name)
    if places is not None:
        return team_view(*places)
    return OBSERVATIONS.get(name) or OWN_OBSERVATIONS.get(name)


@compiled
def _observe_go_to_ball(robot: Row, ball: Row, goal_x: float, row: FloatArray) -> None:
    c, s = cos(robot[2]), sin(robot[2])
    dx, dy = ball[0] - robot[0], ball[1] - robot[1]
    distance = hypot(dx, dy)
    if distance == 0.0:
        # A ball at the robot's very centre counts as straight ahead. NaN has to stay NaN.
        row[0] = 0.0
        row[1] = 1.0
    else:
        row[0] = (c * dy - s * dx) / distance
        row[1] = (c * dx + s * dy) / distance
    row[2] = distance
    row[3] = c * robot[3] + s * robot[4]
    row[4] = c * robot[4] - s * robot[3]
    row[5] = robot[5]
    if len(row) > 6:
        to_goal = atan2(-ball[1], goal_x - ball[0]) - robot[2]
        row[6] = sin(to_goal)
        row[7] = cos(to_goal)


@compiled
def _observe_shoot(robot: Row, ball: Row, goal_x: float, post_y: float, row: FloatArray) -> None:
    c, s = cos(robot[2]), sin(robot[2])
    dx, dy = ball[0] - robot[0], ball[1] - robot[1]
    to_upper = atan2(post_y - robot[1], goal_x - robot[0]) - robot[2]
    to_lower = atan2(-post_y - robot[1], goal_x - robot[0]) - robot[2]
    row[0] = c * dx + s * dy
    row[1] = c * dy - s * dx
    row[2] = c * ball[2] + s * ball[3]
    row[3] = c * ball[3] - s * ball[2]
    row[4] = robot[5]
    row[5] = hypot(goal_x - robot[0], robot[1])
    row[6] = sin(to_upper)
    row[7] = cos(to_upper)
    row[8] = sin(to_lower)
    row[9] = cos(to_lower)


@compiled
def _observe_shot(shooter: FloatArray, target: FloatArray, opponent: FloatArray, row: FloatArray) -> None:
    dx, dy = target[0] - shooter[0], target[1] - shooter[1]
    length = hypot(dx, dy)
    c, s = (dx / length, dy / length) if length > 0.0 else (1.0, 0.0)
    ox, oy = opponent[0] - shooter[0], opponent[1] - shooter[1]
    along, across = c * ox + s * oy, abs(c * oy - s * ox)
    row[0] = atan2(across, along)
    row[1] = length
    row[2] = hypot(along, across)
    row[3] = along
    row[4] = across


@compiled
def _observe_scene(
    shooter: FloatArray, ball: FloatArray, target: FloatArray, opponents: FloatArray, row: FloatArray
) -> None:
    dx, dy = target[0] - shooter[0], target[1] - shooter[1]
    length, angle = hypot(dx, dy), atan2(dy, dx)
    c, s = cos(angle), sin(angle)
    bx, by = ball[0] - shooter[0], ball[1] - shooter[1]
    row[0] = length
    row[1] = angle
    row[2] = abs(target[1])
    row[3] = wrap_angle(angle - shooter[2])
    row[4] = c * shooter[3] + s * shooter[4]
    row[5] = c * shooter[4] - s * shooter[3]
    row[6] = c * bx + s * by
    row[7] = c * by - s * bx
    row[8] = c * ball[2] + s * ball[3]
    row[9] = c * ball[3] - s * ball[2]
    places = row[SCENE_HEAD:].reshape(SCENE_OPPONENTS, 4)
    gaps = np.full(SCENE_OPPONENTS, np.inf)
    places[:] = _ABSENT
    for i in range(len(opponents)):
        other = opponents[i]
        ox, oy = other[0] - shooter[0], other[1] - shooter[1]
        along, across = c * ox + s * oy, c * oy - s * ox
        gap = hypot(along - min(max(along, 0.0), length), across)
        # Insert it behind those that are as near, and move the farther ones on.
        place = SCENE_OPPONENTS
        while place > 0 and gap < gaps[place - 1]:
            place -= 1
            if place + 1 < SCENE_OPPONENTS:
                gaps[place + 1] = gaps[place]
                places[place + 1] = places[place]
        if place < SCENE_OPPONENTS:
            gaps[place] = gap
            places[place, 0] = along
            places[place, 1] = across
            places[place, 2] = c * other[3] + s * other[4]
            places[place, 3] = c * other[4] - s * other[3]


@compiled
def go_to_ball_rows(robots: FloatArray, balls: FloatArray, goal_x: float, size: int) -> FloatArray:
    """Compute the states of many arenas, (n, size): :data:`GO_TO_BALL` or :data:`GO_TO_BALL_TO_SHOOT`.

    Arguments as for :func:`shoot_rows`; of the balls only x and y count.
    """
    rows = np.empty((len(robots), size))
    for i in range(len(robots)):
        _observe_go_to_ball(robots[i], balls[i], goal_x, rows[i])
    return rows


@compiled
def shoot_rows(robots: FloatArray, balls: FloatArray, goal_x: float, post_y: float) -> FloatArray:
    """Compute the states :data:`SHOOT` of many arenas, (n, 10).

    ``robots`` (n, 6) are x, y, heading, vx, vy, omega and ``balls`` (n, 4) x, y, vx, vy in field coordinates;
    ``goal_x`` is where the attacked goal's line is, ``post_y`` the distance of its posts from the field's
    long axis [m].
    """
    rows = np.empty((len(robots), 10))
    for i in range(len(robots)):
        _observe_shoot(robots[i], balls[i], goal_x, post_y, rows[i])
    return rows


@compiled
def shot_features(shooter: FloatArray, targets: FloatArray, opponents: FloatArray) -> FloatArray:
    """Compute Eq. 4 of the paper, :data:`SHOT`, for every target point and every opponent, (T, K, 5).

    The frame has its origin at the shooter and its first axis along shooter ->
    target (not along the robot's heading).

    Positions in metres: the ``shooter`` (2,), ``targets`` (T, 2) and ``opponents`` (K, 2).
    """
    rows = np.empty((len(targets), len(opponents), 5))
    for i in range(len(targets)):
        for k in range(len(opponents)):
            _observe_shot(shooter, targets[i], opponents[k], rows[i, k])
    return rows


@compiled
def shot_scene(
    shooters: FloatArray, balls: FloatArray, targets: FloatArray, opponents: FloatArray
) -> FloatArray:
    """Compute everyone's state in the frame of each of many shots.

    The frame is that of :func:`shot_features`; ``across`` is positive to the left.
    ``target_angle`` is the direction shooter -> target on the field,
    ``target_offset`` the target's distance from the field's long axis, ``turn`` what
    the shooter's heading lacks to that direction.

    Args:
        shooters: (n, 6) x, y, heading, vx, vy, omega in field coordinates.
        balls: (n, 4) x, y, vx, vy in field coordinates.
        targets: (n, 2) points aimed at.
        opponents: (n, K, 6) like the shooters. Of more than :data:`SCENE_OPPONENTS`
            those nearest to the segment shooter -> target count.

    Returns:
        (n, 34): :data:`SHOT_SCENE`, the nearest opponent first, then the others by
        their distance from the segment; places that are left are :data:`ABSENT`.
    """
    rows = np.empty((len(targets), SCENE_HEAD + 4 * SCENE_OPPONENTS))
    for i in range(len(targets)):
        _observe_scene(shooters[i], balls[i], targets[i], opponents[i], rows[i])
    return rows


def go_to_ball_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the Go-To-Ball state of one robot in a frame, (6,)."""
    return _go_to_ball(frame, robot, GO_TO_BALL.size)


def go_to_ball_to_shoot_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute that of one that is to shoot, (8,)."""
    return _go_to_ball(frame, robot, GO_TO_BALL_TO_SHOOT.size)


def _go_to_ball(frame: Frame, robot: RobotState, size: int) -> FloatArray:
    row = np.empty(size)
    _observe_go_to_ball(kinematics(robot), motion(frame), frame.field.half_length, row)
    return row


def shoot_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the Shoot state of one robot in a frame, (10,)."""
    field, row = frame.field, np.empty(10)
    _observe_shoot(kinematics(robot), motion(frame), field.half_length, field.goal_width / 2, row)
    return row
