"""``robobt bench policy``: measures what a leaf adds to the network it runs."""

from __future__ import annotations

from typing import Annotated

import typer

from robobt.cli.common import Json, errors, one_line_errors, print_json, say


def add_to(bench: typer.Typer) -> None:
    """Enter the command."""
    bench.command("policy")(bench_policy)


@one_line_errors
def bench_policy(
    model: Annotated[
        str, typer.Option("--model", help="Name or file of a TorchScript policy.")
    ] = "go_to_ball_ddpg",
    as_json: Json = False,
) -> None:
    """Measure one inference through the leaf beside the bare frozen module, batch 1, on one core.

    Keys of --json: leaf_to_module_ratio (a whole tick of LearnedSkill, from the
    frame to the command, over a call of the module on a tensor),
    skill_to_module_ratio (the same of the model's own skill) and the
    microseconds that they come from. CPU time, medians.
    """
    import torch

    from robobt.skills.bench import bench_policy as measure

    torch.set_num_threads(1)
    with errors.status("measuring policies"):
        figures = measure(model)
    if as_json:
        print_json(figures)
        return
    for name, figure in figures.items():
        say(f"{name.replace('_', ' '):32} {figure:8.2f}")
