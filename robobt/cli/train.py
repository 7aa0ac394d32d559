"""``robobt train``: learn a skill."""

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
    Imports,
    Json,
    Workers,
    console,
    cores,
    errors,
    import_files,
    parse_assignments,
    print_json,
    say,
    table,
)
from robobt.cli.option_groups.page import Page
from robobt.cli.options import option
from robobt.cli.outputs import make_folders

if TYPE_CHECKING:
    from rich.live import Live
    from rich.table import Table

    from robobt.learning.training.progress import TrainingProgress as Standing
    from robobt.learning.training.results import TrainResult
    from robobt.learning.training.settings import TrainSettings

Task = Annotated[
    str,
    typer.Argument(help="What to learn: go_to_ball, shoot, duel, ..., or my_task.py:MyTask."),
]
Changes = Annotated[list[str] | None, option("--set", ", as in agent.n_step=5")]


@dataclass(frozen=True)
class Seeds:
    """Which seeds are trained."""

    seeds: Annotated[int, option("--seeds", ", side by side", min=1, max=1000)] = 1
    seed: Annotated[
        int | None, option("--seed", ", the first of several; by default the settings'", min=0, max=MAX_SEED)
    ] = None

    def of(self, settings: TrainSettings) -> range:
        """Return them; the settings' own is the first unless another one is given."""
        first = settings.seed if self.seed is None else self.seed
        return range(first, first + self.seeds)


def train(
    task: Task,
    preset: Annotated[str, option("--preset")] = "fast",
    *,
    seeds: Seeds,
    changes: Changes = None,
    out: Annotated[
        Path | None, option("--out", " the run; by default in runs/TASK-PRESET", metavar="FOLDER")
    ] = None,
    workers: Workers = None,
    resume: Annotated[bool, option("--resume")] = False,
    live: Annotated[
        bool, option("--live", ": the policy of each evaluation; training waits meanwhile")
    ] = False,
    page: Page,
    imports: Imports = None,
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
    from robobt.learning.training.train import train_seeds

    page.check(live)
    import_files(imports)
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
