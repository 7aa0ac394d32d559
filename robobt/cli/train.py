"""``robobt train`` and ``robobt demonstrations``: learn skills, and record what hand-written ones do."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import (
    MAX_SEED,
    Json,
    Progress,
    Workers,
    console,
    cores,
    errors,
    parse_assignments,
    print_json,
    say,
    table,
)
from robobt.cli.live import Page
from robobt.cli.outputs import make_folders

if TYPE_CHECKING:
    from rich.live import Live
    from rich.table import Table

    from robobt.learning.training.progress import Progress as Standing
    from robobt.learning.training.results import TrainResult
    from robobt.learning.training.settings import TrainSettings

Task = Annotated[
    str,
    typer.Argument(help="What to learn: go_to_ball, shoot, duel, ..., or my_task.py:MyTask."),
]
Changes = Annotated[
    list[str] | None, typer.Option("--set", help="Change a setting, as agent.n_step=5; may be given again.")
]


@dataclass(frozen=True)
class Seeds:
    """Which seeds are trained."""

    seeds: Annotated[
        int, typer.Option("--seeds", "-n", min=1, max=1000, help="How many seeds, side by side.")
    ] = 1
    seed: Annotated[
        int | None,
        typer.Option("--seed", "-s", min=0, max=MAX_SEED, help="The first seed; by default the settings'."),
    ] = None

    def of(self, settings: TrainSettings) -> range:
        """Return them; the settings' own is the first unless another one is given."""
        first = settings.seed if self.seed is None else self.seed
        return range(first, first + self.seeds)


def train(
    task: Task,
    preset: Annotated[
        str, typer.Option("--preset", "-p", help="Settings to start from: a preset's name or a YAML file.")
    ] = "fast",
    *,
    seeds: Seeds,
    changes: Changes = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="The run's folder; by default runs/TASK-PRESET.")
    ] = None,
    workers: Workers = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with a run that was cut off.")] = False,
    live: Annotated[
        bool,
        typer.Option(
            "--live", help="Show each evaluation's policy in the browser; training waits meanwhile."
        ),
    ] = False,
    page: Page,
    as_json: Json = False,
) -> None:
    """Train a skill, and judge it on starts that training and choosing never saw.

    In the folder of each seed (out/seed_N): settings.yaml, log.jsonl, curves.png,
    result.json, actor.pt (the best weights, by success and then time) and
    TensorBoard events; beside them result.json and curves.png of all seeds.

    Keys of --json: runs (every seed's result.json and its folder) and together
    (task, preset, seeds, best_seed; to_99 and to_bar, the CPU seconds and
    environment steps to 99 % and to what counts as learned; success, mean_time,
    time_ratio, steps, cpu_s, evaluation_cpu_s and wall_s with median, low, high).
    """
    from robobt.learning.training.results import figures_of
    from robobt.learning.training.seeds import train_seeds

    settings = _settings(task, preset, changes or [])
    folder = out or Path("runs") / f"{task.rpartition(':')[2]}-{Path(preset).stem}"
    make_folders({"--out": folder}, folders=True)
    chosen = seeds.of(settings)
    if live and (len(chosen) > 1 or workers not in (None, 1)):
        raise typer.BadParameter("takes one seed and one worker", param_hint="--live")
    with ExitStack() as stack:
        problem = None
        if live:
            from robobt.learning.training.watched import watched_problem

            problem = partial(watched_problem, stack.enter_context(page.server()))
        standings = stack.enter_context(_LiveTable(settings.task))
        try:
            results = train_seeds(
                settings,
                chosen,
                folder,
                workers or min(cores(), len(chosen)),
                resume,
                standings.show,
                problem,
            )
        except KeyboardInterrupt:
            kept = any(folder.rglob("checkpoint*")) or any(folder.rglob("result.json"))
            told = (
                f"--resume goes on with what is in {folder}" if kept else "nothing is written to go on from"
            )
            errors.print(f"stopped; {escape(told)}", soft_wrap=True)
            raise typer.Exit(130) from None
    if as_json:
        print_json(figures_of(results))
        return
    console.print(_results(results))
    say(f"In {folder}.")


