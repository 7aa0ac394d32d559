"""``robobt bench train``: compares the learner's switches, and the paper's setting."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from robobt.cli.common import Json, console, errors, parse_assignments, print_json, table
from robobt.cli.outputs import make_folders


def bench_train(
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
    from robobt.learning.training.compare import compare, rows_of

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
