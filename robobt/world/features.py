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

from collections.abc import Sequence
from math import atan2, cos, hypot, inf, sin
from typing import Any, Protocol

import numpy as np

from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS
from robobt.world.compiled import compiled, compiled_merged, record_dtype
from robobt.world.geometry import FloatArray, wrap_angle
from robobt.world.memory import memory_of, with_memory
from robobt.world.observation import (
    OWN_OBSERVATIONS,
    Row,
    ball_named,
    entries,
    kinematics,
    motion,
    record_of,
    robot_named,
    turned,
)
from robobt.world.observation import ObservationSpec as ObservationSpec
from robobt.world.records import BALL, FIELD_PLACE, ROBOT, Ball, Place, Robot
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
"""Go-To-Ball's entries, and the direction from the ball to the goal's middle, in the robot's frame."""

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


class Opponent(Protocol):
    """A place in a shot's scene [m, m/s]."""

    along: float
    across: float
    v_along: float
    v_across: float


_WITHOUT_GOAL, _SHOOT_SIZE, _SHOT_SIZE = GO_TO_BALL.size, SHOOT.size, SHOT.size
_WITH_GOAL = GO_TO_BALL_TO_SHOOT.size
_GO_TO_BALL_FIELDS, _SHOOT_FIELDS, _SHOT_FIELDS = (
    record_of(GO_TO_BALL.entries),
    record_of(SHOOT.entries),
    record_of(SHOT.entries),
)
_GOAL = record_of(GO_TO_BALL_TO_SHOOT.entries[_WITHOUT_GOAL:])
_SCENE_FIELDS, _OPPONENT_FIELDS = record_of(SHOT_SCENE.entries[:SCENE_HEAD]), record_dtype(Opponent)

OBSERVATIONS = {
    spec.name: spec
    for spec in (
        *(SHOT, SHOT_SCENE, GO_TO_BALL, GO_TO_BALL_TO_SHOOT, GO_TO_BALL_AMONG_ROBOTS),
        *(SHOOT, SCORE_ON_GOALKEEPER),
    )
}
"""Observations by name, except those of robots in a team, which depend on the teams' sizes."""


def find_observation(name: str) -> ObservationSpec | None:
    """Return the observation of that name, or None; also those of robots in a team, and with a memory."""
    places = places_of(name)
    if places is not None:
        return team_view(*places)
    memory = memory_of(name)
    if memory is not None:
        base = find_observation(memory.base)
        return None if base is None else with_memory(base, memory)
    return OBSERVATIONS.get(name) or OWN_OBSERVATIONS.get(name)


@compiled_merged
def _observe_go_to_ball(robot: Robot, ball: Ball, seen: Any) -> None:
    c, s = cos(robot.heading), sin(robot.heading)
    dx, dy = ball.x - robot.x, ball.y - robot.y
    distance = hypot(dx, dy)
    if distance == 0.0:
        # A ball at the robot's very centre counts as straight ahead. NaN has to stay NaN.
        seen.sin_ball, seen.cos_ball = 0.0, 1.0
    else:
        ahead, left = turned(c, s, dx, dy)
        seen.sin_ball, seen.cos_ball = left / distance, ahead / distance
    seen.ball_distance = distance
    seen.vx, seen.vy = turned(c, s, robot.vx, robot.vy)
    seen.omega = robot.omega


@compiled_merged
def _observe_goal(robot: Robot, ball: Ball, goal_x: float, seen: Any) -> None:
    to_goal = atan2(-ball.y, goal_x - ball.x) - robot.heading
    seen.sin_goal, seen.cos_goal = sin(to_goal), cos(to_goal)


@compiled_merged
def _observe_shoot(robot: Robot, ball: Ball, goal_x: float, post_y: float, seen: Any) -> None:
    c, s = cos(robot.heading), sin(robot.heading)
    to_upper = atan2(post_y - robot.y, goal_x - robot.x) - robot.heading
    to_lower = atan2(-post_y - robot.y, goal_x - robot.x) - robot.heading
    seen.ball_x, seen.ball_y = turned(c, s, ball.x - robot.x, ball.y - robot.y)
    seen.ball_vx, seen.ball_vy = turned(c, s, ball.vx, ball.vy)
    seen.omega = robot.omega
    seen.goal_distance = hypot(goal_x - robot.x, robot.y)
    seen.sin_upper_post, seen.cos_upper_post = sin(to_upper), cos(to_upper)
    seen.sin_lower_post, seen.cos_lower_post = sin(to_lower), cos(to_lower)


