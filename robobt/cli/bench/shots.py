"""``robobt bench shots``: measures how shots are learned from and judged."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import Json, Progress, one_line_errors, print_json, say


def add_to(bench: typer.Typer) -> None:
    """Enter the command."""
    bench.command("shots")(bench_shots)


@one_line_errors
def bench_shots(
    data: Annotated[
        Path | None,
        typer.Option("--data", help="Shots to learn from, as for 'robobt paper'; by default made-up ones."),
    ] = None,
    networks: Annotated[
        int, typer.Option("--networks", min=1, max=1000, help="How many networks, 100 being 10 x 10 folds.")
    ] = 100,
    as_json: Json = False,
) -> None:
    """Measure a 10 x 10 cross-validation of the network, all at once and one after the other.

    One thread, the same data, first weights, order and early stopping; the plain
    loop takes minutes. And judge the goal line (94 points, 6 opponents) with the
    shipped network in one call and in a loop of single calls.

    Keys of --json: goal_line_speedup, goal_line_ms and goal_line_loop_ms (processor
    time), points, opponents; cross_validation_speedup, cross_validation_s and
    cross_validation_plain_s (processor time), accuracy and accuracy_plain (mean, in
    percent), networks.
    """
    from robobt.shots.bench import bench_cross_validation, made_up_shots
    from robobt.shots.bench_goal_line import bench_goal_line

    if data is None:
        inputs, labels = made_up_shots()
    else:
        from robobt.experiments.shot_sets import load_shot_sets
        from robobt.shots.data.author_data import author_inputs
        from robobt.shots.data.inputs import goals

        train = load_shot_sets(data).train
        inputs, labels = author_inputs(train), goals(train)
    with Progress("plain loop", networks) as progress:
        figures = bench_cross_validation(inputs, labels, networks, progress=progress.advance)
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
        f"{figures.cross_validation_plain_s:.1f} s one after the other: "
        f"{figures.cross_validation_speedup:.0f} times faster; mean accuracy "
        f"{figures.accuracy:.2f} and {figures.accuracy_plain:.2f} %"
    )