def _settings(task: str, preset: str, changes: list[str]) -> TrainSettings:
    """Load settings; what --set changes is not blamed on the preset's file."""
    from robobt.learning.training.settings import SettingsError, load_settings

    given = parse_assignments(changes, "--set")
    try:
        return load_settings(task, preset, given)
    except SettingsError as error:
        for name in given:
            if f"{error.field}.".startswith(f"{name}.") or f"{name}.".startswith(f"{error.field}."):
                raise SettingsError("--set", error.problem, error.field) from error
        raise


def demonstrations(
    task: Task,
    out: Annotated[Path, typer.Option("--out", "-o", help="The Parquet file to write.")],
    episodes: Annotated[int, typer.Option("--episodes", "-n", min=1, max=100_000, help="How many.")] = 200,
    by: Annotated[
        str, typer.Option("--by", help="Who plays: skill (the hand-written one) or script (the simplest).")
    ] = "skill",
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED, help="Of starts and noise.")] = 0,
    changes: Annotated[
        list[str] | None,
        typer.Option("--set", help="Change the environment, as simulator=robobulls; may be given again."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Record a hand-written skill playing a task, for replay buffers to begin with.

    Keys of --json: task, file, episodes, steps, success (share), mean_time (seconds).
    """
    from robobt.learning.training.demonstrations import record
    from robobt.learning.training.settings import load_settings
    from robobt.learning.training.teachers import TEACHERS

    if by not in TEACHERS:
        raise typer.BadParameter(f"must be {' or '.join(TEACHERS)}, not {by!r}", param_hint="--by")
    given = {
        f"environment.{name}": value for name, value in parse_assignments(changes or [], "--set").items()
    }
    environment = load_settings(task, "fast", given).environment
    make_folders({"--out": out})
    with Progress(f"recording {task}", episodes) as progress:
        recorded = record(environment, episodes, by, seed, lambda _: progress.advance())
    recorded.write(out)
    figures = {
        "task": task,
        "file": str(out),
        "episodes": recorded.episodes,
        "steps": len(recorded),
        "success": float(recorded.success.sum()) / recorded.episodes,
        "mean_time": len(recorded) / recorded.episodes * environment.period,
    }
    if as_json:
        print_json(figures)
        return
    say(
        f"{recorded.episodes} episodes, {len(recorded)} steps, {figures['success']:.1%} successes, "
        f"{figures['mean_time']:.2f} s each, in {out}."
    )


class _LiveTable:
    """A line a seed on stderr, kept up to date; nothing where stderr is no terminal."""

    def __init__(self, title: str) -> None:
        from rich.live import Live

        self._title = title
        self._standing: dict[int, Standing] = {}
        self._live: Live = Live(self._table(), console=errors, auto_refresh=False, transient=True)

    def __enter__(self) -> _LiveTable:
        if errors.is_terminal:
            self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._live.stop()

    def show(self, standing: Standing) -> None:
        """Update the line of a seed."""
        self._standing[standing.seed] = standing
        if errors.is_terminal:
            self._live.update(self._table(), refresh=True)

    def _table(self) -> Table:
        shown = table(self._title, "steps", "success", "time", "best", "CPU s", "time left")
        for seed, now in sorted(self._standing.items()):
            latest, best = now.latest, now.best
            shown.add_row(
                f"seed {seed}",
                f"{now.steps:,} of {now.of:,}",
                "-" if latest is None else f"{latest.success:.1%}",
                "-" if latest is None else _time(latest.mean_time, latest.time_ratio),
                "-" if best is None else f"{best.success:.1%} {_time(best.mean_time, best.time_ratio)}",
                f"{now.cpu_s:.0f}",
                "-" if latest is None else f"{int(now.left_s) // 60}:{int(now.left_s) % 60:02}",
            )
        return shown


def _results(results: list[TrainResult]) -> Table:
    shown = table("seed", "held-out success", "95 % interval", "time (x optimum)", "steps", "CPU s", "wall s")
    for result in results:
        figures = result.figures
        held = figures["held_out"]
        shown.add_row(
            str(figures["seed"]),
            f"{held['successes']} of {held['starts']} ({held['success']:.1%})",
            f"{held['low']:.1%} to {held['high']:.1%}",
            _time(held["mean_time"], held["time_ratio"]),
            f"{figures['steps']:,}",
            f"{figures['cpu_s']:.1f}",
            f"{figures['wall_s']:.1f}",
        )
    return shown


def _time(mean: float | None, ratio: float | None) -> str:
    if mean is None:
        return "-"
    return f"{mean:.2f} s" + ("" if ratio is None else f" (x{ratio:.3f})")
