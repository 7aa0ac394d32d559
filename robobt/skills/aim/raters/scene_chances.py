"""What a predictor of a shot's scene says of every target point, past each kind of goalkeeper."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch, SeenShot
from robobt.skills.aim.raters.goal_line import directions
from robobt.skills.aim.raters.shot_predictor import shot_predictor
from robobt.world.features import SCENE_OPPONENTS, SHOT_SCENE, shot_scene
from robobt.world.geometry import FloatArray, Point, distance
from robobt.world.records import BALL, BALL_SIZE, ROBOT, ROBOT_SIZE
from robobt.world.state import RobotState

_HELD_BALL_DISTANCE = 0.13
"""A ball closer to the robot's centre than this turns with the robot [m]."""


def goalkeeper_kinds(model: str) -> tuple[str, ...]:
    """Return the kinds of goalkeepers that a predictor of a shot's scene tells apart, its outputs' names."""
    return tuple([output.name for output in shot_predictor(model, SHOT_SCENE).card.outputs])


def chances_by_kind(
    model: str, origin: Point, me: RobotState, points: FloatArray, ahead: Sequence[RobotState]
) -> FloatArray:
    """Predict the probability of a goal at every target point, past each kind of goalkeeper.

    More robots than a scene holds are judged in groups. The shooter is assumed to point at each target
    already with the ball in front of it, because the predictor was fitted to scenes at the moment of the
    kick.

    Args:
        model: predictor of a shot's scene: a shipped model or a file.
        origin: where the ball is [m].
        me: the shooter.
        points: target points (T, 2) [m].
        ahead: the robots ahead of the shooter, at least one.

    Returns:
        (T, K) for the K of :func:`goalkeeper_kinds`.
    """
    gap = distance(me.position, origin)
    shooter = np.full((len(points), ROBOT_SIZE), (me.x, me.y, 0.0, me.vx, me.vy, 0.0), dtype=np.float64)
    ball = np.full((len(points), BALL_SIZE), (*origin, me.vx, me.vy), dtype=np.float64)
    heading = shooter.view(ROBOT)["heading"][:, 0]
    heading[:] = directions(me.position, points)
    if gap < _HELD_BALL_DISTANCE:
        held = ball.view(BALL)[:, 0]
        held["x"], held["y"] = me.x + gap * np.cos(heading), me.y + gap * np.sin(heading)
    rows = np.array([(r.x, r.y, r.heading, r.vx, r.vy, r.omega) for r in ahead], dtype=np.float64)
    scenes = [
        shot_scene(shooter, ball, points, np.tile(rows[begin : begin + SCENE_OPPONENTS], (len(points), 1, 1)))
        for begin in range(0, len(rows), SCENE_OPPONENTS)
    ]
    answers = shot_predictor(model, SHOT_SCENE)(np.concatenate(scenes))
    predicted: FloatArray = answers.reshape(len(scenes), len(points), -1).min(axis=0)
    return predicted


def kind_weights(model: str, goalkeeper: str, watch: GoalkeeperWatch | None) -> FloatArray:
    """Return how likely the opponents' goalkeeper is of each kind that a predictor tells apart, (K,).

    Args:
        model: predictor of a shot's scene: a shipped model or a file.
        goalkeeper: the kind, where it is known; else empty.
        watch: what the match so far says; without it all kinds are equally likely.
    """
    kinds = goalkeeper_kinds(model)
    if goalkeeper:
        return np.array([kind == goalkeeper for kind in kinds], dtype=np.float64)
    if watch is None or len(kinds) == 1:
        return np.full(len(kinds), 1.0 / len(kinds))

    def chances(shot: SeenShot) -> FloatArray:
        frame, me = shot.frame, shot.shooter
        ahead = [robot for robot in frame.others(me.id) if robot.x >= me.x]
        if not ahead:
            return np.ones(len(kinds))
        point = np.array([[frame.field.half_length, shot.y]])
        row: FloatArray = chances_by_kind(model, frame.ball.position, me, point, ahead)[0]
        return row

    return watch.weights(model, kinds, chances)