@compiled_merged
def _observe_shot(shooter: Place, target: Place, opponent: Place, seen: Any) -> None:
    dx, dy = target.x - shooter.x, target.y - shooter.y
    length = hypot(dx, dy)
    c, s = (dx / length, dy / length) if length > 0.0 else (1.0, 0.0)
    along, left = turned(c, s, opponent.x - shooter.x, opponent.y - shooter.y)
    across = abs(left)
    seen.angle, seen.target_distance = atan2(across, along), length
    seen.opponent_distance, seen.along, seen.across = hypot(along, across), along, across


@compiled_merged
def _observe_scene(shooter: Robot, ball: Ball, target: Place, seen: Any) -> tuple[float, float, float]:
    """Fill in all but the opponents; return cosine and sine of the shot's direction, and its length."""
    dx, dy = target.x - shooter.x, target.y - shooter.y
    length, angle = hypot(dx, dy), atan2(dy, dx)
    c, s = cos(angle), sin(angle)
    seen.target_distance, seen.target_angle, seen.target_offset = length, angle, abs(target.y)
    seen.turn = wrap_angle(angle - shooter.heading)
    seen.shooter_v_along, seen.shooter_v_across = turned(c, s, shooter.vx, shooter.vy)
    seen.ball_along, seen.ball_across = turned(c, s, ball.x - shooter.x, ball.y - shooter.y)
    seen.ball_v_along, seen.ball_v_across = turned(c, s, ball.vx, ball.vy)
    return c, s, length


@compiled_merged
def _observe_opponents(
    shooter: Robot,
    line: tuple[float, float, float],
    opponents: Sequence[Robot],
    places: Sequence[Opponent],
    gaps: FloatArray,
) -> None:
    """Fill the places with the opponents nearest to the shot, the ``line`` of :func:`_observe_scene`."""
    c, s, length = line
    for k in range(len(places)):
        gaps[k], empty = inf, places[k]
        empty.along, empty.across, empty.v_along, empty.v_across = ABSENT
    for other in opponents:
        along, across = turned(c, s, other.x - shooter.x, other.y - shooter.y)
        gap = hypot(along - min(max(along, 0.0), length), across)
        # Insert it behind those that are as near, and move the farther ones on.
        k = len(places)
        while k > 0 and gap < gaps[k - 1]:
            k -= 1
            if k + 1 < len(places):
                gaps[k + 1] = gaps[k]
                here, there = places[k], places[k + 1]
                there.along, there.across = here.along, here.across
                there.v_along, there.v_across = here.v_along, here.v_across
        if k < len(places):
            gaps[k], place = gap, places[k]
            place.along, place.across = along, across
            place.v_along, place.v_across = turned(c, s, other.vx, other.vy)


@compiled
def go_to_ball_rows(robots: FloatArray, balls: FloatArray, goal_x: float, size: int) -> FloatArray:
    """Compute the states of many arenas, (n, size): :data:`GO_TO_BALL` or :data:`GO_TO_BALL_TO_SHOOT`.

    Arguments as for :func:`shoot_rows`.
    """
    rows = np.empty((len(robots), size))
    each, rolling = robots.view(ROBOT)[:, 0], balls.view(BALL)[:, 0]
    seen = rows[:, :_WITHOUT_GOAL].view(_GO_TO_BALL_FIELDS)[:, 0]
    for i in range(len(rows)):
        _observe_go_to_ball(each[i], rolling[i], seen[i])
    if size > _WITHOUT_GOAL:
        goals = rows[:, _WITHOUT_GOAL:].view(_GOAL)[:, 0]
        for i in range(len(rows)):
            _observe_goal(each[i], rolling[i], goal_x, goals[i])
    return rows


