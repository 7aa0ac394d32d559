"""``python -m paper table4``: get the ball and shoot, by hand-written and learned skills."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli import (
    Json,
    Page,
    Progress,
    Seed,
    Where,
    Workers,
    console,
    cores,
    make_folders,
    one_of,
    print_json,
    say,
    table,
    world_of,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from paper.table4_rows import PaperRow, Spread, Trial


_FEW = 100
"""This many runs take less time than the start of worker processes."""


@dataclass(frozen=True)
class Processes:
    """Where the runs are played, and by how many processes."""

    workers: Workers = None
    world: Where = "sim"

    def count(self, human: bool, few: bool) -> int:
        """Return how many processes play.

        Raises:
            typer.BadParameter: more are asked for than can play there.
        """
        from robobt.worlds import SIM

        alone = human or self.world != SIM
        if alone and self.workers not in (None, 1):
            here = "with a person at the robot" if human else "to play over the network"
            raise typer.BadParameter(f"must be 1 {here}", param_hint="--workers")
        return self.workers or (1 if alone or few else cores())


@dataclass(frozen=True)
class Setting:
    """Where and from where the runs are played."""

    preset: Annotated[
        str, typer.Option("--preset", "-p", help="The simulator's preset: also grsim, erforce, default, ...")
    ] = "robobulls"
    realism: Annotated[
        str | None,
        typer.Option("--realism", "-r", help="Noise and delays: none, friendly, rc2021 or realistic."),
    ] = None
    limits: Annotated[
        list[str] | None,
        typer.Option(
            "--limits",
            help="What every robot may do: paper (1.5 m/s, grSim's acceleration), pilot (1.5 m/s, "
            "2.5 m/s^2) or own (the preset's robots). May be given often; all by default.",
        ),
    ] = None
    starts: Annotated[
        str,
        typer.Option(
            "--starts",
            help="drawn: around the paper's, 0.1 m and 10 degrees for the robot, 0.05 m for the ball; "
            "paper: the paper's own in every run.",
        ),
    ] = "drawn"


def table4(
    runs: Annotated[
        int, typer.Option("--runs", "-n", min=1, max=100_000, help="Runs of each trial and combination.")
    ] = 25,
    seed: Seed = None,
    *,
    setting: Setting,
    only: Annotated[
        list[str] | None,
        typer.Option("--only", help="A combination by its name; may be given often. All by default."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FOLDER",
            help="Keep the runs here as they finish: the command, given again, goes on where it stopped.",
        ),
    ] = None,
    picture: Annotated[
        Path | None, typer.Option("--picture", help="Draw the times into this file (.png).")
    ] = None,
    human: Annotated[
        bool,
        typer.Option(
            "--human",
            help="Drive the robot yourself in the live page, by game controller, keyboard or touch: one more "
            "row; without --only no other, without --limits those of the paper.",
        ),
    ] = False,
    page: Page,
    processes: Processes,
    as_json: Json = False,
) -> None:
    """Table 4: get the ball and shoot, with hand-written and learned skills in every combination.

    Rows are named by who approaches and who shoots: "kick" is KickToTarget and "shoot"
    the hand-written Shoot; "quick" picks the ball up as fast as after a learned
    approach; learned parts are named by their algorithm. All robots of a table have the
    same limits, and run n of every row the same start. Approach and pick-up together are
    the paper's GoToBall; the approach counts until robot and ball are 0.2 m apart.

    The minimum is physical: a straight line with the strongest acceleration and without
    braking, until the ball is in the mouth, and until it is so in a robot that faces the
    goal. Goals have their 95 % Wilson interval, differences that of the mean paired
    difference; the effect is the mean difference over the differences' standard deviation.

    Keys of --json: runs, preset, realism, starts; paper, the printed rows by trial; and
    limits, by name and trial: minimum (to_ball, to_kick); rows, by combination: approach,
    pick_up, to_ball, shoot and total (n, mean, variance, low and high of the mean's 95 %
    interval), goals, reached and shots (count, rate, low, high), ball_ratio and kick_ratio
    (over the minimum), paper_start (to_ball, total, goal of one run from there);
    best_hand_written, which kicks first; to_ball and to_kick, the learned one against it
    (n, mean, low, high, effect), negative where the learned one is faster.
    """
    from paper.table4 import COMBINATIONS, TRIALS, Conditions
    from paper.table4 import table4 as run
    from paper.table4_picture import draw_table4
    from paper.table4_starts import LIMITS
    from robobt.engines import engine
    from robobt.sim import PRESETS, REALISM

    one_of([setting.preset], PRESETS, "--preset")
    one_of([] if setting.realism is None else [setting.realism], REALISM, "--realism")
    one_of(only or [], COMBINATIONS, "--only")
    one_of(setting.limits or [], LIMITS, "--limits")
    one_of([setting.starts], ("drawn", "paper"), "--starts")
    combinations, chosen = tuple(only or COMBINATIONS), tuple(setting.limits or LIMITS)
    if human:
        combinations, chosen = tuple(only or ()), tuple(setting.limits or ("paper",))
    total = (runs + 1) * (len(combinations) + human) * len(chosen) * len(TRIALS)
    workers = processes.count(human, total < _FEW and engine() is None)
    make_folders({"--out": out, "--picture": picture})
    with ExitStack() as stack:
        show = None
        if human:
            from paper.table4_human import HumanRuns
            from robobt.live import Live

            show = HumanRuns(Live(stack.enter_context(page.server())))
        factory = stack.enter_context(world_of(processes.world))
        progress = stack.enter_context(Progress("table 4", total))
        result = run(
            runs,
            seed,
            conditions=Conditions(
                setting.preset, setting.realism, chosen, "drawn" if setting.starts == "drawn" else "paper"
            ),
            combinations=combinations,
            progress=progress.advance,
            world=factory,
            out=out,
            human=show,
            workers=workers,
        )
    if picture is not None:
        draw_table4(result, picture)
    if as_json:
        print_json(result)
        return
    for trial in TRIALS:
        _print_paper(trial, result["paper"][trial])
        for name in chosen:
            _print_trial(
                f"Trial {trial}, limits: {name}; seconds, x the minimum", result["limits"][name][trial], runs
            )
    if picture is not None:
        say(f"Picture: {picture}")


def _print_paper(trial: str, rows: Mapping[str, PaperRow]) -> None:
    say(f"Trial {trial}, the paper, seconds")
    printed = table("", "to the ball", "shoot", "total", "goals")
    for name, row in rows.items():
        printed.add_row(
            name,
            _seconds(row["to_ball"], row["to_ball_s2"]),
            _seconds(row["shoot"], row["shoot_s2"]),
            _seconds(row["total"], row["total_s2"]),
            f"{row['goals']:.0f} of 25",
        )
    console.print(printed)


def _print_trial(title: str, found: Trial, runs: int) -> None:
    say(title)
    times = table("", "to the ball", "to the kick", "goals", "95 %", "paper's start")
    if found["minimum"] is not None:
        least = found["minimum"]
        times.add_row("minimum", _seconds(least["to_ball"]), _seconds(least["to_kick"]))
    for name, row in found["rows"].items():
        goals, beside = row["goals"], row["paper_start"]
        times.add_row(
            name,
            _against_minimum(row["to_ball"], row["ball_ratio"]),
            _against_minimum(row["total"], row["kick_ratio"]),
            f"{goals.count}/{runs}",
            goals.interval(),
            f"{_seconds(beside['to_ball'])}, {_seconds(beside['total'])}",
        )
    console.print(times)
    best = found["best_hand_written"]
    for place, difference in (("ball", found["to_ball"]), ("kick", found["to_kick"])):
        if difference is None:
            continue
        text = f"To the {place}, learned less {best}: {difference['mean']:+.3f} s"
        if difference["low"] is None:
            text += f", the same in all {difference['n']} runs."
        else:
            text += (
                f" ({difference['low']:+.3f} to {difference['high']:+.3f}), "
                f"effect {difference['effect']:+.1f} standard deviations, {difference['n']} pairs."
            )
        say(text)


def _against_minimum(part: Spread, ratio: float | None) -> str:
    return _seconds(part["mean"]) + ("" if ratio is None else f" x{ratio:.3f}")


def _seconds(mean: float | None, variance: float | None = None) -> str:
    if mean is None:
        return "-"
    return f"{mean:.3f}" + ("" if variance is None else f" ({variance:.4f})")
