"""``robobt paper table4``: get the ball and shoot, by hand-written and learned skills."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import Json, Progress, Seed, Where, console, print_json, say, table, world_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robobt.experiments.table4_rows import Spread, Trial


def table4(
    runs: Annotated[
        int, typer.Option("--runs", "-n", min=1, max=100_000, help="Runs of each trial and combination.")
    ] = 25,
    seed: Seed = None,
    preset: Annotated[
        str, typer.Option("--preset", "-p", help="The simulator's preset: also grsim, erforce, default, ...")
    ] = "robobulls",
    realism: Annotated[
        str | None,
        typer.Option("--realism", "-r", help="Noise and delays: none, friendly, rc2021 or realistic."),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option("--only", help="A combination by its name; may be given often. All by default."),
    ] = None,
    picture: Annotated[
        Path | None, typer.Option("--picture", help="Draw the times into this file (.png).")
    ] = None,
    world: Where = "sim",
    as_json: Json = False,
) -> None:
    """Table 4: get the ball and shoot, with hand-written and learned skills in every combination.

    Rows are named by who approaches and who shoots: "kick" is KickToTarget and "shoot"
    the hand-written Shoot; "quick" picks the ball up as fast as after a learned
    approach. Times are means, with the variance in brackets.

    Approach and pick-up together are the paper's GoToBall. The approach counts until
    robot and ball are 0.2 m apart; "x best" is its mean over the time of a straight
    line at the speed and acceleration that it may use. Goals of ours have their 95 %
    Wilson interval.

    Keys of --json: runs, preset, realism and trials, by trial: paper, its rows; rows, by
    combination: approach, pick_up, to_ball, shoot and total (n, mean, variance, low and
    high of the mean's 95 % interval), goals, reached and shots (count, rate, low, high),
    optimum, optimum_ratio; best_hand_written, the combination without learned parts that
    is first at the ball; test, the learned one against it (mean difference, variance, t,
    degrees, p, n), negative where the learned one is faster.
    """
    from robobt.experiments.table4 import COMBINATIONS, TRIALS
    from robobt.experiments.table4 import table4 as run
    from robobt.experiments.table4_picture import draw_table4
    from robobt.sim.settings import PRESETS, REALISM

    _check([preset], PRESETS, "--preset")
    _check([] if realism is None else [realism], REALISM, "--realism")
    _check(only or [], COMBINATIONS, "--only")
    combinations = tuple(only or COMBINATIONS)
    with Progress("table 4", runs * len(combinations) * len(TRIALS)) as progress, world_of(world) as factory:
        result = run(
            runs,
            seed,
            preset=preset,
            realism=realism,
            combinations=combinations,
            progress=progress.advance,
            world=factory,
        )
    if picture is not None:
        draw_table4(result, picture)
    if as_json:
        print_json(result)
        return
    for trial, found in result["trials"].items():
        _print_trial(trial, found, runs)
    if picture is not None:
        say(f"Picture: {picture}")


def _check(given: Iterable[str], known: Iterable[str], option: str) -> None:
    known = list(known)
    for name in given:
        if name not in known:
            there = ", ".join([repr(one) for one in known])
            raise typer.BadParameter(f"must be one of {there}, not {name!r}", param_hint=option)


def _print_trial(trial: str, found: Trial, runs: int) -> None:
    times = table(f"trial {trial}, seconds", "to the ball", "shoot", "total", "goals")
    for name, paper in found["paper"].items():
        times.add_row(
            f"paper: {name}",
            _seconds(paper["to_ball"], paper["to_ball_s2"]),
            _seconds(paper["shoot"], paper["shoot_s2"]),
            _seconds(paper["total"], paper["total_s2"]),
            f"{paper['goals']:.0f} of 25",
        )
    for name, row in found["rows"].items():
        figures = [_spread(part) for part in (row["to_ball"], row["shoot"], row["total"])]
        times.add_row(name, *figures, f"{row['goals']['count']} of {runs}")
    console.print(times)
    parts = table(f"trial {trial}, seconds", "approach", "x best", "pick-up", "reached", "goals, %")
    for name, row in found["rows"].items():
        ratio, goals = row["optimum_ratio"], row["goals"]
        parts.add_row(
            name,
            _spread(row["approach"]),
            "-" if ratio is None else f"{ratio:.3f}",
            _spread(row["pick_up"]),
            f"{row['reached']['count']} of {runs}",
            f"{100 * goals['low']:.1f} to {100 * goals['high']:.1f}",
        )
    console.print(parts)
    test = found["test"]
    if test is not None:
        say(
            f"The learned skills are {abs(test['mean']):.3f} s {'sooner' if test['mean'] < 0 else 'later'} "
            f"at the ball than our best hand-written ones ({found['best_hand_written']}): "
            f"paired t = {test['t']:.1f}, p = {test['p']:.2g}, n = {test['n']}."
        )


def _spread(part: Spread) -> str:
    return _seconds(part["mean"], part["variance"])


def _seconds(mean: float | None, variance: float | None) -> str:
    if mean is None:
        return "-"
    return f"{mean:.3f}" + ("" if variance is None else f" ({variance:.4f})")
