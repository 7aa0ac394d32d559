"""``robobt bench tree``: measures the trees."""

from __future__ import annotations

import typer

from robobt.cli.common import Json, errors, one_line_errors, print_json, say


def add_to(bench: typer.Typer) -> None:
    """Enter the command."""
    bench.command("tree")(bench_tree)


@one_line_errors
def bench_tree(as_json: Json = False) -> None:
    """Measure the trees: a tick of 30 nodes beside py_trees and beside plain classes.

    Keys of --json: speedup_vs_py_trees (against BehaviourTree.tick),
    ratio_to_plain_classes (time against a hand-written class tree with the same
    lifecycle), store_speedup_vs_blackboard (a read and a write of the store in
    every leaf, against the blackboard's), and the microseconds a tick that they
    come from. CPU time, medians.
    """
    from robobt.tree.bench import bench_tree as measure

    with errors.status("measuring trees"):
        figures = measure()
    if as_json:
        print_json(figures)
        return
    for name, figure in figures.items():
        say(f"{name.replace('_', ' '):32} {figure:8.2f}")
