"""``robobt evaluate``: what learned policies achieve, on fresh starts or against each other."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import (
    MAX_SEED,
    Imports,
    Json,
    console,
    errors,
    import_files,
    name_lines,
    print_json,
    table,
)
from robobt.cli.option_groups.scenario import parse_play
from robobt.cli.options import option

if TYPE_CHECKING:
    from robobt.learning.training.results import Evaluation


@dataclass(frozen=True)
class RoundRobin:
    """Who else takes part where policies meet each other."""

    round_robin: Annotated[
        bool,
        option("--round-robin", ", where two teams learn; so do --past, --script and --play"),
    ] = False
    past: Annotated[int | None, option("--past", ", spread over the run; by default 5", min=0, max=64)] = None
    scripts: Annotated[
        list[str] | None, option("--script", "; by default attack and press, without a play none")
    ] = None
    plays: Annotated[list[str] | None, option("--play", "; its robots move slowly")] = None


def evaluate(
    runs: Annotated[
        list[str],
        typer.Argument(help="Folders of training runs, or models by name or file, all of one task."),
    ],
    starts: Annotated[int, option("--starts", min=1, max=100_000)] = 1000,
    seed: Annotated[int, option("--seed", " of the starts", min=0, max=MAX_SEED)] = 0,
    *,
    meeting: RoundRobin,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Judge policies on fresh starts of their task, beside its hand-written skill and simplest script.

    All play the same starts in the environment of the first. With --round-robin, for tasks in which two teams
    learn, the policies of runs, past and best, scripts and plays meet each other on either side; a goal wins
    an episode, one without is a draw. Ratings are Bradley-Terry's on the Elo scale, 0 their mean.

    Keys of --json: task, starts, seed; results, by name: successes, success (share), low and high (95 %
    Wilson), mean_time (seconds), time_ratio (to the shortest possible time) and mean_return. With
    --round-robin instead of results: ratings (by name: elo, low and high of its 95 % interval, won, drawn,
    lost) and encounters (first, second, starts, won, drawn, lost).
    """
    import_files(imports)
    several = list(dict.fromkeys(runs))
    if meeting.round_robin or meeting.scripts or meeting.plays or meeting.past is not None:
        _meet([Path(run) for run in several], meeting, starts, seed, as_json=as_json)
        return
    from robobt.learning.agents.networks import one_thread
    from robobt.learning.envs import make_task
    from robobt.learning.training.fresh_starts import judge, trained_policy

    with one_thread(), errors.status("playing"):
        found = {run: trained_policy(run) for run in several}
        environment = found[several[0]][0]
        task = make_task(environment, 1).name
        for run, (other, _) in found.items():
            if (name := make_task(other, 1).name) != task:
                there = f"{run} is of the task {name}, {several[0]} of {task}; judge one task at a time"
                raise typer.BadParameter(there, param_hint="RUNS")
        results = judge(environment, {run: policy for run, (_, policy) in found.items()}, starts, seed)
    if as_json:
        figures = {name: _figures(one) for name, one in results.items()}
        print_json(
            {"task": make_task(environment, 1).name, "starts": starts, "seed": seed, "results": figures}
        )
        return
    shown = table("", "successes", "95 %", "mean time", "x optimum", "mean return")
    for name, one in results.items():
        shown.add_row(
            escape(name),
            f"{one.success.sum()} of {starts} ({one.rate:.1%})",
            f"{one.interval.low:.1%} to {one.interval.high:.1%}",
            "-" if one.mean_time is None else f"{one.mean_time:.2f} s",
            "-" if one.time_ratio is None else f"x{one.time_ratio:.3f}",
            f"{one.returns.mean():.3g}",
        )
    console.print(shown)


def _figures(one: Evaluation) -> dict[str, object]:
    return {
        "successes": int(one.success.sum()),
        "success": one.rate,
        "low": one.interval.low,
        "high": one.interval.high,
        "mean_time": one.mean_time,
        "time_ratio": one.time_ratio,
        "mean_return": float(one.returns.mean()),
    }


def _meet(runs: list[Path], meeting: RoundRobin, starts: int, seed: int, *, as_json: bool) -> None:
    """Let the policies of runs, scripts and plays meet in a round robin, and rate them."""
    from robobt.learning.agents.networks import one_thread
    from robobt.learning.training.meetings import contenders_of, encounters, play, script
    from robobt.learning.training.run_folder import read_settings
    from robobt.tournament.ratings import bradley_terry

    # Who is given twice would meet itself.
    default = () if meeting.plays else ("attack", "press")
    given = [script(role) for role in dict.fromkeys(meeting.scripts or default)]
    given += [play(text, *parse_play(text, "--play")) for text in dict.fromkeys(meeting.plays or ())]
    found = [
        contenders_of(run, 5 if meeting.past is None else meeting.past, str(run) if len(runs) > 1 else "")
        for run in runs
    ]
    contenders = [*(one for _, policies in found for one in policies), *given]
    with one_thread():
        met = encounters(found[0][0], contenders, starts, seed)
    scores = [(one.first, one.second, score) for one in met for score in one.scores]
    ratings = bradley_terry([one.name for one in contenders], scores)
    counts = {name: [0, 0, 0] for name in ratings}
    for one in met:
        for name, own in (
            (one.first, (one.won, one.drawn, one.lost)),
            (one.second, (one.lost, one.drawn, one.won)),
        ):
            counts[name] = [sum(both) for both in zip(counts[name], own, strict=True)]
    best = sorted(ratings, key=lambda name: -ratings[name].elo)
    if as_json:
        print_json(
            {
                "task": read_settings(runs[0]).task,
                "starts": starts,
                "seed": seed,
                "ratings": {
                    name: asdict(ratings[name])
                    | dict(zip(("won", "drawn", "lost"), counts[name], strict=True))
                    for name in best
                },
                "encounters": [asdict(one) for one in met],
            }
        )
        return
    shown = table("", "Elo", "95 %", "won", "drawn", "lost")
    for name in best:
        rating = ratings[name]
        interval = f"{round(rating.low):+d} to {round(rating.high):+d}"
        shown.add_row(name_lines(name, 42), f"{round(rating.elo):+d}", interval, *map(str, counts[name]))
    console.print(shown)