@compiled
def shoot_rows(robots: FloatArray, balls: FloatArray, goal_x: float, post_y: float) -> FloatArray:
    """Compute the states :data:`SHOOT` of many arenas, (n, 10).

    ``robots`` (n, 6) are x, y, heading, vx, vy, omega and ``balls`` (n, 4) x, y, vx, vy in field coordinates;
    ``goal_x`` is where the attacked goal's line is, ``post_y`` the distance of its posts from the field's
    long axis [m].
    """
    rows = np.empty((len(robots), _SHOOT_SIZE))
    each, rolling, seen = robots.view(ROBOT)[:, 0], balls.view(BALL)[:, 0], rows.view(_SHOOT_FIELDS)[:, 0]
    for i in range(len(rows)):
        _observe_shoot(each[i], rolling[i], goal_x, post_y, seen[i])
    return rows


@compiled
def shot_features(shooter: FloatArray, targets: FloatArray, opponents: FloatArray) -> FloatArray:
    """Compute Eq. 4 of the paper, :data:`SHOT`, for every target point and every opponent, (T, K, 5).

    The frame has its origin at the shooter and its first axis along shooter ->
    target (not along the robot's heading).

    Positions in metres: the ``shooter`` (2,), ``targets`` (T, 2) and ``opponents`` (K, 2).
    """
    rows = np.empty((len(targets), len(opponents), _SHOT_SIZE))
    me, aims, others = (
        shooter.view(FIELD_PLACE)[0],
        targets.view(FIELD_PLACE)[:, 0],
        opponents.view(FIELD_PLACE)[:, 0],
    )
    seen = rows.view(_SHOT_FIELDS)[..., 0]
    for i in range(len(aims)):
        for k in range(len(others)):
            _observe_shot(me, aims[i], others[k], seen[i, k])
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
    rows = np.empty((len(targets), SCENE_HEAD + len(ABSENT) * SCENE_OPPONENTS))
    each, rolling, aims = shooters.view(ROBOT)[:, 0], balls.view(BALL)[:, 0], targets.view(FIELD_PLACE)[:, 0]
    others, gaps = opponents.view(ROBOT)[..., 0], np.empty(SCENE_OPPONENTS)
    seen, places = rows[:, :SCENE_HEAD].view(_SCENE_FIELDS)[:, 0], rows[:, SCENE_HEAD:].view(_OPPONENT_FIELDS)
    for i in range(len(rows)):
        line = _observe_scene(each[i], rolling[i], aims[i], seen[i])
        _observe_opponents(each[i], line, others[i], places[i], gaps)
    return rows


def go_to_ball_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the Go-To-Ball state of one robot in a frame, (6,)."""
    return _go_to_ball(frame, robot, _WITHOUT_GOAL)


def go_to_ball_to_shoot_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute that of one that is to shoot, (8,)."""
    return _go_to_ball(frame, robot, _WITH_GOAL)


def _go_to_ball(frame: Frame, robot: RobotState, size: int) -> FloatArray:
    row = np.empty(size)
    _go_to_ball_row(kinematics(robot), motion(frame), frame.field.half_length, row)
    return row


@compiled
def _go_to_ball_row(robot: Row, ball: Row, goal_x: float, row: FloatArray) -> None:
    me, rolling = robot_named(robot), ball_named(ball)
    _observe_go_to_ball(me, rolling, row[:_WITHOUT_GOAL].view(_GO_TO_BALL_FIELDS)[0])
    if len(row) > _WITHOUT_GOAL:
        _observe_goal(me, rolling, goal_x, row[_WITHOUT_GOAL:].view(_GOAL)[0])


def shoot_of(frame: Frame, robot: RobotState) -> FloatArray:
    """Compute the Shoot state of one robot in a frame, (10,)."""
    field, row = frame.field, np.empty(_SHOOT_SIZE)
    _shoot_row(kinematics(robot), motion(frame), field.half_length, field.goal_width / 2, row)
    return row


@compiled
def _shoot_row(robot: Row, ball: Row, goal_x: float, post_y: float, row: FloatArray) -> None:
    _observe_shoot(robot_named(robot), ball_named(ball), goal_x, post_y, row.view(_SHOOT_FIELDS)[0])
