"""Time saved by judging many shots and training many networks at once."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from pathlib import Path
from time import process_time
from typing import Annotated, NamedTuple

import numpy as np
import torch
import typer
from numpy.typing import NDArray

from robobt.cli import Json, Progress, print_json, say
from robobt.shots import (
    FOLDS,
    NetworkClassifier,
    goals,
    load_shot_sets,
    pair_features,
    shot_inputs,
    stratified_folds,
)
from robobt.skills import NNFiltered, goal_candidates
from robobt.skills.aim.raters.goal_line import obstacles
from robobt.skills.aim.raters.shot_predictor import shot_predictor
from robobt.world import DIVISION_B, BallState, FloatArray, Frame, RobotState
from robobt.world.features import SHOT, shot_features

OPPONENTS = 6
_ROUNDS = 30


class CrossValidationFigures(NamedTuple):
    """A cross-validation of a number of networks, all at once and one after the other [CPU s]."""

    cross_validation_s: float
    cross_validation_loop_s: float
    cross_validation_speedup: float
    networks: int


def bench_cross_validation(
    scenes: FloatArray,
    labels: NDArray[np.int64],
    networks: int = 100,
    progress: Callable[[], object] = lambda: None,
) -> CrossValidationFigures:
    """Time a tenfold cross-validation of the paper's network, all at once and one after the other.

    Both train the same networks, on one thread.

    ``scenes`` (n, 34) are of shots, and ``labels`` (n,) tell which of them scored; ``networks`` is how many
    of the folds to train, 100 being ten times ten. ``progress`` is called after every network of the loop.
    """
    torch.set_num_threads(1)
    inputs = pair_features(scenes) * [1.0, 1e3, 1e3, 1e3, 1e3]  # the paper's network sees millimetres
    folds = stratified_folds(labels, -(-networks // FOLDS))[:networks]
    sets = [(inputs[train], labels[train]) for train, _ in folds]
    begin = process_time()
    NetworkClassifier().fit_many(sets)
    at_once = process_time() - begin
    begin = process_time()
    for i, (x, y) in enumerate(sets):
        NetworkClassifier(random_state=i).fit(x, y)
        progress()
    looped = process_time() - begin
    return CrossValidationFigures(at_once, looped, looped / at_once, len(folds))


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


def bench_goal_line() -> GoalLineFigures:
    """Time the shipped network on all target points past six opponents, in one call and in single calls."""
    rng = np.random.default_rng(0)
    opponents = [
        RobotState(number, float(rng.uniform(2.5, 4.4)), float(rng.uniform(-1.0, 1.0)), pi)
        for number in range(OPPONENTS)
    ]
    me = RobotState(0, 1.9, 0.3)
    frame = Frame(0.0, DIVISION_B, BallState(2.0, 0.3), (me,), tuple(opponents))
    points = goal_candidates(frame.field)
    rater = NNFiltered()
    ask = shot_predictor(rater.model, SHOT).single()
    features = shot_features(np.array(me.position), points, obstacles(frame, me))
    rows = list(features.reshape(-1, SHOT.size).astype(np.float32))
    at_once = _median(lambda: rater.chances(frame, me, points), 10)
    looped = _median(lambda: [ask(row) for row in rows], 1)
    return GoalLineFigures(1e3 * at_once, 1e3 * looped, looped / at_once, len(points), OPPONENTS)


def _median(action: Callable[[], object], repeats: int) -> float:
    """Return the median over many rounds of the time that an action takes."""
    action()
    times = []
    for _ in range(_ROUNDS):
        begin = process_time()
        for _ in range(repeats):
            action()
        times.append((process_time() - begin) / repeats)
    return float(np.median(times))


def shots(
    data: Annotated[
        Path | None, typer.Option("--data", help="Shots to learn from, as for 'python -m paper table2'.")
    ] = None,
    networks: Annotated[
        int, typer.Option("--networks", min=1, max=1000, help="How many networks, 100 being 10 x 10 folds.")
    ] = 100,
    as_json: Json = False,
) -> None:
    """Measure a 10 x 10 cross-validation of the network, all at once and one after the other.

    On one thread; one after the other takes minutes. And judge the goal line
    (94 points, 6 opponents) with the shipped network in one call and in single calls.

    Keys of --json: goal_line_speedup, goal_line_ms and goal_line_loop_ms (processor
    time), points, opponents; cross_validation_speedup, cross_validation_s and
    cross_validation_loop_s (processor time), networks.
    """

    train = load_shot_sets(data).train
    with Progress("one after the other", networks) as progress:
        figures = bench_cross_validation(shot_inputs(train), goals(train), networks, progress.advance)
    line = bench_goal_line()
    if as_json:
        print_json({**line._asdict(), **figures._asdict()})
        return
    say(
        f"The goal line, {line.points} points and {line.opponents} opponents, in {line.goal_line_ms:.3f} ms "
        f"at once, {line.goal_line_loop_ms:.1f} ms one after the other: "
        f"{line.goal_line_speedup:.0f} times faster"
    )
    say(
        f"{figures.networks} networks in {figures.cross_validation_s:.2f} s at once, "
        f"{figures.cross_validation_loop_s:.1f} s one after the other: "
        f"{figures.cross_validation_speedup:.0f} times faster"
    )
