"""How much processor time ``robobt train`` takes until its policy is good enough, beside another checkout."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from statistics import median
from typing import Annotated, Any

import typer
from rich.markup import escape

from robobt.cli import MAX_SEED, Json, console, print_json, say, table
from robobt.cli.common import errors, parse_assignments

WORKER = Path(__file__).with_name("one_training.py")
HERE = "this checkout"


def train_to(
    task: Annotated[str, typer.Argument(help="What is learned: go_to_ball, score_on_goalkeeper, ...")],
    bar: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="Share of the held-out starts that have to be successes.")
    ] = 0.95,
    preset: Annotated[str, typer.Option(help="The preset.")] = "fast",
    seeds: Annotated[int, typer.Option("--seeds", "-n", min=1, max=100, help="How many seeds.")] = 5,
    seed: Annotated[int, typer.Option(min=0, max=MAX_SEED, help="The first seed.")] = 0,
    beside: Annotated[
        Path | None, typer.Option(help="Another checkout of robobt, whose trainings alternate with ours.")
    ] = None,
    every: Annotated[
        int | None, typer.Option(min=1, help="Steps between evaluations; by default the preset's.")
    ] = None,
    starts: Annotated[int, typer.Option(min=1, help="How many held-out starts are played.")] = 1000,
    changes: Annotated[
        list[str] | None, typer.Option("--set", help="Change a setting in both checkouts, as steps=100000.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Measure the CPU seconds of a training until the bar is met on the held-out starts.

    Each training is a process of its own with one thread. Its imports and its evaluations on the validation
    starts count. At each of these the policy also plays the held-out starts; that time does not count.

    Keys of --json: task, bar, preset, and checkouts: a list of folder (empty for this one), median_cpu_s
    (None unless all seeds met the bar) and seeds, with seed, cpu_s, steps, reached, success and curve each.
    """
    given = parse_assignments(changes or [], "--set")
    if every is not None:
        given["evaluation.every"] = every
    from robobt.learning.training.settings import load_settings

    # A wrong name is reported here, before any training starts.
    load_settings(task, preset, given)
    folders = ["", *([str(beside.resolve())] if beside is not None else [])]
    rows: dict[str, list[dict[str, Any]]] = {folder: [] for folder in folders}
    with errors.status(f"training {escape(task)}") as status:
        for one in range(seed, seed + seeds):
            for folder in reversed(folders):
                status.update(f"training seed {one} in {escape(folder or HERE)}")
                own = {"task": task, "preset": preset, "bar": bar, "starts": starts}
                found = _in_process(folder, {**own, "changes": {**given, "seed": one}})
                rows[folder].append({"seed": one, **found})
    checkouts = [
        {"folder": folder, "median_cpu_s": _median(trained), "seeds": trained}
        for folder, trained in rows.items()
    ]
    if as_json:
        print_json({"task": task, "bar": bar, "preset": preset, "checkouts": checkouts})
        return
    shown = table("checkout", "seed", f"CPU s to {bar:.0%}", "steps", "held-out success")
    for folder, trained in rows.items():
        for row in trained:
            cpu_s = f"{row['cpu_s']:.1f}" if row["reached"] else f"not in {row['cpu_s']:.1f}"
            cells = str(row["seed"]), cpu_s, f"{row['steps']:,}", f"{row['success']:.1%}"
            shown.add_row(escape(folder or HERE), *cells)
    console.print(shown)
    for checkout in checkouts:
        middle = checkout["median_cpu_s"]
        told = "not all seeds met the bar" if middle is None else f"median {middle:.1f} CPU s"
        say(f"{checkout['folder'] or HERE}: {told}")


def _in_process(folder: str, asked: dict[str, Any]) -> dict[str, Any]:
    """Run one training with the package of a checkout, this one's if ``folder`` is empty."""
    place = folder or str(WORKER.parents[1])
    env = {**os.environ, "PYTHONPATH": place, "OMP_NUM_THREADS": "1"}
    command = [sys.executable, str(WORKER), json.dumps(asked)]
    done = subprocess.run(command, env=env, cwd=place, check=True, stdout=subprocess.PIPE, text=True)
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def _median(rows: list[dict[str, Any]]) -> float | None:
    if not all(row["reached"] for row in rows):
        return None
    return float(median(row["cpu_s"] for row in rows))
