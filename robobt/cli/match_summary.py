"""What ``robobt match`` prints about the trials of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import typer
from rich.markup import escape
from rich.table import Table

from robobt.cli.common import console, errors, say, table, warn
from robobt.cli.team_figures import team_figures
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.match import Run, Summary
    from robobt.match.results.results import Spread

TREES_FAILED = 3
"""The exit status of a run that was played to its end although a robot's tree failed."""

_FEW = 10
"""With fewer different trials than this, a warning says how little they show."""


def print_summary(summary: Summary, run: Run, requested: int) -> None:
    """Print what a run's trials came to."""
    played = counted(summary.trials, "trial")
    stopped = f" of {requested} (stopped)" if run.interrupted else ""
    console.print(f"[bold]{escape(summary.scenario)}[/bold]: {played}{stopped}, seed {summary.seed}")
    listed = table("outcome", "trials", "rate", "95 % interval")
    for outcome, rate in summary.outcomes.items():
        listed.add_row(
            outcome.replace("_", " "),
            str(rate.count),
            f"{rate.rate:.1%}",
            rate.interval(1),
        )
    console.print(listed)
    if 1 < summary.distinct < _FEW or summary.trials == 1:
        one = "One trial says" if summary.trials == 1 else f"{counted(summary.distinct, 'trial')} say"
        say(f"{one} little about how often something happens; --trials 100 narrows the intervals.")
    if summary.distinct < summary.trials:
        warn(
            f"only {summary.distinct} of {counted(summary.trials, 'trial')} differ; "
            "vary the starts or add noise, as with --set simulator.realism=friendly"
        )
    console.print(_teams(summary) if summary.teams else _times(summary))
    pace = summary.real_time_factor
    goals = ", ".join([f"{team} {count.total}" for team, count in summary.goals.items()])
    say(
        f"Goals: {goals}. Mean time {summary.time.mean:.1f} s, ball in play {summary.in_play:.0%} of it. "
        f"By wall clock {pace:.{0 if pace >= 10.0 else 1}f} times faster than real time in each process. "
        f"Trace {summary.trace}."
    )


def tell_failed(first: str) -> NoReturn:
    """Tell on stderr of the first failure of a tree, and end with the exit status for that."""
    warn(f"trees failed, so the exit status is {TREES_FAILED}; the first: {' '.join(first.split())}")
    raise typer.Exit(TREES_FAILED)


def tell_failures(summary: Summary, on_error: str) -> bool:
    """Tell on stderr which robots' trees failed, and return whether there were any."""
    failed = {name: robot for name, robot in summary.robots.items() if robot.errors}
    for name, robot in failed.items():
        first = " ".join(str(robot.first_error).split())
        errors.print(
            f"[red]{name}: its tree failed in {counted(robot.errors, 'tick')}[/red]; "
            f"the first: {escape(first)}",
            soft_wrap=True,
        )
    for name, robot in summary.robots.items():
        if robot.always_failed and name not in failed:
            warn(f"{name} did nothing: its tree failed in every tick; {robot.always_failed}")
    if failed:
        ending = "" if on_error == "raise" else "; --on-error raise ends the run at the first failure"
        warn(f"trees failed, so the exit status is {TREES_FAILED}{ending}")
    return bool(failed)


def _times(summary: Summary) -> Table:
    listed = table("robot", "to the ball, s", "ball to kick, s", "to the kick, s", "kicks")
    for name, robot in summary.robots.items():
        if robot.go_to_ball.n:
            spreads = [robot.go_to_ball, robot.shoot, robot.total]
            kicks = robot.kicks.mean or 0.0
            listed.add_row(name, *[_spread_text(spread) for spread in spreads], f"{kicks:.1f}")
    return listed


def _teams(summary: Summary) -> Table:
    means = {
        name: {figure: spread.mean or 0.0 for figure, spread in team.items()}
        for name, team in summary.teams.items()
    }
    listed = team_figures(means, "a trial")
    scored = [f"{count.trials.rate:.0%} ({count.trials.interval()})" for count in summary.goals.values()]
    listed.add_row("trials with a goal", *scored)
    return listed


def _spread_text(spread: Spread) -> str:
    if spread.mean is None:
        return "-"
    return f"{spread.mean:.3f}" + ("" if spread.variance is None else f" (var. {spread.variance:.4f})")
