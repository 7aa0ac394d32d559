"""A comparison of the fast preset, single changes to it, and the paper's setting, on one budget of steps."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from robobt.cli import Json, console, make_folders, print_json, table
from robobt.cli.common import errors, parse_assignments
from robobt.config.atomic import write_atomically
from robobt.config.errors import unknown_name
from robobt.config.yaml import read_yaml
from robobt.learning import TrainSettings, load_settings
from robobt.learning.training.progress import OnProgress
from robobt.learning.training.results import SeedSpread, SeedSummary, summary_of
from robobt.learning.training.settings import SettingsError
from robobt.learning.training.train import train_seeds

SWITCHES = Path(__file__).parent / "switches.yaml"
"""The changes to the fast preset that are compared."""

PAPER = "paper"
"""The name of the plain Spinning Up setting in a comparison."""


def variants(task: str, changes: Mapping[str, object] | None = None) -> dict[str, TrainSettings]:
    """Return settings by name: the fast preset, variants with one switch changed, and the paper's.

    All but the paper's have the fast preset's budget of steps and stop when its bar is met.

    ``changes`` apply to all of them, by dotted name.
    """
    switches = read_yaml(SWITCHES).get(task)
    if switches is None:
        raise SettingsError(str(SWITCHES), f"has no switches of {task!r}")
    found = {name: load_settings(task, "fast", {**own, **(changes or {})}) for name, own in switches.items()}
    paper = {key: value for key, value in (changes or {}).items() if not key.startswith("collection.")}
    return {**found, PAPER: load_settings(task, "paper", paper)}


def compare(
    task: str,
    out: str | Path,
    seeds: Sequence[int],
    only: Sequence[str] = (),
    changes: Mapping[str, object] | None = None,
    workers: int = 1,
    on_variant: Callable[[str], None] | None = None,
    on_progress: OnProgress | None = None,
) -> dict[str, SeedSummary]:
    """Train every variant with every seed; finished runs in ``out`` are kept, unfinished ones resumed.

    ``comparison.json`` and ``comparison.md`` are rewritten after each variant.

    Args:
        task: what is learned.
        out: a folder; each variant gets one in it.
        seeds: of each variant.
        only: names of variants; all if empty.
        changes: to every variant's settings, by dotted name.
        workers: processes.
        on_variant: called with the name of the next variant.
        on_progress: see :func:`robobt.learning.training.train.train_seeds`.

    Returns:
        :func:`~robobt.learning.training.results.summary_of` the seeds, by name.

    Raises:
        SettingsError: an unknown name.
    """
    out = Path(out)
    found = variants(task, changes)
    for name in only:
        if name not in found:
            raise SettingsError("", f"no variant is called {name!r}; {unknown_name(name, found)}")
    summaries: dict[str, SeedSummary] = {}
    for name, settings in found.items():
        if only and name not in only:
            continue
        if on_variant is not None:
            on_variant(name)
        folder = out / re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
        results = train_seeds(settings, seeds, folder, workers, True, on_progress)
        summaries[name] = summary_of(results)
        text = json.dumps({"task": task, "variants": summaries}, indent=2, allow_nan=False) + "\n"
        write_atomically(out / "comparison.json", text)
        write_atomically(out / "comparison.md", table_of(summaries))
    return summaries


def rows_of(summaries: Mapping[str, SeedSummary]) -> list[list[str]]:
    """Return a comparison as rows of text, the heads first."""
    rows = [
        [
            "setting",
            "CPU s to 99 %",
            "steps to the bar",
            "CPU s to the bar",
            "seeds at the bar",
            "held-out success",
            "time",
        ]
    ]
    for name, figures in summaries.items():
        to_99, to_bar = figures["to_99"], figures["to_bar"]
        time = figures["time_ratio"] or figures["mean_time"]
        rows.append(
            [
                name,
                _text(to_99["cpu_s"], "{:.1f}"),
                _text(to_bar["steps"], "{:,.0f}"),
                _text(to_bar["cpu_s"], "{:.1f}"),
                f"{to_bar['reached']} of {len(figures['seeds'])}",
                _text(figures["success"], "{:.1%}"),
                _text(time, "{:.3f}"),
            ]
        )
    return rows


def table_of(summaries: Mapping[str, SeedSummary]) -> str:
    """Return a comparison as a Markdown table: medians, and ranges where seeds differ."""
    head, *rows = ["| " + " | ".join(row) + " |" for row in rows_of(summaries)]
    return "\n".join([head, "|" + " --- |" * len(rows_of(summaries)[0]), *rows]) + "\n"


def _text(spread: SeedSpread | None, form: str) -> str:
    if spread is None:
        return "-"
    low, middle, high = [form.format(value) for value in (spread["low"], spread["median"], spread["high"])]
    return middle if low == high else f"{middle} ({low} to {high})"


def train(
    task: Annotated[str, typer.Argument(help="What is learned: go_to_ball or shoot.")],
    seeds: Annotated[int, typer.Option("--seeds", "-n", min=1, max=100, help="Seeds of each setting.")] = 5,
    only: Annotated[
        list[str] | None, typer.Option("--only", help="A setting by name; may be given again. All without.")
    ] = None,
    changes: Annotated[
        list[str] | None, typer.Option("--set", help="Change every setting, as evaluation.starts=100.")
    ] = None,
    out: Annotated[Path | None, typer.Option("--out", "-o", help="By default runs/compare-TASK.")] = None,
    workers: Annotated[int, typer.Option("--workers", "-w", min=1, max=256, help="Processes.")] = 1,
    as_json: Json = False,
) -> None:
    """Train with each switch of the learner changed alone, and with the paper's plain setting.

    Settings that the folder holds already are not trained again, ones that were
    cut off go on, so the command may be broken off and repeated. It takes hours.
    The table is also in the folder, as comparison.md and comparison.json.

    Keys of --json: task, and variants: a setting's name -> the same as "together"
    of robobt train --json.
    """

    given = parse_assignments(changes or [], "--set")
    folder = out or Path("runs") / f"compare-{task}"
    make_folders({"--out": out}, folders=True)
    with errors.status(f"comparing settings of {escape(task)}") as status:
        compared = compare(
            task,
            folder,
            range(seeds),
            only or (),
            given,
            workers,
            on_variant=lambda name: status.update(f"training {escape(name)}"),
        )
    if as_json:
        print_json({"task": task, "variants": compared})
        return
    head, *rows = rows_of(compared)
    shown = table(*head)
    for row in rows:
        shown.add_row(*row)
    console.print(shown)
