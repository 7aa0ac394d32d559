"""What judging the goal line in one call saves."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from time import process_time
from typing import NamedTuple

import numpy as np

from robobt.skills.aim.raters.goal_line import goal_candidates, obstacles
from robobt.skills.aim.raters.nn_filtered import NNFiltered
from robobt.skills.aim.raters.shot_predictor import shot_predictor
from robobt.world.features import SHOT, shot_features
from robobt.world.field import DIVISION_B
from robobt.world.state import BallState, Frame, RobotState

OPPONENTS = 6


class GoalLineFigures(NamedTuple):
    """The goal line judged for all opponents [ms, of the processor].

    Attributes:
        goal_line_ms: by the rater, features included, in one call.
        goal_line_loop_ms: the same model asked about one target point and opponent after the
            other; features not included.
        goal_line_speedup: the one over the other.
        points: target points on the goal line.
        opponents: between the shooter and the goal.
    """

    goal_line_ms: float
    goal_line_loop_ms: float
    goal_line_speedup: float
    points: int
    opponents: int


def bench_goal_line(model: str = "shot_nn", rounds: int = 30) -> GoalLineFigures:
    """Judge all target points past six opponents, in one call and in a loop of single calls.

    Args:
        model: predictor of the ``nn_filtered`` rater.
        rounds: how often each is measured; the median counts.
    """
    frame = _scene()
    me, points = frame.own[0], goal_candidates(frame.field)
    rater = NNFiltered(model=model)
    ask = shot_predictor(model, SHOT).single()
    features = shot_features(np.array(me.position), points, obstacles(frame, me))
    rows = list(features.reshape(-1, SHOT.size).astype(np.float32))
    at_once = _median(lambda: rater.chances(frame, me, points), rounds, 10)
    looped = _median(lambda: [ask(row) for row in rows], rounds, 1)
    return GoalLineFigures(1e3 * at_once, 1e3 * looped, looped / at_once, len(points), OPPONENTS)


def _scene() -> Frame:
    rng = np.random.default_rng(0)
    opponents = [
        RobotState(number, float(rng.uniform(2.5, 4.4)), float(rng.uniform(-1.0, 1.0)), pi)
        for number in range(OPPONENTS)
    ]
    me = RobotState(0, 1.9, 0.3)
    return Frame(0.0, DIVISION_B, BallState(2.0, 0.3), (me,), tuple(opponents))


def _median(what: Callable[[], object], rounds: int, repeats: int) -> float:
    what()
    times = []
    for _ in range(rounds):
        begin = process_time()
        for _ in range(repeats):
            what()
        times.append((process_time() - begin) / repeats)
    return float(np.median(times))
