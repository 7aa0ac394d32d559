"""``robobt bench shots``: measures how shots are learned from and judged."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import Json, Progress, print_json, say


def bench_shots(
    data: Annotated[
        Path | None, typer.Option("--data", help="Shots to learn from, as for 'robobt paper'.")
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
    from robobt.experiments.shot_sets import load_shot_sets
    from robobt.shots.bench import bench_cross_validation, bench_goal_line
    from robobt.shots.data.inputs import goals, shot_inputs

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
